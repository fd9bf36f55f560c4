// For libraries that crash where they find no memory, or end the process: asked before they are called,
// memory that is not there is an error like any other.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

namespace cleave {

// Whether so much can be had in one piece at this moment.
inline bool has_room(std::size_t bytes) {
  void* volatile const room = std::malloc(bytes);  // volatile: a pair of calls nobody needs would be left out
  std::free(room);
  return room != nullptr;
}

inline void require_room(std::size_t bytes) {
  if (!has_room(bytes)) throw std::bad_alloc();
}

}  // namespace cleave

#pragma once

#include <string_view>

namespace cleave {

// Writes all bytes to an open file or pipe, in as many calls as it takes. False where one fails, and errno
// says why; what went before it stays written.
bool write_all(int descriptor, std::string_view bytes);

}  // namespace cleave

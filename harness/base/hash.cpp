#include "harness/base/hash.h"

#include <bit>
#include <cstdio>

namespace cleave {

// The bytes in memory are hashed as they lie.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(int) == 4 && sizeof(double) == 8);

void Fnv1a64::add_bytes(const void* data, std::size_t size) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3u;
}

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

}  // namespace cleave

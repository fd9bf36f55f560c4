#include "solver/memory_count.h"

#include <cmath>
#include <cstdio>

namespace cleave {
namespace {

// "12.4 GB" with a digit after the point, in the unit that leaves one to three before it.
std::string size_text(std::uint64_t bytes, double (*round)(double)) {
  const char* const units[] = {"kB", "MB", "GB"};
  double size = static_cast<double>(bytes) / 1e3;
  int unit = 0;
  for (; unit < 2 && size >= 1e3; ++unit) size /= 1e3;
  char text[48];
  std::snprintf(text, sizeof text, "%.1f %s", round(10 * size) / 10, units[unit]);
  return text;
}

double up(double x) { return std::ceil(x); }
double down(double x) { return std::floor(x); }

}  // namespace

void MemoryCount::add_product(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  std::uint64_t product = 0;
  const bool overflows = __builtin_mul_overflow(a, b, &product) ||
                         __builtin_mul_overflow(product, c, &product) ||
                         __builtin_add_overflow(bytes_, product, &bytes_);
  if (overflows) bytes_ = std::numeric_limits<std::uint64_t>::max();
}

// Rounded apart, so that the two never read alike.
MemoryRefused::MemoryRefused(std::uint64_t needed_bytes, bool counted_all, std::uint64_t limit_bytes)
    : text_("the factorisation needs " + std::string(counted_all ? "" : "more than ") +
            size_text(needed_bytes, up) + ", the limit is " + size_text(limit_bytes, down)) {}

}  // namespace cleave

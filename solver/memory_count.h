// How much memory a factorisation will take, counted before it is allocated, and what is thrown where that is
// more than a solve may have.
#pragma once

#include <cstdint>
#include <limits>
#include <new>
#include <string>
#include <vector>

namespace cleave {

inline constexpr std::uint64_t kNoMemoryLimit = std::numeric_limits<std::uint64_t>::max();

// Bytes. What is beyond 64 bits stays at the greatest number.
class MemoryCount {
 public:
  // An array of so many; rows x columns of them.
  template <class T>
  void add(std::uint64_t count) {
    add_product(count, 1, sizeof(T));
  }
  template <class T>
  void add(std::uint64_t rows, std::uint64_t columns) {
    add_product(rows, columns, sizeof(T));
  }
  // Arrays that are there already and grew as they were filled, which leaves them up to twice their size.
  template <class... T>
  void add_grown(const std::vector<T>&... arrays) {
    (add_product(2, arrays.size(), sizeof(T)), ...);
  }

  std::uint64_t bytes() const { return bytes_; }

 private:
  void add_product(std::uint64_t a, std::uint64_t b, std::uint64_t c);

  std::uint64_t bytes_ = 0;
};

// A factorisation that was not begun, because it needs more than the limit.
class MemoryRefused : public std::bad_alloc {
 public:
  // counted_all: false where counting ended at the limit, so that more is needed than was counted.
  MemoryRefused(std::uint64_t needed_bytes, bool counted_all, std::uint64_t limit_bytes);
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

// What one solver may have, and what its last factorisation was found to need.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t limit_bytes = kNoMemoryLimit) : limit_bytes_(limit_bytes) {}

  // Before the memory is allocated. Throws MemoryRefused where it is more than the limit, or than 64 bits
  // count.
  void request(const MemoryCount& needed, bool counted_all = true) {
    needed_bytes_ = needed.bytes();
    if (needed_bytes_ > limit_bytes_ || needed_bytes_ == kNoMemoryLimit)
      throw MemoryRefused(needed_bytes_, counted_all, limit_bytes_);
  }
  std::uint64_t limit_bytes() const { return limit_bytes_; }
  std::uint64_t needed_bytes() const { return needed_bytes_; }

 private:
  std::uint64_t limit_bytes_, needed_bytes_ = 0;
};

// Where an array whose values are of no interest is too short for `size`, gives it back before a longer one
// is made, so that both are never there together; nor is it made longer than was asked for.
template <class T>
void free_if_short(std::vector<T>& array, std::size_t size) {
  if (size > array.capacity()) array = std::vector<T>();
}

}  // namespace cleave

// 64-bit FNV-1a (Fowler, Noll, Vo) over little-endian data: the fingerprints of problems, solutions, states,
// runs and files. Equal hashes on two machines or thread counts mean equal bytes, so one column settles
// whether two runs agree.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace cleave {

class Fnv1a64 {
 public:
  void add(std::string_view text) { add_bytes(text.data(), text.size()); }
  // Numbers and enumerations as they lie in memory.
  template <class Numbers>
  void add(const Numbers& numbers) {
    const std::span values(numbers);
    using Value = typename decltype(values)::value_type;
    static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
    add_bytes(values.data(), values.size_bytes());
  }
  std::uint64_t value() const { return value_; }

 private:
  void add_bytes(const void* data, std::size_t size);
  std::uint64_t value_ = 0xcbf29ce484222325u;  // the offset basis of FNV-1a-64
};

// 16 hexadecimal digits.
std::string hex(std::uint64_t value);

}  // namespace cleave

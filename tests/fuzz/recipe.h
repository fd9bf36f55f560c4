// Bytes of a fuzzer as a sequence of decisions; zeros when they are used up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace cleave::fuzz {

class Recipe {
 public:
  explicit Recipe(std::string_view bytes) : rest_(bytes) {}

  bool is_over() const { return rest_.empty(); }
  std::uint32_t number(int bytes = 1) {
    std::uint32_t value = 0;
    for (; bytes > 0; --bytes) value = value << 8 | take();
    return value;
  }
  // One of so many; at least one.
  std::size_t choice(std::size_t count) { return number(count > 256 ? 2 : 1) % count; }
  template <class Value>
  Value one_of(std::span<const Value> table) {
    return table[choice(table.size())];
  }
  // A length and so many bytes, up to 255.
  std::string text() {
    std::string text(number(), '\0');
    for (char& c : text) c = static_cast<char>(take());
    return text;
  }

 private:
  std::uint8_t take() {
    if (rest_.empty()) return 0;
    const auto byte = static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return byte;
  }
  std::string_view rest_;
};

}  // namespace cleave::fuzz

// Plain values, arrays and texts in a row of bytes, to go from the process that reads a file to the one that
// uses it (isolated_read.h). Both walk the same members in the same order.
#pragma once

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace cleave {

template <class Value>
constexpr bool kIsPlain = std::is_arithmetic_v<Value> || std::is_enum_v<Value>;

class Packer {
 public:
  std::string bytes;

  template <class Plain>
  requires kIsPlain<Plain>
  void operator()(const Plain& value) { append(&value, sizeof value); }
  template <class Plain>
  void operator()(const std::vector<Plain>& values) {
    (*this)(values.size());
    append(values.data(), values.size() * sizeof(Plain));
  }
  void operator()(const std::string& text) {
    (*this)(text.size());
    append(text.data(), text.size());
  }

 private:
  void append(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
};

// Throws std::invalid_argument where the bytes end too early. Allocates no more than they hold.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

  template <class Plain>
  requires kIsPlain<Plain>
  void operator()(Plain& value) { take(&value, 1, sizeof value); }
  template <class Plain>
  void operator()(std::vector<Plain>& values) {
    values.resize(count(sizeof(Plain)));
    take(values.data(), values.size(), sizeof(Plain));
  }
  void operator()(std::string& text) {
    text.resize(count(1));
    take(text.data(), text.size(), 1);
  }
  // Of things that take at least so many bytes each.
  std::size_t count(std::size_t each) {
    std::size_t count = 0;
    (*this)(count);
    if (count > rest_.size() / each) fail();
    return count;
  }
  void expect_end() const {
    if (!rest_.empty()) fail();
  }
  [[noreturn]] static void fail() {
    throw std::invalid_argument("damaged: the HDF5 library did not read it whole");
  }

 private:
  void take(void* data, std::size_t count, std::size_t each) {
    if (count > rest_.size() / each) fail();
    if (count > 0) std::memcpy(data, rest_.data(), count * each);
    rest_.remove_prefix(count * each);
  }
  std::string_view rest_;
};

}  // namespace cleave

// One target as a program of libFuzzer. FUZZ_TARGET: its name.
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "tests/fuzz/target.h"

namespace {

using cleave::fuzz::Target;

const Target& target() {
  static const Target& row =
      *std::ranges::find(cleave::fuzz::targets(), std::string_view(FUZZ_TARGET),
                         [](const Target& each) { return std::string_view(each.name); });
  return row;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  target().run({reinterpret_cast<const char*>(data), size});
  return 0;
}

// Every other change is one that knows what the bytes say, where the target has such.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
  if (target().mutate == nullptr || seed % 2 == 0) return LLVMFuzzerMutate(data, size, most);
  cleave::fuzz::Random random(seed);
  const std::string bytes = target().mutate({reinterpret_cast<const char*>(data), size}, random);
  if (bytes.empty() || bytes.size() > most) return LLVMFuzzerMutate(data, size, most);
  std::memcpy(data, bytes.data(), bytes.size());
  return bytes.size();
}

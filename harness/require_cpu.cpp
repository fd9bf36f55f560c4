// Says in one line that the processor is too old, where the first vector instruction would otherwise end the
// program without a word. Compiled for any x86-64 and run before every other initialisation of the program.
#include <unistd.h>

#include <cstring>

namespace {

[[gnu::constructor(101)]] void require_cpu() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("x86-64-v3")) return;
  const char* text =
      "cleave: this processor has no AVX2 and FMA instructions (x86-64-v3), which this program is built "
      "for\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
  ::_exit(1);
}

}  // namespace

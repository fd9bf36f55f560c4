// Says in one line that the processor is too old, where the first vector instruction would otherwise end the
// program without a word. Compiled for any x86-64 and run before every other initialisation of the program.
#include <cpuid.h>
#include <unistd.h>

#include <cstring>

namespace {

// The features of x86-64-v3 one by one: clang 14 knows neither the whole by name nor the last three. AVX2
// counts only where the system saves its registers.
bool has_x86_64_v3() {
  unsigned int eax = 0, ebx = 0, ecx = 0, edx = 0;
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt") &&
         __get_cpuid(1, &eax, &ebx, &ecx, &edx) && (ecx & bit_F16C) && (ecx & bit_MOVBE) &&
         __get_cpuid(0x80000001, &eax, &ebx, &ecx, &edx) && (ecx & bit_LZCNT);
}

[[gnu::constructor(101)]] void require_cpu() {
  __builtin_cpu_init();
  if (has_x86_64_v3()) return;
  const char* text =
      "cleave: this processor has no AVX2 and FMA instructions (x86-64-v3), which this program is built "
      "for\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
  ::_exit(1);
}

}  // namespace

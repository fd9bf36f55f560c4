// Lets the files that Google Benchmark writes say of which build they are.
#pragma once

#include <benchmark/benchmark.h>

#include "harness/files/build_info.h"

namespace cleave {

// Once, before the benchmarks are run; results/programs.py holds it against cleave's.
inline void say_build() {
  const BuildInfo build = build_info();
  benchmark::AddCustomContext("git_hash", build.git_hash);
  benchmark::AddCustomContext("git_dirty", build.git_dirty);
}

}  // namespace cleave

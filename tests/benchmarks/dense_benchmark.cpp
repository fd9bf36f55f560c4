// Times the dense Cholesky factorisation of the interface system against what the processor can do and
// against OpenBLAS. scripts/benchmark_dense tells OpenBLAS the right processor and prints the ratios.
//
//   dense_benchmark [FILE...] [Google Benchmark options]
//
// Rows (counter gflop_per_s: n^3 / 3 and lower terms over the time):
//   peak:SET                multiply-adds on registers with that instruction set, one thread
//   cholesky:SET/ROWS       ours, one thread
//   openblas/ROWS           dpotrf, one thread
//   cholesky_2/ROWS         ours, two threads, the widest instruction set
//   side_by_side/ROWS       two factorisations of ours, one thread each, at the same time; the time of one,
//                           so twice gflop_per_s is what the machine can give to two threads
//   inside/ROWS             the same factorisation within the kernel schur-rows, one thread, on a recorded
//                           problem FILE with all rows free, split by mindp; ROWS: of its interface
#include <benchmark/benchmark.h>

#include <algorithm>
#include <barrier>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "harness/experiment/problem_graph.h"
#include "harness/files/problem_file.h"
#include "partition/registry.h"
#include "solver/kernels/kernel.h"
#include "solver/linear/dense_cholesky.h"
#include "solver/linear/dense_panel.h"
#include "solver/stage_clock.h"
#include "tests/benchmarks/build_context.h"
#include "tests/benchmarks/multiply_add_peak.h"

extern "C" void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
extern "C" void openblas_set_num_threads(int threads);

namespace cleave {
namespace {

constexpr int kRows[] = {100, 300, 1000, 3000};

// Diagonally dominant, the same in both layouts.
double entry(int row, int column, int size) {
  return row == column ? size : 1.0 / (1 + (7 * row + 3 * column) % 11);
}

// As the kernel does, a task a panel.
void fill(DenseCholesky& cholesky, int size, ParallelTasks& tasks) {
  cholesky.resize(size);
  const auto of_size = [size](int row, int column) { return entry(row, column, size); };
  tasks.run(Stage::form_interface, cholesky.panel_count(), [&](int p) { cholesky.fill_panel(p, of_size); });
}

void count_flops(benchmark::State& state, double mflop) {
  state.counters["gflop_per_s"] =
      benchmark::Counter(1e-3 * mflop, benchmark::Counter::kIsIterationInvariantRate);
}

void time_peak(benchmark::State& state, const DenseTiles& tiles) {
  constexpr int kRounds = 100000;
  double flops = 0;
  for (auto _ : state) flops = run_multiply_adds(tiles.name, kRounds);
  count_flops(state, 1e-6 * flops);
}

// Fills and factors, and times the factorisation.
double factor_seconds(DenseCholesky& cholesky, int size, ParallelTasks& tasks) {
  tasks.clock().start();
  fill(cholesky, size, tasks);
  const auto begin = StageClock::Clock::now();
  if (!cholesky.factor(tasks)) throw std::runtime_error("the matrix is not positive definite");
  return std::chrono::duration<double>(StageClock::Clock::now() - begin).count();
}

void time_cholesky(benchmark::State& state, const DenseTiles& tiles, int size, int threads) {
  const DenseTiles& chosen = dense_tiles();
  use_dense_tiles(tiles);
  start_threads(threads);
  StageClock clock;
  ParallelTasks tasks(clock, threads);
  DenseCholesky cholesky;
  for (auto _ : state) state.SetIterationTime(factor_seconds(cholesky, size, tasks));
  count_flops(state, cholesky.mflop());
  use_dense_tiles(chosen);
}

void time_openblas(benchmark::State& state, int size) {
  openblas_set_num_threads(1);
  std::vector<double> a(static_cast<std::size_t>(size) * size);
  for (auto _ : state) {
    for (int column = 0; column < size; ++column) {
      for (int row = column; row < size; ++row)
        a[row + static_cast<std::size_t>(size) * column] = entry(row, column, size);
    }
    int info = 0;
    const auto begin = StageClock::Clock::now();
    dpotrf_("L", &size, a.data(), &size, &info);
    state.SetIterationTime(std::chrono::duration<double>(StageClock::Clock::now() - begin).count());
  }
  DenseCholesky same_size;
  same_size.resize(size);
  count_flops(state, same_size.mflop());
}

// The longer of two that begin together.
void time_side_by_side(benchmark::State& state, int size) {
  start_threads(2);
  DenseCholesky cholesky[2];
  for (auto _ : state) {
    double seconds[2] = {};
    std::barrier<> ready(2);
    const auto run = [&](int k) {
      StageClock clock;
      ParallelTasks tasks(clock, 1);
      fill(cholesky[k], size, tasks);
      ready.arrive_and_wait();
      const auto begin = StageClock::Clock::now();
      if (!cholesky[k].factor(tasks)) throw std::runtime_error("the matrix is not positive definite");
      seconds[k] = std::chrono::duration<double>(StageClock::Clock::now() - begin).count();
    };
    std::thread other(run, 1);
    run(0);
    other.join();
    state.SetIterationTime(std::max(seconds[0], seconds[1]));
  }
  count_flops(state, cholesky[0].mflop());
}

// A kernel with the system of a problem in which no row is at a bound.
struct FreeSystem {
  explicit FreeSystem(const std::filesystem::path& file) : problem(read_problem_file(file).problem) {
    step.prepare(problem);
    part_of_body = make_partitioner("mindp")->run(body_graph_of(problem)).part_of_body;
    for (int row = 0; row < step.row_count(); ++row)
      d.push_back(1 / std::max(problem.compliance[row], 1e-12 * step.diagonal()[row]));
    kernel->analyze(step, part_of_body, tasks);
  }
  StepProblem problem;
  PreparedStep step;
  std::vector<int> part_of_body;
  std::vector<double> d;
  StageClock clock;
  ParallelTasks tasks{clock, 1};
  std::unique_ptr<Kernel> kernel = make_schur_rows_kernel({});
};

void time_inside(benchmark::State& state, FreeSystem& system) {
  for (auto _ : state) {
    system.clock.start();
    if (!system.kernel->factor(system.d, system.tasks))
      throw std::runtime_error("the matrix is not positive definite");
    const StageTimes times = system.clock.stop();
    state.SetIterationTime(1e-3 * times.stage_ms[static_cast<std::size_t>(Stage::factor_interface)]);
  }
  count_flops(state, system.kernel->interface_mflop());
}

template <class Run>
void add(const std::string& name, Run run, bool manual = true) {
  auto* row = benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond);
  if (manual) row->UseManualTime();
}

void register_rows() {
  for (const DenseTiles* tiles : all_dense_tiles()) {
    if (!tiles->is_supported()) continue;
    add(
        std::string("peak:") + tiles->name, [tiles](benchmark::State& state) { time_peak(state, *tiles); },
        false);
    for (int size : kRows) {
      add(std::string("cholesky:") + tiles->name + "/" + std::to_string(size),
          [tiles, size](benchmark::State& state) { time_cholesky(state, *tiles, size, 1); });
    }
  }
  for (int size : kRows) {
    const std::string rows = "/" + std::to_string(size);
    add("openblas" + rows, [size](benchmark::State& state) { time_openblas(state, size); });
    add("cholesky_2" + rows,
        [size](benchmark::State& state) { time_cholesky(state, dense_tiles(), size, 2); });
    add("side_by_side" + rows, [size](benchmark::State& state) { time_side_by_side(state, size); });
  }
}

}  // namespace
}  // namespace cleave

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  cleave::say_build();
  try {
    cleave::register_rows();
    std::vector<std::unique_ptr<cleave::FreeSystem>> systems;
    for (int k = 1; k < argc; ++k) {
      cleave::FreeSystem& system = *systems.emplace_back(std::make_unique<cleave::FreeSystem>(argv[k]));
      cleave::add("inside/" + std::to_string(system.kernel->interface_unknowns()),
                  [&system](benchmark::State& state) { cleave::time_inside(state, system); });
    }
    benchmark::RunSpecifiedBenchmarks();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

// Times solvers, and the factorisation they rest on, on recorded problem files: one thread, zero impulses to
// start from, symbolic analysis included. scripts/benchmark_solvers records the files and prints the ratios.
//
//   solver_benchmark FILE... [Google Benchmark options]
//
// Rows, by file (named by its directory and stem):
//   exact            t_s of a whole solve; counters residual_m_per_s, factorizations, within_limit
//   pgs/N            N sweeps of projected Gauss-Seidel, preparation included; ns_per_row_sweep
//   cholmod/KIND     one numeric factorisation of H by CHOLMOD, KIND supernodal or simplicial
//   factor, assemble our own, of the same H; gflop_per_s counts CHOLMOD's operations of its best ordering
//   schur_bodies/T   both factorisation stages of that kernel on T threads (parts: 25 bodies, by greedy
//                    growth)
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "harness/experiment/problem_graph.h"
#include "harness/files/problem_file.h"
#include "partition/registry.h"
#include "solver/kernels/kernel.h"
#include "solver/registry.h"
#include "solver/residual.h"
#include "solver/stage_clock.h"
#include "tests/benchmarks/build_context.h"
#include "tests/benchmarks/cholmod_reference.h"

namespace cleave {
namespace {

struct NamedProblem {
  NamedProblem(std::string problem_name, StepProblem step)
      : name(std::move(problem_name)), problem(std::move(step)) {}
  std::string name;
  StepProblem problem;
};

// D of the system in which no row is at a bound: the densest there is. A row with C = 0 counts as stiff.
std::vector<double> all_rows_free(const PreparedStep& step) {
  std::vector<double> d(step.row_count());
  for (int r = 0; r < step.row_count(); ++r) {
    d[r] = 1 / std::max(step.problem().compliance[r], 1e-12 * step.diagonal()[r]);
  }
  return d;
}

void time_solver(benchmark::State& state, const NamedProblem& named, const std::string& text) {
  const auto solver = make_step_solver(text);
  Solution solution;
  SolveSummary summary;
  for (auto _ : state) {
    solution.impulse.assign(named.problem.row_count(), 0.0);
    summary = solver->solve(named.problem, {}, solution);
    state.SetIterationTime(1e-3 * summary.times.total_ms);  // where the row has manual time
  }
  const ResidualReport verdict = judge(named.problem, solution.impulse);
  state.counters["rows"] = named.problem.row_count();
  state.counters["residual_m_per_s"] = verdict.residual_m_per_s;
  state.counters["within_limit"] = verdict.exact;
  state.counters["factorizations"] = summary.factorizations;
}

void time_pgs(benchmark::State& state, const NamedProblem& named, int sweeps) {
  time_solver(state, named, "pgs@sweeps=" + std::to_string(sweeps));
  state.counters["ns_per_row_sweep"] =
      benchmark::Counter(1e-9 * sweeps * named.problem.row_count(),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void time_cholmod(benchmark::State& state, const NamedProblem& named, bool supernodal) {
  PreparedStep step;
  step.prepare(named.problem);
  CholmodReference cholmod(named.problem, all_rows_free(step), supernodal);
  for (auto _ : state) cholmod.factor();
  state.counters["gflop_per_s"] =
      benchmark::Counter(1e-9 * cholmod.flops(), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["mflop"] = 1e-6 * cholmod.flops();
}

struct KernelTimes {
  double assemble_ms, factor_ms;
};

KernelTimes factor_once(Kernel& kernel, std::span<const double> d, StageClock& clock, ParallelTasks& tasks) {
  clock.start();
  if (!kernel.factor(d, tasks)) throw std::runtime_error("the matrix is not positive definite");
  const auto stage_ms = clock.stop().stage_ms;
  const auto of = [&](Stage stage) { return stage_ms[static_cast<int>(stage)]; };
  return {of(Stage::assemble) + of(Stage::form_interface),
          of(Stage::factor_local) + of(Stage::factor_interface)};
}

enum class Timed { assemble, factor };

void time_kernel(benchmark::State& state, const NamedProblem& named, std::unique_ptr<Kernel> kernel,
                 std::span<const int> part_of_body, int threads, Timed timed) {
  PreparedStep step;
  step.prepare(named.problem);
  const std::vector<double> d = all_rows_free(step);
  std::vector<double> weights = d, next = d;  // by turns, as a factorisation keeps what has not changed
  for (double& weight : next) weight *= 1 + 1e-9;
  StageClock clock;
  ParallelTasks tasks(clock, threads);
  kernel->analyze(step, part_of_body, tasks);
  for (auto _ : state) {
    const KernelTimes times = factor_once(*kernel, weights, clock, tasks);
    std::swap(weights, next);
    state.SetIterationTime(1e-3 * (timed == Timed::factor ? times.factor_ms : times.assemble_ms));
  }
  const double flops = CholmodReference(named.problem, d, true).flops();
  state.counters["gflop_per_s"] =
      benchmark::Counter(1e-9 * flops, benchmark::Counter::kIsIterationInvariantRate);
}

// A few parts a thread: parts of 25 bodies leave half the work to the interface, which is factored serially.
Partition few_large_parts(const BodyGraph& graph) {
  const int max_bodies = std::max(1, graph.body_count() / 4);
  Partition parts = make_partitioner("bfs@max-bodies=" + std::to_string(max_bodies))->run(graph);
  make_refiner("fm")->run(graph, max_bodies, parts);
  return parts;
}

void register_solvers(const NamedProblem& named) {
  const auto add = [&](const std::string& row, auto&&... arguments) {
    return benchmark::RegisterBenchmark((row + "/" + named.name).c_str(), arguments...)
        ->Unit(benchmark::kMillisecond);
  };
  // t_s, as the rows of a run have it: the model of other numbers of workers is made outside of it.
  add("exact", [&named](benchmark::State& state) { time_solver(state, named, "exact"); })->UseManualTime();
  for (int sweeps : {100, 300, 700}) {
    add("pgs:" + std::to_string(sweeps),
        [&named, sweeps](benchmark::State& state) { time_pgs(state, named, sweeps); });
  }
  for (bool supernodal : {true, false}) {
    add(supernodal ? "cholmod:supernodal" : "cholmod:simplicial",
        [&named, supernodal](benchmark::State& state) { time_cholmod(state, named, supernodal); });
  }
  for (Timed timed : {Timed::factor, Timed::assemble}) {
    add(timed == Timed::factor ? "factor" : "assemble", [&named, timed](benchmark::State& state) {
      time_kernel(state, named, make_monolithic_kernel({}), {}, 1, timed);
    })->UseManualTime();
  }
  for (int threads : {1, 2}) {
    add("schur_bodies:" + std::to_string(threads), [&named, threads](benchmark::State& state) {
      const BodyGraph graph = body_graph_of(named.problem);
      const Partition parts = few_large_parts(graph);
      time_kernel(state, named, make_schur_bodies_kernel({}), parts.part_of_body, threads, Timed::factor);
    })->UseManualTime();
  }
}

int run(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  say_build();
  if (argc < 2) throw std::invalid_argument("solver_benchmark: name at least one problem file");
  std::vector<std::unique_ptr<NamedProblem>> problems;
  for (int k = 1; k < argc; ++k) {
    const std::filesystem::path path = argv[k];
    const std::string name = (path.parent_path().filename() / path.stem()).string();
    problems.push_back(std::make_unique<NamedProblem>(name, read_problem_file(path).problem));
    register_solvers(*problems.back());
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace cleave

int main(int argc, char** argv) {
  try {
    return cleave::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

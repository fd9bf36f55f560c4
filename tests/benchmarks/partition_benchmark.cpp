// Times partitioners and refiners on the same graphs, and counts what they cut.
//
//   partition_benchmark [--problem FILE]... [Google Benchmark options]
//
// Graphs are synthetic piles and those of the problem files. What draws at random runs with seeds 1 to 10 in
// turn: the time is the mean over them. Counted once a row, apart from the times, over all ten:
//
//   above_bound      seeds whose result has a part of more than 30 bodies, (1 + max-growth) max-bodies
//   interface_rows   the least over the other seeds, of which parts and cut_pairs are; absent where there is
//                    none
//   median_rows      the median over the same
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "harness/experiment/problem_graph.h"
#include "harness/files/problem_file.h"
#include "partition/registry.h"
#include "tests/benchmarks/build_context.h"
#include "tests/benchmarks/synthetic_pile.h"

namespace cleave {
namespace {

constexpr int kMaxBodies = 25;
constexpr int kMostBodies = 30;  // of a part that counts
constexpr int kSeeds = 10;
constexpr int kManyBodies = 20000;

struct NamedGraph {
  std::string name;
  BodyGraph graph;
};

// A partitioner, one of every seed where it has seeds, and a refiner.
struct Pair {
  std::string name;
  std::vector<std::unique_ptr<Partitioner>> partitioners;
  std::unique_ptr<Refiner> refiner;

  Partition run(const BodyGraph& graph, std::size_t number) const {
    Partition partition = partitioners[number % partitioners.size()]->run(graph);
    refiner->run(graph, kMaxBodies, partition);
    return partition;
  }
};

bool has_seed(const PartitionerEntry& entry) {
  return std::ranges::count(entry.parameters, "partition-seed", &Parameter::name) > 0;
}

// parameters: "@name=value" of the partitioner.
Pair make_pair_of(const PartitionerEntry& entry, const std::string& parameters, const std::string& refiner) {
  Pair pair{entry.name + parameters + "+" + refiner, {}, make_refiner(refiner)};
  const std::string text = entry.name + parameters;
  if (!has_seed(entry)) pair.partitioners.push_back(make_partitioner(text));
  for (int seed = 1; has_seed(entry) && seed <= kSeeds; ++seed)
    pair.partitioners.push_back(make_partitioner(text + "@partition-seed=" + std::to_string(seed)));
  return pair;
}

std::vector<std::string> variants_of(const std::string& partitioner) {
  if (partitioner == "multilevel") return {"@effort=fast", "@effort=best"};
  if (partitioner == "scotch")
    return {"", "@scotch-strategy=balance", "@scotch-strategy=speed", "@scotch-strategy=quality"};
  return {""};
}

// Every refiner after the partitioners of the paper, none after the others; crumbs folded in before fm and
// fm-hill.
std::vector<Pair> all_pairs() {
  std::vector<Pair> pairs;
  for (const PartitionerEntry& entry : partitioners()) {
    if (!entry.unavailable.empty() || std::string_view(entry.name) == "file" ||
        std::string_view(entry.name) == "semantic")
      continue;
    for (const std::string& parameters : variants_of(entry.name)) {
      for (const RefinerEntry& refiner : refiners())
        if (entry.traits.of_paper || std::string_view(refiner.name) == "none")
          pairs.push_back(make_pair_of(entry, parameters, refiner.name));
    }
    if (!entry.traits.of_paper) continue;
    for (const char* refiner : {"fm", "fm-hill"})
      pairs.push_back(make_pair_of(entry, "@merge-small=true", refiner));
  }
  return pairs;
}

// Rows that take minutes on a graph of very many bodies.
bool is_slow(const std::string& name) {
  return name.starts_with("karger") || name.ends_with("-hill") || name.find("-cost") != std::string::npos;
}

void count_cut(const BodyGraph& graph, const Pair& pair, benchmark::UserCounters& counters) {
  std::vector<PartitionMetrics> within;
  int above = 0;
  for (std::size_t k = 0; k < pair.partitioners.size(); ++k) {
    const PartitionMetrics metrics = measure_partition(graph, pair.run(graph, k).part_of_body);
    if (metrics.max_part_bodies > kMostBodies) {
      ++above;
    } else {
      within.push_back(metrics);
    }
  }
  counters["bodies"] = graph.body_count();
  counters["edges"] = graph.edge_count();
  counters["above_bound"] = above;
  if (within.empty()) return;
  std::ranges::stable_sort(within, {}, &PartitionMetrics::interface_rows);
  counters["parts"] = within.front().parts;
  counters["cut_pairs"] = within.front().cut_pairs;
  counters["interface_rows"] = within.front().interface_rows;
  counters["median_rows"] = within[within.size() / 2].interface_rows;
}

void time_pair(benchmark::State& state, const BodyGraph& graph, const Pair& pair,
               benchmark::UserCounters& counted) {
  if (counted.empty()) count_cut(graph, pair, counted);  // the same in all repetitions
  std::size_t number = 0;
  for (auto _ : state) benchmark::DoNotOptimize(pair.run(graph, number++));
  state.counters = counted;
}

void register_benchmarks(const std::vector<NamedGraph>& graphs, const std::vector<Pair>& pairs) {
  for (const NamedGraph& named : graphs) {
    for (const Pair& pair : pairs) {
      if (named.graph.body_count() > kManyBodies && is_slow(pair.name)) continue;
      benchmark::RegisterBenchmark((named.name + "/" + pair.name).c_str(),
                                   [&, counted = benchmark::UserCounters()](benchmark::State& state) mutable {
                                     time_pair(state, named.graph, pair, counted);
                                   })
          ->Unit(benchmark::kMicrosecond);
    }
  }
}

std::vector<NamedGraph> synthetic_piles() {
  const std::vector<double> equal_kg{100}, three_kg{10, 100, 1000};
  std::vector<NamedGraph> graphs;
  for (const int bodies : {200, 1000, 10000, 100000})
    graphs.push_back({"pile_" + std::to_string(bodies), synthetic_pile(bodies, equal_kg, 1)});
  graphs.push_back({"pile_600", synthetic_pile(600, three_kg, 1)});
  return graphs;
}

NamedGraph read_graph(const std::string& path) {
  const ProblemFile file = read_problem_file(path);
  return {std::filesystem::path(path).stem().string(),
          body_graph_of(file.problem, file.step, {.position_m = file.position})};
}

int run(int argc, char** argv) {
  std::vector<NamedGraph> graphs = synthetic_piles();
  std::vector<char*> others{argv[0]};
  for (int k = 1; k < argc; ++k) {
    if (std::strcmp(argv[k], "--problem") == 0) {
      if (++k == argc) throw std::invalid_argument("--problem needs a file");
      graphs.push_back(read_graph(argv[k]));
    } else {
      others.push_back(argv[k]);
    }
  }
  int other_count = static_cast<int>(others.size());
  benchmark::Initialize(&other_count, others.data());
  say_build();
  if (benchmark::ReportUnrecognizedArguments(other_count, others.data())) return 1;
  const std::vector<Pair> pairs = all_pairs();
  register_benchmarks(graphs, pairs);
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

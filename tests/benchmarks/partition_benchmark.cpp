// Times every partitioner x refiner and METIS on the same graphs.
//
//   partition_benchmark [--graph FILE]... [Google Benchmark options]
//
// Without --graph the graphs are synthetic piles. A graph file is plain text: the number of bodies n, then n
// masses in kg, then one line "a b rows" for every constraint (a joint or a contact point), -1 for static
// geometry.
#include <benchmark/benchmark.h>
#include <metis.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "partition/registry.h"

namespace cleave {
namespace {

constexpr int kMaxBodies = 25;  // n_max, and bodies per part asked of METIS

struct NamedGraph {
  std::string name;
  BodyGraph graph;
};

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

struct Site {
  std::array<int, 3> cell;
  std::array<double, 3> centre;
};

// Bodies layer by layer on a grid in a square pit, each moved at random by up to 0.3 grid lengths along every
// axis.
std::vector<Site> settle(int bodies, std::mt19937_64& random) {
  const int side = static_cast<int>(std::ceil(std::cbrt(bodies)));
  std::vector<Site> sites(bodies);
  for (int i = 0; i < bodies; ++i) {
    sites[i].cell = {i % side, i / side % side, i / (side * side)};
    for (int axis = 0; axis < 3; ++axis) {
      sites[i].centre[axis] = sites[i].cell[axis] + uniform(random, -0.3, 0.3);
    }
  }
  return sites;
}

// Pairs of bodies in neighbouring cells, closest first.
std::vector<std::pair<int, int>> close_pairs(const std::vector<Site>& sites) {
  std::vector<std::tuple<double, int, int>> pairs;
  const int n = static_cast<int>(sites.size());
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      double squared = 0;
      bool neighbours = true;
      for (int axis = 0; axis < 3; ++axis) {
        neighbours &= std::abs(sites[a].cell[axis] - sites[b].cell[axis]) <= 1;
        squared += std::pow(sites[a].centre[axis] - sites[b].centre[axis], 2);
      }
      if (neighbours) pairs.emplace_back(squared, a, b);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::pair<int, int>> result;
  for (const auto& [squared, a, b] : pairs) result.emplace_back(a, b);
  return result;
}

// A pile-like graph: the 1.765 n closest pairs touch (353 edges for 200 bodies, as in a settled pile of
// boxes), each at 1 to 8 points of 3 rows. Masses are drawn from mass_kg.
BodyGraph synthetic_pile(int bodies, const std::vector<double>& mass_kg, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const std::vector<std::pair<int, int>> pairs = close_pairs(settle(bodies, random));
  const size_t touching = std::min(pairs.size(), static_cast<size_t>(std::lround(1.765 * bodies)));
  std::vector<ConstraintLink> links;
  for (size_t k = 0; k < touching; ++k) {
    const int points = 1 + static_cast<int>(random() % 8);
    for (int p = 0; p < points; ++p) links.push_back({pairs[k].first, pairs[k].second, 3});
  }
  std::vector<double> masses(bodies);
  for (double& mass : masses) mass = mass_kg[random() % mass_kg.size()];
  return BodyGraph(masses, links);
}

BodyGraph read_graph(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::invalid_argument("--graph " + path + ": cannot be read");
  int bodies = 0;
  if (!(file >> bodies) || bodies < 1)
    throw std::invalid_argument("--graph " + path + ": first line must be n >= 1");
  std::vector<double> masses(bodies);
  for (double& mass : masses) {
    if (!(file >> mass)) throw std::invalid_argument("--graph " + path + ": fewer than n masses");
  }
  std::vector<ConstraintLink> links;
  for (ConstraintLink link; file >> link.body_a;) {
    if (!(file >> link.body_b >> link.rows))
      throw std::invalid_argument("--graph " + path + ": broken last line");
    links.push_back(link);
  }
  if (!file.eof()) throw std::invalid_argument("--graph " + path + ": not a number");
  return BodyGraph(masses, links);
}

void report_cut(benchmark::State& state, const BodyGraph& graph, std::span<const int> part_of_body) {
  const PartitionMetrics metrics = measure_partition(graph, part_of_body);
  state.counters["parts"] = metrics.parts;
  state.counters["cut_pairs"] = metrics.cut_pairs;
  state.counters["interface_rows"] = metrics.interface_rows;
}

void time_ours(benchmark::State& state, const BodyGraph& graph, const Partitioner& partitioner,
               const Refiner& refiner) {
  Partition partition;
  for (auto _ : state) {
    partition = partitioner.run(graph);
    refiner.run(graph, kMaxBodies, partition);
    benchmark::DoNotOptimize(partition);
  }
  report_cut(state, graph, partition.part_of_body);
}

// METIS's own input arrays; edges are weighed in rows.
struct MetisGraph {
  std::vector<idx_t> first, neighbour, weight;

  explicit MetisGraph(const BodyGraph& graph) : first{0} {
    for (int i = 0; i < graph.body_count(); ++i) {
      for (int k = graph.first(i); k < graph.last(i); ++k) {
        neighbour.push_back(graph.neighbour(k));
        weight.push_back(graph.weight(k, EdgeWeight::rows));
      }
      first.push_back(static_cast<idx_t>(neighbour.size()));
    }
  }
};

void time_metis(benchmark::State& state, const BodyGraph& graph, decltype(&METIS_PartGraphKway) call) {
  MetisGraph metis(graph);
  idx_t bodies = graph.body_count(), constraints = 1, parts = (bodies + kMaxBodies - 1) / kMaxBodies, cut = 0;
  std::vector<idx_t> part_of_body(bodies, 0);
  for (auto _ : state) {
    const int status =
        call(&bodies, &constraints, metis.first.data(), metis.neighbour.data(), nullptr, nullptr,
             metis.weight.data(), &parts, nullptr, nullptr, nullptr, &cut, part_of_body.data());
    if (status != METIS_OK) return state.SkipWithError("METIS failed");
  }
  report_cut(state, graph, std::vector<int>(part_of_body.begin(), part_of_body.end()));
}

void register_benchmarks(const std::vector<NamedGraph>& graphs) {
  const auto add = [](const std::string& name, auto function) {
    benchmark::RegisterBenchmark(name.c_str(), function)->Unit(benchmark::kMicrosecond);
  };
  for (const NamedGraph& named : graphs) {
    const BodyGraph& graph = named.graph;
    for (const PartitionerEntry& partitioner : partitioners()) {
      if (!partitioner.of_paper) continue;
      for (const RefinerEntry& refiner : refiners()) {
        add(named.name + "/" + partitioner.name + "+" + refiner.name, [&](benchmark::State& state) {
          time_ours(state, graph, *make_partitioner(partitioner.name), *make_refiner(refiner.name));
        });
      }
    }
    add(named.name + "/metis_recursive",
        [&](benchmark::State& state) { time_metis(state, graph, METIS_PartGraphRecursive); });
    add(named.name + "/metis_kway",
        [&](benchmark::State& state) { time_metis(state, graph, METIS_PartGraphKway); });
  }
}

const std::vector<double> kEqualMassKg{100}, kThreeMassesKg{10, 100, 1000};

int run(int argc, char** argv) {
  std::vector<NamedGraph> graphs;
  std::vector<char*> others{argv[0]};
  for (int k = 1; k < argc; ++k) {
    if (std::strcmp(argv[k], "--graph") == 0) {
      if (++k == argc) throw std::invalid_argument("--graph needs a file");
      graphs.push_back({std::filesystem::path(argv[k]).filename().string(), read_graph(argv[k])});
    } else {
      others.push_back(argv[k]);
    }
  }
  int other_count = static_cast<int>(others.size());
  benchmark::Initialize(&other_count, others.data());
  if (benchmark::ReportUnrecognizedArguments(other_count, others.data())) return 1;
  if (graphs.empty()) {
    graphs.push_back({"pile_200", synthetic_pile(200, kEqualMassKg, 1)});
    graphs.push_back({"pile_600", synthetic_pile(600, kThreeMassesKg, 1)});
  }
  register_benchmarks(graphs);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace cleave

int main(int argc, char** argv) {
  try {
    return cleave::run(argc, argv);
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

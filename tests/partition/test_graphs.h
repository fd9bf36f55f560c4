// Seeded graphs, options and starting partitions. One seed gives one result on every machine.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "partition/body_graph.h"
#include "partition/partition.h"
#include "tests/partition/paper_options.h"

namespace cleave::partition_test {

// The distributions of the standard library differ between implementations, so the arithmetic is spelled out.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  // Uniform in [low, high].
  int integer(int low, int high) {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  double real(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  bool chance(double probability) { return real(0, 1) < probability; }
  template <typename T>
  const T& pick(const std::vector<T>& values) {
    return values[integer(0, static_cast<int>(values.size()) - 1)];
  }
  std::vector<int> permutation(int count);

 private:
  std::mt19937_64 engine_;
};

// What a BodyGraph is built from.
struct Bodies {
  std::string family;
  std::vector<double> mass_kg;
  std::vector<ConstraintLink> links;
  std::vector<double> position_m = {};  // (n, 3); empty: in a row along x, a metre apart
  std::vector<int> group = {};          // (n); empty: -1, 0, 1, 2 in turn

  int count() const { return static_cast<int>(mass_kg.size()); }
  std::vector<double> positions() const;
  std::vector<int> groups() const;
  BodyGraph graph() const;
};

// Counted the slow and obvious way, for slow twins: bodies in a part, and rows between a body and a part,
// itself left out.
int bodies_in(const Partition& partition, int part);
long rows_into(const Bodies& bodies, const Partition& partition, int body, int part);

// Families, by seed: empty, single and few bodies, path, star, tree, complete, pile, sparse and dense random,
// disconnected, mostly isolated. Repeated links, links with static geometry and of a body with itself are
// mixed in. Bodies stand anywhere, or on a grid that several may share a place of.
Bodies random_bodies(std::uint64_t seed);

// A heap of boxes on a grid: each touches those beside, over and, at times, diagonally below it.
Bodies pile(Random& random, int width, int depth, int height);

PartitionOptions random_partition_options(Random& random);
RefineOptions random_refine_options(Random& random);

// Any number of non-empty parts; bodies are dealt regardless of the graph, so parts are rarely contiguous.
Partition random_partition(Random& random, int bodies);

// The same bodies with indices reversed: ties that went to the lowest index now go to the highest.
Bodies reversed(const Bodies& bodies);
Partition reversed(const Partition& partition);

std::string describe(const Bodies& bodies);
std::string describe(const PartitionOptions& options);
std::string describe(const RefineOptions& options);

// "" if equal, else the first body whose part differs.
std::string first_difference(const Partition& expected, const Partition& actual);

}  // namespace cleave::partition_test

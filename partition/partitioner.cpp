#include "partition/partitioner.h"

#include <algorithm>
#include <cassert>

#include "partition/refuse.h"

namespace cleave {
namespace {

// Written so that NaN is refused as well.
void check(const PartitionOptions& options) {
  if (options.max_bodies < 1) refuse("max_bodies", options.max_bodies, ">= 1");
  if (!(options.tau_mr > 1)) refuse("tau_mr", options.tau_mr, "> 1");
  if (!(options.tau_mix >= 0 && options.tau_mix <= 1)) refuse("tau_mix", options.tau_mix, "0 to 1");
}

[[maybe_unused]] bool is_valid(const BodyGraph& graph, const Partition& partition, int max_bodies) {
  const std::vector<int>& part_of_body = partition.part_of_body;
  const auto in_range = [&](int part) { return part >= 0 && part < partition.part_count; };
  if (static_cast<int>(part_of_body.size()) != graph.body_count()) return false;
  if (!std::all_of(part_of_body.begin(), part_of_body.end(), in_range)) return false;
  for (int bodies : part_sizes(partition)) {
    if (bodies < 1 || bodies > max_bodies) return false;
  }
  return count_pieces(graph, part_of_body) == partition.part_count;
}

}  // namespace

Partition Partitioner::run(const BodyGraph& graph, const PartitionOptions& options) const {
  check(options);
  Partition partition = do_run(graph, options);
  assert(is_valid(graph, partition, options.max_bodies));
  return partition;
}

}  // namespace cleave

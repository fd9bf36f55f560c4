#include "partition/refiner.h"

#include <algorithm>
#include <cassert>
#include <string>

#include "partition/parameters.h"
#include "partition/refuse.h"

namespace cleave {
namespace {

void check(const BodyGraph& graph, const Partition& partition) {
  const int n = graph.body_count();
  const int entries = static_cast<int>(partition.part_of_body.size());
  if (entries != n) refuse("size of part_of_body", entries, n);
  if (partition.part_count < 0 || partition.part_count > n) {
    refuse("part_count", partition.part_count, "0 to " + std::to_string(n));
  }
  for (int i = 0; i < n; ++i) {
    const int part = partition.part_of_body[i];
    if (part >= 0 && part < partition.part_count) continue;
    refuse("part_of_body of body " + std::to_string(i), part,
           "0 to " + std::to_string(partition.part_count - 1));
  }
  const std::vector<int> sizes = part_sizes(partition);
  const auto empty = std::find(sizes.begin(), sizes.end(), 0);
  if (empty != sizes.end()) refuse("size of part " + std::to_string(empty - sizes.begin()), 0, ">= 1");
}

[[maybe_unused]] bool is_valid(const BodyGraph& graph, const Partition& partition, EdgeWeight unit,
                               const RefineSummary& summary) {
  const std::vector<int> sizes = part_sizes(partition);
  return std::find(sizes.begin(), sizes.end(), 0) == sizes.end() &&
         cut_weight(graph, partition.part_of_body, unit) == summary.cut_after;
}

}  // namespace

RefineSummary Refiner::run(const BodyGraph& graph, int max_bodies, Partition& partition) const {
  if (max_bodies < 1) refuse("max_bodies", max_bodies, ">= 1");
  check(graph, partition);
  const long cut_before = cut_weight(graph, partition.part_of_body, unit_);
  RefineSummary summary{0, cut_before, cut_before};
  do_run(graph, max_bodies, partition, summary);
  assert(is_valid(graph, partition, unit_, summary));
  return summary;
}

EdgeWeight refining_unit(const Settings& settings) {
  if (settings.flag("as-printed")) return EdgeWeight::pairs;
  return settings.word<EdgeWeight>(parameters::edge_weight());
}

}  // namespace cleave

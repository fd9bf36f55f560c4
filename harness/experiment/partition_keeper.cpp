#include "harness/experiment/partition_keeper.h"

#include <algorithm>

#include "harness/base/stopwatch.h"
#include "partition/repair.h"

namespace cleave {
namespace {

// Rows between bodies of different parts over all rows between bodies; 0 where there are none.
double cut_share(const BodyGraph& graph, const Partition& parts) {
  long all = 0, cut = 0;
  for (int body = 0; body < graph.body_count(); ++body)
    for (int k = graph.first(body); k < graph.last(body); ++k) {
      const int rows = graph.weight(k, EdgeWeight::rows);
      all += rows;
      if (parts.part_of_body[body] != parts.part_of_body[graph.neighbour(k)]) cut += rows;
    }
  return all == 0 ? 0 : static_cast<double>(cut) / static_cast<double>(all);
}

int largest_part(const Partition& parts) {
  const std::vector<int> sizes = part_sizes(parts);
  return sizes.empty() ? 1 : std::ranges::max(sizes);
}

}  // namespace

bool PartitionKeeper::is_due(const BodyGraph& graph) const {
  if (!keeps() || !before_ || graph.body_count() < before_->graph.body_count()) return true;
  return rule_.kind == Repartition::Kind::every && before_->steps_since_fresh + 1 >= rule_.steps;
}

void PartitionKeeper::take_over_parts(Split& split) const {
  Stopwatch watch;
  const std::vector<char> changed = changed_bodies(before_->graph, split.graph);
  if (std::ranges::count(changed, 1) == 0) {
    split.origin = PartitionOrigin::kept;
    split.before = split.parts = before_->parts;
    split.partition_ms = watch.lap_ms();
    return;
  }
  split.origin = PartitionOrigin::repaired;
  std::vector<int> part_of_body = before_->parts.part_of_body;
  part_of_body.resize(split.graph.body_count(), -1);
  split.before = take_over(split.graph, part_of_body, before_->most_bodies);
  split.before.choice = before_->parts.choice;
  split.partition_ms = watch.lap_ms();
  split.parts = split.before;
  watch.lap_ms();  // the copy is ours
  move_changed(split.graph, changed, before_->most_bodies, split.parts);
  split.refine_ms = watch.lap_ms();
}

bool PartitionKeeper::drifted(const Split& split) const {
  return rule_.kind == Repartition::Kind::drift &&
         cut_share(split.graph, split.parts) > (1 + rule_.drift) * before_->cut_share;
}

Split PartitionKeeper::run(const Splitter& splitter, const StepProblem& problem, int step,
                           const KnownBodies& known) const {
  Split split;
  Stopwatch watch;
  split.graph = body_graph_of(problem, step, known);
  split.graph_ms = watch.lap_ms();
  double thrown_away_ms = 0;
  if (!is_due(split.graph)) {
    take_over_parts(split);
    const bool is_tree = !before_->parts.parent_of_part.empty();
    if (!drifted(split) && !(is_tree && split.origin == PartitionOrigin::repaired)) return split;
    thrown_away_ms = split.partition_ms + split.refine_ms;
  }
  split.origin = PartitionOrigin::fresh;
  split.refine_ms = 0;
  splitter.run(split);
  split.partition_ms += thrown_away_ms;
  return split;
}

void PartitionKeeper::remember(const Splitter& splitter, const Split& split) {
  if (!keeps()) return;
  Before next{split.graph, split.parts};
  if (split.origin == PartitionOrigin::fresh) {
    next.most_bodies = std::max(splitter.most_bodies(split.parts), largest_part(split.parts));
    next.cut_share = cut_share(split.graph, split.parts);
  } else {
    next.steps_since_fresh = before_->steps_since_fresh + 1;
    next.most_bodies = before_->most_bodies;
    next.cut_share = before_->cut_share;
  }
  before_ = std::move(next);
}

}  // namespace cleave

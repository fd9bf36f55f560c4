#include "partition/merge_small.h"

#include <utility>

#include "partition/leftovers.h"

namespace cleave {
namespace {

constexpr double kMergedGrowth = 0.2;

class MergeSmall final : public Partitioner {
 public:
  MergeSmall(std::unique_ptr<Partitioner> grown, int max_bodies)
      : grown_(std::move(grown)), max_bodies_(max_bodies) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    Partition partition = grown_->run(graph);
    join_leftovers(graph,
                   {.parts = wanted_parts(graph.body_count(), max_bodies_),
                    .small_bodies = max_bodies_ / 2 + max_bodies_ % 2,
                    .most_bodies = most_merged_bodies(max_bodies_)},
                   partition);
    return partition;
  }

  std::unique_ptr<Partitioner> grown_;
  int max_bodies_;
};

}  // namespace

int most_merged_bodies(int max_bodies) { return most_grown_bodies(max_bodies, kMergedGrowth); }

std::unique_ptr<Partitioner> merge_small(std::unique_ptr<Partitioner> grown, int max_bodies) {
  return std::make_unique<MergeSmall>(std::move(grown), max_bodies);
}

}  // namespace cleave

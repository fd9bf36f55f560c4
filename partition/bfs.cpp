// bfs: breadth-first search (Liu & Andrews 2022, section 3.1). The seed is the lowest body in G0. A body that
// joins puts its neighbours in G0 that are not queued yet at the end of the queue, ascending; the first of
// the queue joins next. A part that is closed drops its queue.
#include <memory>

#include "harness/base/parameter.h"
#include "partition/grow.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

class QueueChooser final : public Chooser {
 public:
  explicit QueueChooser(int bodies) : queued_by_(bodies, -1) { queue_.reserve(bodies); }

  int seed(const Growth& growth) override {
    queue_.clear();
    head_ = 0;
    while (!growth.is_left(lowest_left_)) ++lowest_left_;
    return lowest_left_;
  }

  int next(const Growth&) override { return head_ < queue_.size() ? queue_[head_++] : -1; }

  void joined(const Growth& growth, int body) override {
    for (int other : growth.graph.neighbours(body)) {
      if (!growth.is_left(other) || queued_by_[other] == growth.open_part()) continue;
      queued_by_[other] = growth.open_part();
      queue_.push_back(other);
    }
  }

 private:
  int lowest_left_ = 0;
  std::vector<int> queued_by_;  // (n): the last part that queued the body, -1 for none
  std::vector<int> queue_;
  size_t head_ = 0;
};

class BreadthFirst final : public Partitioner {
 public:
  explicit BreadthFirst(int max_bodies) : max_bodies_(max_bodies) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    QueueChooser chooser(graph.body_count());
    return grow(graph, max_bodies_, chooser);
  }

  int max_bodies_;
};

}  // namespace

std::unique_ptr<Partitioner> make_bfs(const Settings& settings) {
  return std::make_unique<BreadthFirst>(settings.integer("max-bodies"));
}

}  // namespace cleave

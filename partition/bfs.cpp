// bfs: breadth-first search (Liu & Andrews 2022, section 3.1). The seed is the lowest body in G0. A body that
// joins puts its neighbours in G0 that are not queued yet at the end of the queue, ascending; the first of
// the queue joins next. A part that is closed drops its queue.
//
// The paper does not say whether the search begins anew with every part. So it does with restart=part; with
// restart=graph the bodies stand in one order, breadth first from the lowest body that is in it not yet, and
// every max_bodies of them are a part, which need not be connected then.
#include <algorithm>
#include <memory>
#include <vector>

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
    lowest_left_ = growth.lowest_left(lowest_left_);
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

// All bodies, each once.
std::vector<int> breadth_first_order(const BodyGraph& graph) {
  std::vector<int> order;
  std::vector<char> is_queued(graph.body_count(), 0);
  order.reserve(graph.body_count());
  const auto queue = [&](int body) {
    if (!is_queued[body]) order.push_back(body);
    is_queued[body] = 1;
  };
  for (int seed = 0; seed < graph.body_count(); ++seed) {
    std::size_t head = order.size();
    for (queue(seed); head < order.size(); ++head)
      std::ranges::for_each(graph.neighbours(order[head]), queue);
  }
  return order;
}

class ChoppedOrder final : public Partitioner {
 public:
  explicit ChoppedOrder(int max_bodies) : max_bodies_(max_bodies) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    const int bodies = graph.body_count();
    Partition partition{std::vector<int>(bodies), 0};
    const std::vector<int> order = breadth_first_order(graph);
    for (int place = 0; place < bodies; ++place) partition.part_of_body[order[place]] = place / max_bodies_;
    if (bodies > 0) partition.part_count = 1 + (bodies - 1) / max_bodies_;
    return partition;
  }

  int max_bodies_;
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

bool is_chopped(const Settings& settings) { return settings.text("restart") == "graph"; }

}  // namespace

// Of parts that are cut from one order of all bodies only the size is known.
PartsPromise bfs_promise_with(const PartsPromise& promise, const Settings& settings) {
  return is_chopped(settings) ? PartsPromise{.at_most_max_bodies = true} : promise;
}

std::unique_ptr<Partitioner> make_bfs(const Settings& settings) {
  const int max_bodies = settings.integer("max-bodies");
  if (is_chopped(settings)) return std::make_unique<ChoppedOrder>(max_bodies);
  return std::make_unique<BreadthFirst>(max_bodies);
}

}  // namespace cleave

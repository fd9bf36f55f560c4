// geometric: recursive coordinate bisection (Berger & Bokhari, A partitioning strategy for nonuniform
// problems on multiprocessors, IEEE Transactions on Computers C-36, 1987), of the centres of the bodies.
//
// A set of bodies that is to become k parts, at first all bodies and k = ceil(n / max-bodies), is ordered by
// the coordinate in which its centres extend farthest (the first one on ties), then by index. The first
//
//     floor(bodies * floor(k / 2) / k)
//
// bodies become floor(k / 2) parts in the same way, the others the rest of the k. So sizes differ by one at
// most, and none is above max-bodies. Edges are not looked at: parts need not be contiguous. O(n log n) on
// the average.
#include <algorithm>
#include <memory>
#include <numeric>
#include <span>

#include "harness/base/parameter.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

class CoordinateBisection {
 public:
  explicit CoordinateBisection(const BodyGraph& graph) : graph_(graph), label_of_body_(graph.body_count()) {}

  Partition run(int parts) {
    std::vector<int> bodies(graph_.body_count());
    std::iota(bodies.begin(), bodies.end(), 0);
    split(bodies, parts);
    return numbered_by_lowest_body(label_of_body_);
  }

 private:
  void split(std::span<int> bodies, int parts) {
    if (parts == 1) {
      for (const int body : bodies) label_of_body_[body] = labels_;
      ++labels_;
      return;
    }
    const int lower_parts = parts / 2;
    const auto lower = static_cast<std::ptrdiff_t>(static_cast<long>(bodies.size()) * lower_parts / parts);
    const int axis = longest_axis(bodies);
    std::nth_element(bodies.begin(), bodies.begin() + lower, bodies.end(), [&](int a, int b) {
      const double x = graph_.position_m(a, axis), y = graph_.position_m(b, axis);
      return x != y ? x < y : a < b;
    });
    split(bodies.first(lower), lower_parts);
    split(bodies.subspan(lower), parts - lower_parts);
  }

  int longest_axis(std::span<const int> bodies) const {
    double extent_m[3];
    for (const int axis : {0, 1, 2}) {
      const auto [low, high] =
          std::ranges::minmax(bodies, {}, [&](int body) { return graph_.position_m(body, axis); });
      extent_m[axis] = graph_.position_m(high, axis) - graph_.position_m(low, axis);
    }
    return static_cast<int>(std::max_element(extent_m, extent_m + 3) - extent_m);
  }

  const BodyGraph& graph_;
  std::vector<int> label_of_body_;  // (n)
  int labels_ = 0;
};

class Geometric final : public Partitioner {
 public:
  explicit Geometric(const Settings& settings) : max_bodies_(settings.integer("max-bodies")) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    const int parts = wanted_parts(graph.body_count(), max_bodies_);
    if (parts <= 1) return {std::vector<int>(graph.body_count(), 0), parts};
    if (!graph.has_positions())
      throw CannotSplit("geometric: the positions of the bodies are not known, which it splits by");
    return CoordinateBisection(graph).run(parts);
  }

  int max_bodies_;
};

}  // namespace

std::unique_ptr<Partitioner> make_geometric(const Settings& settings) {
  return std::make_unique<Geometric>(settings);
}

}  // namespace cleave

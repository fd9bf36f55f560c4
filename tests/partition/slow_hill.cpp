// fm-hill and kl-hill from their definitions: in every step all exchanges of free bodies are listed with
// gains counted anew, and the partition of every moment of a pass is kept.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "tests/partition/slow_hill.h"

namespace cleave::partition_test {
namespace {

constexpr int kPatience = 50;  // the default of fm-hill

class Cut {
 public:
  Cut(const BodyGraph& graph, EdgeWeight unit) : graph_(graph), unit_(unit) {}

  long into(int body, int part, const std::vector<int>& part_of_body) const {
    long sum = 0;
    for (int half = graph_.first(body); half < graph_.last(body); ++half)
      if (part_of_body[graph_.neighbour(half)] == part) sum += graph_.weight(half, unit_);
    return sum;
  }
  long gain(int body, int part, const std::vector<int>& part_of_body) const {
    return into(body, part, part_of_body) - into(body, part_of_body[body], part_of_body);
  }
  long total(const std::vector<int>& part_of_body) const {
    long twice = 0;
    for (int body = 0; body < graph_.body_count(); ++body)
      for (int half = graph_.first(body); half < graph_.last(body); ++half)
        if (part_of_body[body] != part_of_body[graph_.neighbour(half)]) twice += graph_.weight(half, unit_);
    return twice / 2;
  }
  long weight(int a, int b) const {
    for (int half = graph_.first(a); half < graph_.last(a); ++half)
      if (graph_.neighbour(half) == b) return graph_.weight(half, unit_);
    return 0;
  }

 private:
  const BodyGraph& graph_;
  const EdgeWeight unit_;
};

int bodies_in(int part, const std::vector<int>& part_of_body) {
  return static_cast<int>(std::count(part_of_body.begin(), part_of_body.end(), part));
}

// The first moment of least cut: its place, 0 for the start.
std::size_t best_moment(const Cut& cut, const std::vector<std::vector<int>>& moments) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < moments.size(); ++k)
    if (cut.total(moments[k]) < cut.total(moments[best])) best = k;
  return best;
}

using Key = std::tuple<long, int, int>;  // least: greatest gain, then lowest bodies or parts

std::optional<Key> best_move(const std::set<int>& known, const Cut& cut, int most,
                             const std::set<int>& locked, const std::vector<int>& parts, int part_count) {
  std::optional<Key> best;
  for (const int body : known) {
    if (locked.contains(body) || bodies_in(parts[body], parts) == 1) continue;
    for (int part = 0; part < part_count; ++part) {
      if (part == parts[body] || cut.into(body, part, parts) == 0 || bodies_in(part, parts) >= most) continue;
      const Key key{-cut.gain(body, part, parts), body, part};
      if (!best || key < *best) best = key;
    }
  }
  return best;
}

std::optional<Key> best_swap(const Cut& cut, const std::set<int>& locked, int a, int b,
                             const std::vector<int>& parts) {
  std::optional<Key> best;
  const int n = static_cast<int>(parts.size());
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (parts[i] != a || parts[j] != b || locked.contains(i) || locked.contains(j)) continue;
      const long gain = cut.gain(i, b, parts) + cut.gain(j, a, parts) - 2 * cut.weight(i, j);
      const Key key{-gain, std::min(i, j), std::max(i, j)};
      if (!best || key < *best) best = key;
    }
  }
  return best;
}

}  // namespace

std::set<int> SlowClimb::run(std::set<int> known, std::set<int> locked, Partition& partition) const {
  const Cut cut(graph, unit);
  std::vector<std::vector<int>> moments{partition.part_of_body};
  std::vector<int> moved;
  while (static_cast<int>(moments.size() - 1 - best_moment(cut, moments)) < patience) {
    std::vector<int> parts = moments.back();
    const auto move = best_move(known, cut, most_bodies, locked, parts, partition.part_count);
    if (!move) break;
    const int body = std::get<1>(*move);
    parts[body] = std::get<2>(*move);
    locked.insert(body);
    known.insert(graph.neighbours(body).begin(), graph.neighbours(body).end());
    moved.push_back(body);
    moments.push_back(parts);
  }
  const std::size_t best = best_moment(cut, moments);
  partition.part_of_body = moments[best];
  return {moved.begin(), moved.begin() + static_cast<std::ptrdiff_t>(best)};
}

RefineSummary slow_fm_hill(const BodyGraph& graph, const RefineOptions& options, Partition& partition) {
  const Cut cut(graph, options.edge_weight);
  const double most = std::floor((1 + options.max_growth) * options.max_bodies + 1e-9);
  const int bound = static_cast<int>(std::min<double>(graph.body_count(), most));
  std::set<int> all;
  for (int body = 0; body < graph.body_count(); ++body) all.insert(body);
  const SlowClimb climb{graph, options.edge_weight, bound, kPatience};
  RefineSummary summary;
  summary.cut_before = cut.total(partition.part_of_body);
  for (bool again = true; again;) {
    const std::set<int> kept = climb.run(all, {}, partition);
    summary.exchanges += static_cast<int>(kept.size());
    again = !kept.empty();
  }
  summary.cut_after = cut.total(partition.part_of_body);
  return summary;
}

RefineSummary slow_kl_hill(const BodyGraph& graph, const RefineOptions& options, Partition& partition) {
  const Cut cut(graph, options.edge_weight);
  RefineSummary summary;
  summary.cut_before = cut.total(partition.part_of_body);
  for (bool again = true; again;) {
    again = false;
    // The pairs of a round are those that are adjacent at its beginning.
    const std::vector<int> begin = partition.part_of_body;
    for (int a = 0; a < partition.part_count; ++a) {
      for (int b = a + 1; b < partition.part_count; ++b) {
        bool adjacent = false;
        for (int body = 0; body < graph.body_count(); ++body)
          adjacent = adjacent || (begin[body] == a && cut.into(body, b, begin) > 0);
        for (bool more = adjacent; more;) {
          std::vector<std::vector<int>> moments{partition.part_of_body};
          std::set<int> locked;
          while (const auto swap = best_swap(cut, locked, a, b, moments.back())) {
            std::vector<int> parts = moments.back();
            std::swap(parts[std::get<1>(*swap)], parts[std::get<2>(*swap)]);
            locked.insert({std::get<1>(*swap), std::get<2>(*swap)});
            moments.push_back(parts);
          }
          const std::size_t best = best_moment(cut, moments);
          partition.part_of_body = moments[best];
          summary.exchanges += static_cast<int>(best);
          more = best > 0;
          again = again || more;
        }
      }
    }
  }
  summary.cut_after = cut.total(partition.part_of_body);
  return summary;
}

}  // namespace cleave::partition_test

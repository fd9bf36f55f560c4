#include "partition/bisection.h"

#include <algorithm>
#include <utility>

namespace cleave {
namespace {

enum : char { kOut, kIn, kMoved };  // of the buckets, or moved in this pass

constexpr int kLevels = 40;     // each has at most nine tenths of the nodes of the one before
constexpr int kMostLooks = 20;  // at nodes too large to be moved
constexpr double kTooFlat = 0.9;

int any_node(const LevelGraph& graph, Dice& dice) {
  return static_cast<int>(dice.below(static_cast<std::uint64_t>(graph.node_count())));
}

}  // namespace

long Bisection::above() const {
  return std::max(filled_[0] - most_[0], 0) + std::max(filled_[1] - most_[1], 0);
}

bool Bisection::is_allowed(int node_bodies, int from) const {
  const int after = filled_[1 - from] + node_bodies - most_[1 - from];
  return after <= 0 || after < filled_[from] - most_[from];
}

int Bisection::coarsen(const LevelGraph& graph, Dice& dice) {
  levels_.resize(kLevels);
  coarse_of_node_.resize(kLevels);
  const int most_joined = std::max(1, 3 * graph.body_count() / (2 * options_.coarse_nodes));
  for (int k = 0;; ++k) {
    const LevelGraph& finer = k == 0 ? graph : levels_[k];
    if (finer.node_count() <= options_.coarse_nodes || k + 1 == kLevels) return k;
    const int nodes = coarsening_.match(finer, most_joined, any_node(finer, dice), coarse_of_node_[k]);
    if (nodes > kTooFlat * finer.node_count()) return k;
    coarsening_.contract(finer, coarse_of_node_[k], nodes, levels_[k + 1]);
  }
}

long Bisection::run(const LevelGraph& graph, int wanted, std::array<int, 2> most, Dice& dice,
                    std::vector<char>& side) {
  most_ = most;
  const int coarsest = coarsen(graph, dice);
  long cut = start(coarsest == 0 ? graph : levels_[coarsest], wanted, dice, side);
  for (int k = coarsest - 1; k >= 0; --k) {
    give_to_finer(coarse_of_node_[k], side, finer_);
    cut = refine(k == 0 ? graph : levels_[k], side).cut;
  }
  return cut;
}

long Bisection::start(const LevelGraph& graph, int wanted, Dice& dice, std::vector<char>& side) {
  Moment least;
  for (int k = 0; k < options_.growths; ++k) {
    const int any = any_node(graph, dice);
    grow(graph, wanted, k % 2 == 0 ? farthest(graph, farthest(graph, any)) : any, trial_);
    const Moment found = refine(graph, trial_);
    if (k > 0 && !(found < least)) continue;
    least = found;
    side = trial_;
  }
  return least.cut;
}

// The node that breadth-first search reaches last.
int Bisection::farthest(const LevelGraph& graph, int seed) {
  state_.assign(graph.node_count(), kOut);
  queue_.assign(1, seed);
  state_[seed] = kIn;
  for (std::size_t k = 0; k < queue_.size(); ++k) {
    for (const int other : graph.neighbours(queue_[k])) {
      if (std::exchange(state_[other], kIn) == kOut) queue_.push_back(other);
    }
  }
  return queue_.back();
}

// Greedy growing (Karypis and Kumar 1998): side 0 takes the node next to it that adds least to the cut, until
// it has what is wanted. An island that is used up is followed by the lowest node that is left.
void Bisection::grow(const LevelGraph& graph, int wanted, int seed, std::vector<char>& side) {
  const int nodes = graph.node_count();
  side.assign(nodes, 1);
  state_.assign(nodes, kOut);
  gain_.resize(nodes);
  for (int node = 0; node < nodes; ++node) {
    gain_[node] = 0;
    for (int k = graph.first[node]; k < graph.first[node + 1]; ++k) gain_[node] -= graph.weight[k];
  }
  queue_.assign(1, seed);  // the rim
  state_[seed] = kIn;
  int lowest = 0;
  for (int filled = 0; filled < wanted;) {
    while (queue_.empty() && lowest < nodes) {
      if (state_[lowest] == kOut) queue_.push_back(lowest), state_[lowest] = kIn;
      ++lowest;
    }
    if (queue_.empty()) return;
    std::size_t best = 0;
    for (std::size_t k = 1; k < queue_.size(); ++k)
      if (gain_[queue_[k]] > gain_[queue_[best]]) best = k;
    const int node = queue_[best];
    queue_[best] = queue_.back();
    queue_.pop_back();
    if (filled + graph.bodies[node] > wanted + graph.bodies[node] / 2) continue;
    side[node] = 0;
    filled += graph.bodies[node];
    for (int k = graph.first[node]; k < graph.first[node + 1]; ++k) {
      const int other = graph.neighbour[k];
      gain_[other] += 2 * graph.weight[k];
      if (std::exchange(state_[other], kIn) == kOut) queue_.push_back(other);
    }
  }
}

// Gains of all nodes, and into the buckets, which are empty before, those at the cut, or all where bodies are
// above the bounds.
Bisection::Moment Bisection::take(const LevelGraph& graph, const std::vector<char>& side) {
  const int nodes = graph.node_count();
  filled_ = {};
  for (int node = 0; node < nodes; ++node) filled_[static_cast<int>(side[node])] += graph.bodies[node];
  gain_.resize(nodes);
  next_.resize(nodes);
  previous_.resize(nodes);
  state_.assign(nodes, kOut);
  const bool all = above() > 0;
  offset_ = 0;
  queue_.clear();
  long twice = 0;
  for (int node = 0; node < nodes; ++node) {
    int outside = 0, total = 0;
    for (int k = graph.first[node]; k < graph.first[node + 1]; ++k) {
      total += graph.weight[k];
      outside += side[node] == side[graph.neighbour[k]] ? 0 : graph.weight[k];
    }
    gain_[node] = 2 * outside - total;
    offset_ = std::max(offset_, total);
    twice += outside;
    if (outside > 0 || all) queue_.push_back(node);
  }
  for (int s = 0; s < 2; ++s) {
    bucket_[s].resize(std::max(bucket_[s].size(), 2 * static_cast<std::size_t>(offset_) + 1), -1);
    top_[s] = -1;
  }
  for (const int node : queue_) insert(node, side[node]);
  return {above(), twice / 2};
}

void Bisection::insert(int node, int side) {
  const int place = gain_[node] + offset_;
  int& head = bucket_[side][place];
  next_[node] = head;
  previous_[node] = -1;
  if (head >= 0) previous_[head] = node;
  head = node;
  state_[node] = kIn;
  top_[side] = std::max(top_[side], place);
}

void Bisection::remove(int node, int side) {
  if (previous_[node] >= 0) {
    next_[previous_[node]] = next_[node];
  } else {
    bucket_[side][gain_[node] + offset_] = next_[node];
  }
  if (next_[node] >= 0) previous_[next_[node]] = previous_[node];
  state_[node] = kOut;
}

// The node of greatest gain on that side that may be moved, the one that came last first; -1 for none.
int Bisection::best(const LevelGraph& graph, int side) {
  int& top = top_[side];
  while (top >= 0 && bucket_[side][top] < 0) --top;
  int looks = 0;
  for (int place = top; place >= 0; --place) {
    for (int node = bucket_[side][place]; node >= 0; node = next_[node]) {
      if (is_allowed(graph.bodies[node], side)) return node;
      if (++looks == kMostLooks) return -1;
    }
  }
  return -1;
}

// The node to move next, -1 for none: of the side that is above its bound, else of greater gain, else of the
// fuller side.
int Bisection::choose(const LevelGraph& graph) {
  const std::array<int, 2> room{most_[0] - filled_[0], most_[1] - filled_[1]};
  if (room[0] < 0 || room[1] < 0) return best(graph, room[0] < room[1] ? 0 : 1);
  const std::array<int, 2> node{best(graph, 0), best(graph, 1)};
  if (node[0] < 0 || node[1] < 0) return std::max(node[0], node[1]);
  if (gain_[node[0]] != gain_[node[1]]) return gain_[node[0]] > gain_[node[1]] ? node[0] : node[1];
  return room[0] <= room[1] ? node[0] : node[1];
}

// To the other side, where it stays out of the buckets.
void Bisection::move(const LevelGraph& graph, int node, std::vector<char>& side) {
  const int from = side[node];
  if (state_[node] == kIn) remove(node, from);
  state_[node] = kMoved;
  side[node] = static_cast<char>(1 - from);
  filled_[from] -= graph.bodies[node];
  filled_[1 - from] += graph.bodies[node];
  gain_[node] = -gain_[node];
  for (int k = graph.first[node]; k < graph.first[node + 1]; ++k) {
    const int other = graph.neighbour[k], own = side[other];
    if (state_[other] == kIn) remove(other, own);
    gain_[other] += own == from ? 2 * graph.weight[k] : -2 * graph.weight[k];
    if (state_[other] != kMoved) insert(other, own);
  }
}

// Whether it brought something. Gains and buckets are true again at its end.
bool Bisection::pass(const LevelGraph& graph, std::vector<char>& side, Moment& now) {
  moved_.clear();
  Moment moment = now;
  std::size_t kept = 0;
  while (moved_.size() - kept <= static_cast<std::size_t>(options_.patience)) {
    const int node = choose(graph);
    if (node < 0) break;
    moment.cut -= gain_[node];
    move(graph, node, side);
    moment.above = above();
    moved_.push_back(node);
    if (!(moment < now)) continue;
    now = moment;
    kept = moved_.size();
  }
  for (std::size_t k = moved_.size(); k > kept; --k) move(graph, moved_[k - 1], side);
  for (const int node : moved_) insert(node, side[node]);
  return kept > 0;
}

Bisection::Moment Bisection::refine(const LevelGraph& graph, std::vector<char>& side) {
  Moment now = take(graph, side);
  for (int k = 0; k < options_.most_passes && pass(graph, side, now); ++k) {
  }
  for (int node = 0; node < graph.node_count(); ++node)  // the buckets are left empty
    if (state_[node] == kIn) bucket_[static_cast<int>(side[node])][gain_[node] + offset_] = -1;
  return now;
}

}  // namespace cleave

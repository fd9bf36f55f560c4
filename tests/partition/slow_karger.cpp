#include "tests/partition/slow_karger.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>

namespace cleave::partition_test {
namespace {

struct Edge {
  int a, b;
  long weight;
};

int bodies_of(const std::vector<int>& node_of_body, int node) {
  return static_cast<int>(std::ranges::count(node_of_body, node));
}

int nodes_in(const std::vector<int>& node_of_body) {
  return static_cast<int>(std::set(node_of_body.begin(), node_of_body.end()).size());
}

// 0, 1, 2, ... in place of any names, in the order in which they come.
std::vector<int> counted_up(const std::vector<int>& names) {
  std::map<int, int> number;
  std::vector<int> numbers;
  for (const int name : names)
    numbers.push_back(number.emplace(name, static_cast<int>(number.size())).first->second);
  return numbers;
}

WeightMatrix between_nodes(const WeightMatrix& weights, const std::vector<int>& node_of_body) {
  const int nodes = nodes_in(node_of_body);
  WeightMatrix between(nodes, std::vector<long>(nodes, 0));
  for (std::size_t a = 0; a < weights.size(); ++a)
    for (std::size_t b = 0; b < weights.size(); ++b)
      if (node_of_body[a] != node_of_body[b]) between[node_of_body[a]][node_of_body[b]] += weights[a][b];
  return between;
}

WeightMatrix among(const WeightMatrix& weights, const std::vector<int>& members) {
  WeightMatrix some;
  for (const int a : members) {
    some.emplace_back();
    for (const int b : members) some.back().push_back(weights[a][b]);
  }
  return some;
}

// Of a set that is connected: its parts, one after the other, as the lowest body of each.
void bisect(const WeightMatrix& weights, const std::vector<int>& members, int max_bodies, Dice& dice,
            std::vector<int>& part_of_body) {
  if (static_cast<int>(members.size()) <= max_bodies) {
    for (const int body : members) part_of_body[body] = members.front();
    return;
  }
  const std::vector<int> side = slow_karger_stein(among(weights, members), dice);
  for (const int wanted : {0, 1}) {
    std::vector<int> half;
    for (std::size_t k = 0; k < members.size(); ++k)
      if (side[k] == wanted) half.push_back(members[k]);
    bisect(weights, half, max_bodies, dice, part_of_body);
  }
}

std::vector<int> slow_trial(const Bodies& bodies, const WeightMatrix& weights, const KargerOptions& options,
                            Dice& dice) {
  const double n = bodies.count(), most = std::floor((1 + options.max_growth) * options.max_bodies + 1e-9);
  if (!options.bisects)
    return slow_contract(weights, static_cast<int>(std::ceil(n / options.max_bodies)), static_cast<int>(most),
                         dice)
        .node_of_body;
  const std::vector<int> islands = islands_by_union_find(bodies);
  std::vector<int> part_of_body(bodies.count());
  for (int island = 0; island < bodies.count(); ++island) {
    std::vector<int> members;
    for (int body = 0; body < bodies.count(); ++body)
      if (islands[body] == island) members.push_back(body);
    if (!members.empty()) bisect(weights, members, options.max_bodies, dice, part_of_body);
  }
  return part_of_body;
}

}  // namespace

SlowContraction slow_contract(const WeightMatrix& weights, int nodes, int most_bodies, Dice& dice) {
  const int n = static_cast<int>(weights.size());
  std::vector<Edge> edges;
  SlowContraction found;
  for (int a = 0; a < n; ++a) {
    found.node_of_body.push_back(a);
    for (int b = a + 1; b < n; ++b)
      if (weights[a][b] > 0) edges.push_back({a, b, weights[a][b]});
  }
  while (nodes_in(found.node_of_body) > nodes && !edges.empty()) {
    long total = 0;
    for (const Edge& edge : edges) total += edge.weight;
    long number = static_cast<long>(dice.below(total));
    auto drawn = edges.begin();
    while (number >= drawn->weight) number -= drawn++->weight;
    const auto [low, high] = std::minmax({found.node_of_body[drawn->a], found.node_of_body[drawn->b]});
    edges.erase(drawn);
    if (low == high) continue;
    if (bodies_of(found.node_of_body, low) + bodies_of(found.node_of_body, high) > most_bodies)
      ++found.refused;
    else
      std::ranges::replace(found.node_of_body, high, low);
  }
  return found;
}

std::vector<int> slow_karger_stein(const WeightMatrix& weights, Dice& dice) {
  const int n = static_cast<int>(weights.size());
  if (n <= 6) return counted_up(slow_contract(weights, 2, n, dice).node_of_body);
  std::vector<int> best;
  for (int time = 0; time < 2; ++time) {
    const int fewer = static_cast<int>(std::ceil(n / std::sqrt(2.0) + 1));
    const std::vector<int> node_of_body = counted_up(slow_contract(weights, fewer, n, dice).node_of_body);
    const std::vector<int> side_of_node = slow_karger_stein(between_nodes(weights, node_of_body), dice);
    std::vector<int> side;
    for (const int node : node_of_body) side.push_back(side_of_node[node]);
    if (best.empty() || weight_between(weights, side) < weight_between(weights, best)) best = side;
  }
  return best;
}

Partition slow_karger(const Bodies& bodies, const KargerOptions& options) {
  const WeightMatrix weights = link_weights(bodies, options.unit);
  Dice dice(options.seed);
  std::optional<std::tuple<long, int, int>> best;  // cut, parts, trial
  std::vector<int> best_parts;
  for (int trial = 0; trial < options.trials; ++trial) {
    const std::vector<int> parts = slow_trial(bodies, weights, options, dice);
    const std::tuple found{counted_cut(bodies, parts, options.unit), nodes_in(parts), trial};
    if (best && found > *best) continue;
    best = found;
    best_parts = parts;
  }
  return {counted_up(best_parts), std::get<1>(*best)};
}

long weight_between(const WeightMatrix& weights, const std::vector<int>& side_of_node) {
  long weight = 0;
  for (std::size_t a = 0; a < weights.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (side_of_node[a] != side_of_node[b]) weight += weights[a][b];
  return weight;
}

long least_cut(const WeightMatrix& weights) {
  const int n = static_cast<int>(weights.size());
  long least = std::numeric_limits<long>::max();
  for (int mask = 1; mask < 1 << (n - 1); ++mask) {  // node n - 1 stays on side 0
    std::vector<int> side;
    for (int node = 0; node < n; ++node) side.push_back(mask >> node & 1);
    least = std::min(least, weight_between(weights, side));
  }
  return least;
}

}  // namespace cleave::partition_test

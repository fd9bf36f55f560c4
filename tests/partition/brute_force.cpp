#include "tests/partition/brute_force.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

namespace cleave::partition_test {
namespace {

bool is_edge(const ConstraintLink& link) {
  return link.body_a >= 0 && link.body_b >= 0 && link.body_a != link.body_b;
}

std::vector<int> members_of(const std::vector<int>& part_of_body, int part) {
  std::vector<int> members;
  for (int body = 0; body < static_cast<int>(part_of_body.size()); ++body) {
    if (part_of_body[body] == part) members.push_back(body);
  }
  return members;
}

// Whether all members are reached from the first one through links inside the part.
bool connected(const Bodies& bodies, const std::vector<int>& part_of_body, int part) {
  const std::vector<int> members = members_of(part_of_body, part);
  if (members.empty()) return true;
  std::set<int> reached{members.front()};
  for (bool grown = true; grown;) {
    grown = false;
    for (const ConstraintLink& link : bodies.links) {
      if (!is_edge(link) || part_of_body[link.body_a] != part || part_of_body[link.body_b] != part) continue;
      if (reached.contains(link.body_a) == reached.contains(link.body_b)) continue;
      reached.insert({link.body_a, link.body_b});
      grown = true;
    }
  }
  return reached.size() == members.size();
}

std::set<std::pair<int, int>> cut_pairs_of(const Bodies& bodies, const std::vector<int>& part_of_body) {
  std::set<std::pair<int, int>> pairs;
  for (const ConstraintLink& link : bodies.links) {
    if (!is_edge(link) || part_of_body[link.body_a] == part_of_body[link.body_b]) continue;
    pairs.insert(std::minmax(link.body_a, link.body_b));
  }
  return pairs;
}

// Greedy vertex cover: the body with the most uncovered cut edges, the lowest index on ties, until all are
// covered.
int greedy_cover_size(int bodies, std::set<std::pair<int, int>> uncovered) {
  int size = 0;
  while (!uncovered.empty()) {
    std::vector<int> edges_of_body(bodies, 0);
    for (const auto& [a, b] : uncovered) {
      ++edges_of_body[a];
      ++edges_of_body[b];
    }
    const int chosen = static_cast<int>(std::ranges::max_element(edges_of_body) - edges_of_body.begin());
    std::erase_if(uncovered, [&](const auto& edge) { return edge.first == chosen || edge.second == chosen; });
    ++size;
  }
  return size;
}

double largest_mass_ratio(const Bodies& bodies, const std::vector<int>& part_of_body) {
  double largest = 1;
  for (int a = 0; a < bodies.count(); ++a) {
    for (int b = 0; b < bodies.count(); ++b) {
      if (part_of_body[a] == part_of_body[b])
        largest = std::max(largest, bodies.mass_kg[a] / bodies.mass_kg[b]);
    }
  }
  return largest;
}

}  // namespace

WeightMatrix link_weights(const Bodies& bodies, EdgeWeight unit) {
  WeightMatrix weights(bodies.count(), std::vector<long>(bodies.count(), 0));
  for (const ConstraintLink& link : bodies.links) {
    if (!is_edge(link)) continue;
    for (const auto& [a, b] : {std::pair(link.body_a, link.body_b), std::pair(link.body_b, link.body_a)}) {
      if (unit == EdgeWeight::pairs) weights[a][b] = 1;
      if (unit == EdgeWeight::constraints) weights[a][b] += 1;
      if (unit == EdgeWeight::rows) weights[a][b] += link.rows;
    }
  }
  return weights;
}

long counted_cut(const Bodies& bodies, const std::vector<int>& part_of_body, EdgeWeight unit) {
  const WeightMatrix weights = link_weights(bodies, unit);
  long cut = 0;
  for (int a = 0; a < bodies.count(); ++a) {
    for (int b = a + 1; b < bodies.count(); ++b) {
      if (part_of_body[a] != part_of_body[b]) cut += weights[a][b];
    }
  }
  return cut;
}

PartitionMetrics metrics_by_counting(const Bodies& bodies, const std::vector<int>& part_of_body) {
  PartitionMetrics metrics;
  const std::set<int> parts(part_of_body.begin(), part_of_body.end());
  metrics.parts = static_cast<int>(parts.size());
  for (int part : parts) {
    const int size = static_cast<int>(members_of(part_of_body, part).size());
    metrics.max_part_bodies = std::max(metrics.max_part_bodies, size);
    metrics.contiguous = metrics.contiguous && connected(bodies, part_of_body, part);
  }
  for (const ConstraintLink& link : bodies.links) {
    if (!is_edge(link) || part_of_body[link.body_a] == part_of_body[link.body_b]) continue;
    metrics.cut_constraints += 1;
    metrics.interface_rows += link.rows;
  }
  const std::set<std::pair<int, int>> pairs = cut_pairs_of(bodies, part_of_body);
  std::set<int> at_the_cut;
  for (const auto& [a, b] : pairs) at_the_cut.insert({a, b});
  metrics.cut_pairs = static_cast<int>(pairs.size());
  metrics.interface_bodies = static_cast<int>(at_the_cut.size());
  metrics.interface_cover_bodies = greedy_cover_size(bodies.count(), pairs);
  metrics.part_mass_ratio_max = largest_mass_ratio(bodies, part_of_body);
  return metrics;
}

std::vector<int> islands_by_union_find(const Bodies& bodies) {
  std::vector<int> parent(bodies.count());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int body) {
    while (parent[body] != body) body = parent[body];
    return body;
  };
  for (const ConstraintLink& link : bodies.links) {
    if (!is_edge(link)) continue;
    const auto [low, high] = std::minmax({root(link.body_a), root(link.body_b)});
    parent[high] = low;  // a root stays the lowest body of its island
  }
  std::vector<int> island(bodies.count());
  int islands = 0;
  for (int body = 0; body < bodies.count(); ++body)
    island[body] = root(body) == body ? islands++ : island[root(body)];
  return island;
}

std::string ids_fault(const Bodies& bodies, const Partition& partition) {
  std::ostringstream fault;
  if (static_cast<int>(partition.part_of_body.size()) != bodies.count()) {
    fault << partition.part_of_body.size() << " part ids for " << bodies.count() << " bodies";
    return fault.str();
  }
  for (int body = 0; body < bodies.count(); ++body) {
    const int part = partition.part_of_body[body];
    if (part >= 0 && part < partition.part_count) continue;
    fault << "body " << body << " has part " << part << " of " << partition.part_count;
    return fault.str();
  }
  for (int part = 0; part < partition.part_count; ++part) {
    if (members_of(partition.part_of_body, part).empty()) {
      fault << "part " << part << " is empty";
      return fault.str();
    }
  }
  return "";
}

std::string grown_fault(const Bodies& bodies, const Partition& partition, int max_bodies) {
  if (const std::string fault = ids_fault(bodies, partition); !fault.empty()) return fault;
  std::ostringstream fault;
  for (int part = 0; part < partition.part_count; ++part) {
    const int size = static_cast<int>(members_of(partition.part_of_body, part).size());
    if (size > max_bodies) fault << "part " << part << " has " << size << " bodies; ";
    if (!connected(bodies, partition.part_of_body, part)) fault << "part " << part << " is not connected; ";
  }
  return fault.str();
}

std::string refined_fault(const Bodies& bodies, const Partition& before, const Partition& after,
                          const RefineOptions& options, const RefineSummary& summary, bool may_raise_cut) {
  if (const std::string fault = ids_fault(bodies, after); !fault.empty()) return fault;
  std::ostringstream fault;
  if (after.part_count != before.part_count)
    fault << after.part_count << " parts of " << before.part_count << "; ";
  const double bound = std::floor((1 + options.max_growth) * options.max_bodies + 1e-9);
  for (int part = 0; part < after.part_count && !options.as_printed; ++part) {
    const std::size_t old_size = members_of(before.part_of_body, part).size();
    const std::size_t size = members_of(after.part_of_body, part).size();
    if (size > old_size && static_cast<double>(size) > bound)
      fault << "part " << part << " grew to " << size << "; ";
  }
  const EdgeWeight unit = options.as_printed ? EdgeWeight::pairs : options.edge_weight;
  const long cut_before = counted_cut(bodies, before.part_of_body, unit);
  const long cut_after = counted_cut(bodies, after.part_of_body, unit);
  if (summary.cut_before != cut_before)
    fault << "cut_before " << summary.cut_before << ", is " << cut_before << "; ";
  if (summary.cut_after != cut_after)
    fault << "cut_after " << summary.cut_after << ", is " << cut_after << "; ";
  if (cut_after > cut_before && !may_raise_cut)
    fault << "cut rises from " << cut_before << " to " << cut_after << "; ";
  if (summary.exchanges < 0) fault << "exchanges " << summary.exchanges << "; ";
  return fault.str();
}

}  // namespace cleave::partition_test

// The five growing rules of Liu & Andrews 2022, section 3.1. G0 is the set of bodies that are in no part yet.
// While G0 is not empty: take a seed, then add one body of G0 that touches the part at a time, until the part
// has max_bodies bodies or nothing can be added. Bodies are always scanned in ascending order and only a
// strictly better one replaces the best so far, so every tie goes to the lowest index.
#include <algorithm>
#include <deque>

#include "tests/partition/slow_twins.h"

namespace cleave::partition_test {
namespace {

constexpr int kInG0 = -1;

Partition all_in_g0(const BodyGraph& graph) { return {std::vector<int>(graph.body_count(), kInG0), 0}; }

bool in_g0(const Partition& partition, int body) { return partition.part_of_body[body] == kInG0; }

std::vector<int> bodies_of_g0(const Partition& partition) {
  std::vector<int> bodies;
  for (int body = 0; body < static_cast<int>(partition.part_of_body.size()); ++body) {
    if (in_g0(partition, body)) bodies.push_back(body);
  }
  return bodies;
}

// Total weight of the edges between a body and the members of a part (or of G0, for part = kInG0).
int weight_into(const BodyGraph& graph, const Partition& partition, int body, int part, EdgeWeight unit) {
  int sum = 0;
  for (int half = graph.first(body); half < graph.last(body); ++half) {
    if (partition.part_of_body[graph.neighbour(half)] == part) sum += graph.weight(half, unit);
  }
  return sum;
}

std::vector<int> bodies_of_g0_touching(const BodyGraph& graph, const Partition& partition, int part) {
  std::vector<int> bodies;
  for (int body : bodies_of_g0(partition)) {
    if (weight_into(graph, partition, body, part, EdgeWeight::pairs) > 0) bodies.push_back(body);
  }
  return bodies;
}

int degree_of(const BodyGraph& graph, const Partition& partition, int body, DegreeUnit counted,
              DegreeScope scope) {
  int sum = 0;
  for (int half = graph.first(body); half < graph.last(body); ++half) {
    if (scope == DegreeScope::left && !in_g0(partition, graph.neighbour(half))) continue;
    sum += counted == DegreeUnit::bodies ? 1 : graph.weight(half, EdgeWeight::constraints);
  }
  return sum;
}

int least_degree(const BodyGraph& graph, const Partition& partition, const std::vector<int>& candidates,
                 const PartitionOptions& options) {
  const auto degree = [&](int body) {
    return degree_of(graph, partition, body, options.degree, options.degree_scope);
  };
  int best = candidates.front();
  for (int body : candidates) {
    if (degree(body) < degree(best)) best = body;
  }
  return best;
}

Partition mindp(const BodyGraph& graph, const PartitionOptions& options) {
  Partition partition = all_in_g0(graph);
  while (!bodies_of_g0(partition).empty()) {
    const int part = partition.part_count++;
    std::vector<int> candidates = bodies_of_g0(partition);
    for (int size = 0; size < options.max_bodies && !candidates.empty(); ++size) {
      partition.part_of_body[least_degree(graph, partition, candidates, options)] = part;
      candidates = bodies_of_g0_touching(graph, partition, part);
    }
  }
  return partition;
}

Partition maxdp(const BodyGraph& graph, const PartitionOptions& options) {
  const DegreeUnit counted = options.as_printed ? DegreeUnit::constraints : options.degree;
  Partition partition = all_in_g0(graph);
  while (!bodies_of_g0(partition).empty()) {
    const int part = partition.part_count++;
    std::vector<int> candidates = bodies_of_g0(partition);
    for (int size = 0; size < options.max_bodies && !candidates.empty(); ++size) {
      int best = candidates.front();
      for (int body : candidates) {
        if (degree_of(graph, partition, body, counted, options.degree_scope) >
            degree_of(graph, partition, best, counted, options.degree_scope)) {
          best = body;
        }
      }
      partition.part_of_body[best] = part;
      candidates = bodies_of_g0_touching(graph, partition, part);
    }
  }
  return partition;
}

Partition bfs(const BodyGraph& graph, const PartitionOptions& options) {
  Partition partition = all_in_g0(graph);
  while (!bodies_of_g0(partition).empty()) {
    const int part = partition.part_count++;
    std::deque<int> queue{bodies_of_g0(partition).front()};
    for (int size = 0; size < options.max_bodies && !queue.empty(); ++size) {
      const int body = queue.front();
      queue.pop_front();
      partition.part_of_body[body] = part;
      for (int other = 0; other < graph.body_count(); ++other) {
        const bool adjacent = std::ranges::count(graph.neighbours(body), other) > 0;
        const bool queued = std::ranges::count(queue, other) > 0;
        if (adjacent && in_g0(partition, other) && !queued) queue.push_back(other);
      }
    }
  }
  return partition;
}

// mr: m_i of the test max(m_i, m_j) / min(m_i, m_j) < tau_mr is the least mass of the part so far.
double least_mass_kg(const BodyGraph& graph, const Partition& partition, int part) {
  double least = 0;
  for (int body = 0; body < graph.body_count(); ++body) {
    if (partition.part_of_body[body] != part) continue;
    least = least == 0 ? graph.mass_kg(body) : std::min(least, graph.mass_kg(body));
  }
  return least;
}

Partition mass_ratio(const BodyGraph& graph, const PartitionOptions& options) {
  Partition partition = all_in_g0(graph);
  while (!bodies_of_g0(partition).empty()) {
    const int part = partition.part_count++;
    partition.part_of_body[bodies_of_g0(partition).front()] = part;
    for (int size = 1; size < options.max_bodies; ++size) {
      const double part_kg = least_mass_kg(graph, partition, part);
      const std::vector<int> candidates = bodies_of_g0_touching(graph, partition, part);
      const auto fits = [&](int body) {
        const double body_kg = graph.mass_kg(body);
        return std::max(part_kg, body_kg) / std::min(part_kg, body_kg) < options.tau_mr;
      };
      const auto chosen = std::ranges::find_if(candidates, fits);
      if (chosen == candidates.end()) break;
      partition.part_of_body[*chosen] = part;
    }
  }
  return partition;
}

Partition mix(const BodyGraph& graph, const PartitionOptions& options) {
  const EdgeWeight unit = options.as_printed ? EdgeWeight::constraints : options.edge_weight;
  Partition partition = all_in_g0(graph);
  while (!bodies_of_g0(partition).empty()) {
    const int part = partition.part_count++;
    std::vector<int> candidates = bodies_of_g0(partition);
    for (int size = 0; size < options.max_bodies && !candidates.empty(); ++size) {
      int best = candidates.front();
      if (size < options.tau_mix * options.max_bodies) {
        best = least_degree(graph, partition, candidates, options);
      } else {
        for (int body : candidates) {
          if (weight_into(graph, partition, body, part, unit) >
              weight_into(graph, partition, best, part, unit)) {
            best = body;
          }
        }
      }
      partition.part_of_body[best] = part;
      candidates = bodies_of_g0_touching(graph, partition, part);
    }
  }
  return partition;
}

constexpr PartitionerTwin kPartitioners[] = {
    {"mindp", mindp}, {"maxdp", maxdp}, {"bfs", bfs}, {"mr", mass_ratio}, {"mix", mix},
};

}  // namespace

std::span<const PartitionerTwin> partitioner_twins() { return kPartitioners; }

}  // namespace cleave::partition_test

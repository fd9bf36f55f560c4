#include "partition/partitioner.h"

#include <cassert>
#include <string>
#include <vector>

#include "partition/refuse.h"

namespace cleave {
namespace {

std::string at_body(int body, const Partition& partition) {
  return "body " + std::to_string(body) + " is in part " + std::to_string(partition.part_of_body[body]);
}

// What holds for every partitioner.
std::string find_fault(const BodyGraph& graph, const Partition& partition) {
  const int bodies = static_cast<int>(partition.part_of_body.size());
  if (bodies != graph.body_count())
    return std::to_string(bodies) + " part ids for " + std::to_string(graph.body_count()) + " bodies";
  for (int body = 0; body < bodies; ++body) {
    const int part = partition.part_of_body[body];
    if (part < 0 || part >= partition.part_count)
      return at_body(body, partition) + " of " + std::to_string(partition.part_count);
  }
  const std::vector<int> sizes = part_sizes(partition);
  for (int part = 0; part < partition.part_count; ++part)
    if (sizes[part] == 0) return "part " + std::to_string(part) + " is empty";
  return "";
}

// most_bodies: of a part.
std::string find_large_part(const Partition& partition, int most_bodies) {
  const std::vector<int> sizes = part_sizes(partition);
  for (int part = 0; part < partition.part_count; ++part)
    if (sizes[part] > most_bodies)
      return "part " + std::to_string(part) + " has " + std::to_string(sizes[part]) +
             " bodies, promised were at most " + std::to_string(most_bodies);
  return "";
}

// A growing part takes what it touches until it is full.
std::string find_early_end(const BodyGraph& graph, const Partition& partition, int max_bodies) {
  const std::vector<int> sizes = part_sizes(partition);
  for (int body = 0; body < graph.body_count(); ++body) {
    const int part = partition.part_of_body[body];
    if (sizes[part] >= max_bodies) continue;
    for (const int other : graph.neighbours(body))
      if (partition.part_of_body[other] > part)
        return at_body(body, partition) + ", which has room, and touches " + at_body(other, partition);
  }
  return "";
}

}  // namespace

std::string find_broken_promise(const BodyGraph& graph, const Partition& partition,
                                const PartsPromise& promise, std::optional<int> max_bodies,
                                std::optional<int> grown_bodies) {
  std::string fault = find_fault(graph, partition);
  if (fault.empty() && promise.at_most_max_bodies) fault = find_large_part(partition, max_bodies.value());
  if (fault.empty() && promise.at_most_grown_bodies) fault = find_large_part(partition, grown_bodies.value());
  if (!fault.empty()) return fault;
  if (promise.contiguous && count_pieces(graph, partition.part_of_body) != partition.part_count)
    return "a part is not connected within itself";
  return promise.grown_in_order ? find_early_end(graph, partition, max_bodies.value()) : "";
}

Partition Partitioner::run(const BodyGraph& graph) const {
  Partition partition = do_run(graph);
  assert(find_broken_promise(graph, partition, promise_, max_bodies_, grown_bodies_).empty());
  return partition;
}

void Partitioner::keep_choice(const std::string& choice) {
  refuse("choice of a partitioner that chooses nothing", choice, "none");
}

}  // namespace cleave

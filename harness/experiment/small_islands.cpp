#include "harness/experiment/small_islands.h"

#include <utility>

namespace cleave {

SmallIslands::SmallIslands(const BodyGraph& graph, int max_bodies) {
  std::vector<int> island_of_body;
  std::vector<int> island_size(count_islands(graph, &island_of_body), 0);
  for (const int island : island_of_body) ++island_size[island];

  std::vector<int> small_of_island(island_size.size(), -1), set_of_body;
  for (const int island : island_of_body) {
    const bool is_small = island_size[island] <= max_bodies;
    if (is_small && small_of_island[island] < 0) small_of_island[island] = small_count_++;
    small_of_body_.push_back(small_of_island[island]);
    set_of_body.push_back(is_small ? -1 : 0);
  }
  large_ = std::move(graph.induced(set_of_body, 1).front());
}

Partition SmallIslands::with_small(const Partition& large) const {
  Partition all{{}, large.part_count + small_count_};
  std::size_t next = 0;
  for (const int small : small_of_body_)
    all.part_of_body.push_back(small < 0 ? large.part_of_body[next++] : large.part_count + small);
  return all;
}

Partition SmallIslands::with_small_in_tree(const Partition& large) const {
  Partition all = with_small(large);
  if (all.part_count == 1) all.parent_of_part = {-1};
  if (all.part_count <= 1) return all;
  // Inner nodes come after all leaves. Without any, one that holds large islands and small ones is made.
  const int nodes = static_cast<int>(large.parent_of_part.size()), leaves = large.part_count;
  const int root = nodes > leaves ? nodes - 1 + small_count_ : all.part_count;
  const auto add = [&](int node) {
    const int parent = large.parent_of_part[node];
    all.parent_of_part.push_back(parent < 0 ? -1 : parent + small_count_);
  };
  if (nodes > leaves)
    for (int leaf = 0; leaf < leaves; ++leaf) add(leaf);
  else
    all.parent_of_part.assign(leaves, root);
  all.parent_of_part.insert(all.parent_of_part.end(), small_count_, root);
  for (int inner = leaves; inner < nodes; ++inner) add(inner);
  if (nodes == leaves) all.parent_of_part.push_back(-1);
  return all;
}

Partition partition_large_islands(const BodyGraph& graph, const Partitioner& partitioner, int max_bodies) {
  const SmallIslands islands(graph, max_bodies);
  return islands.with_small(partitioner.run(islands.large()));
}

}  // namespace cleave

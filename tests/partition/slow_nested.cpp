#include "tests/partition/slow_nested.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/partition/slow_leftovers.h"

namespace cleave::partition_test {
namespace {

// What a set looks like from outside: its bodies, and its children in order where it was split.
struct Set {
  std::vector<int> bodies;
  std::vector<Set> children;
};

Bodies among(const Bodies& all, const std::vector<int>& members) {
  Bodies bodies{all.family, {}, {}};
  std::vector<int> index(all.count(), -1);
  for (const int body : members) {
    index[body] = bodies.count();
    bodies.mass_kg.push_back(all.mass_kg[body]);
  }
  // Links with static geometry stay.
  const auto is_in = [&](int body) { return body < 0 || index[body] >= 0; };
  const auto inside = [&](int body) { return body < 0 ? -1 : index[body]; };
  for (const ConstraintLink& link : all.links)
    if (is_in(link.body_a) && is_in(link.body_b))
      bodies.links.push_back({inside(link.body_a), inside(link.body_b), link.rows});
  return bodies;
}

class SlowRecursion {
 public:
  SlowRecursion(const PartitionerTwin& partitioner, const PartitionOptions& grown, const RefinerTwin& refiner,
                const RefineOptions& refined, int arity)
      : partitioner_(partitioner), grown_(grown), refiner_(refiner), refined_(refined), arity_(arity) {}

  Set split(const Bodies& all, const std::vector<int>& members, bool is_leaf) {
    Set set{members, {}};
    if (is_leaf || static_cast<int>(members.size()) <= grown_.max_bodies) return set;
    const int most_bodies = static_cast<int>(std::ceil(static_cast<double>(members.size()) / arity_));
    const Partition parts = split_once(among(all, members), most_bodies);
    if (parts.part_count == 1) return set;
    for (int part = 0; part < parts.part_count; ++part) {
      std::vector<int> child;
      for (std::size_t k = 0; k < members.size(); ++k)
        if (parts.part_of_body[k] == part) child.push_back(members[k]);
      set.children.push_back(split(all, child, most_bodies <= grown_.max_bodies));
    }
    return set;
  }

  int joined() const { return joined_; }

 private:
  Partition split_once(const Bodies& bodies, int most_bodies) {
    PartitionOptions grown = grown_;
    grown.max_bodies = most_bodies;
    Partition parts = partitioner_.run(bodies.graph(), grown);
    const int most_joined = most_bodies <= grown_.max_bodies
                                ? grown_.max_bodies
                                : static_cast<int>(std::floor(1.2 * most_bodies));
    joined_ += slow_join_leftovers(bodies, {arity_, most_bodies / 2 + most_bodies % 2, most_joined}, parts);
    RefineOptions refined = refined_;
    refined.max_bodies = most_bodies;
    refiner_.run(bodies.graph(), refined, parts);
    return parts;
  }

  const PartitionerTwin& partitioner_;
  const PartitionOptions& grown_;
  const RefinerTwin& refiner_;
  const RefineOptions& refined_;
  int arity_, joined_ = 0;
};

int count_inner(const Set& set) {
  int count = set.children.empty() ? 0 : 1;
  for (const Set& child : set.children) count += count_inner(child);
  return count;
}

int count_leaves(const Set& set) {
  int count = set.children.empty() ? 1 : 0;
  for (const Set& child : set.children) count += count_leaves(child);
  return count;
}

// next_leaf: ids of leaves from the first; next_inner: of inner nodes from the last.
int number(const Set& set, int parent, int& next_leaf, int& next_inner, Partition& nested) {
  const int node = set.children.empty() ? next_leaf++ : next_inner--;
  nested.parent_of_part[node] = parent;
  if (set.children.empty())
    for (const int body : set.bodies) nested.part_of_body[body] = node;
  for (const Set& child : set.children) number(child, node, next_leaf, next_inner, nested);
  return node;
}

}  // namespace

SlowNested slow_nested(const Bodies& bodies, const PartitionerTwin& partitioner,
                       const PartitionOptions& grown, const RefinerTwin& refiner,
                       const RefineOptions& refined, int arity) {
  SlowNested slow;
  if (bodies.count() == 0) return slow;
  std::vector<int> all(bodies.count());
  std::iota(all.begin(), all.end(), 0);
  SlowRecursion recursion(partitioner, grown, refiner, refined, arity);
  const Set root = recursion.split(bodies, all, false);
  slow.joined = recursion.joined();
  slow.nested = {std::vector<int>(bodies.count(), -1), count_leaves(root)};
  slow.nested.parent_of_part.resize(count_leaves(root) + count_inner(root));
  int next_leaf = 0, next_inner = static_cast<int>(slow.nested.parent_of_part.size()) - 1;
  number(root, -1, next_leaf, next_inner, slow.nested);
  return slow;
}

}  // namespace cleave::partition_test

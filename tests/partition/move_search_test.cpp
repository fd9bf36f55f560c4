// The search for single moves keeps gains up to date move by move: what it finds is what all moves counted
// anew would give, and a gain that has gone wrong is noticed.
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "partition/move_search.h"
#include "tests/partition/brute_force.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

// By the raw links: every allowed move, the best as the search orders them.
std::optional<Exchange> best_by_counting(const Bodies& bodies, const Partition& partition, EdgeWeight unit,
                                         int most_bodies, const std::vector<char>& is_locked) {
  const WeightMatrix weights = link_weights(bodies, unit);
  const std::vector<int> sizes = part_sizes(partition);
  std::optional<Exchange> best;
  for (int body = 0; body < bodies.count(); ++body) {
    const int own = partition.part_of_body[body];
    if (is_locked[body] || sizes[own] == 1) continue;
    std::vector<long> into(partition.part_count, 0);
    std::vector<char> is_adjacent(partition.part_count, 0);
    for (int other = 0; other < bodies.count(); ++other) {
      if (weights[body][other] == 0) continue;
      into[partition.part_of_body[other]] += weights[body][other];
      is_adjacent[partition.part_of_body[other]] = 1;
    }
    for (int part = 0; part < partition.part_count; ++part) {
      if (part == own || !is_adjacent[part] || sizes[part] >= most_bodies) continue;
      const Exchange move{static_cast<int>(into[part] - into[own]), body, part, 0};
      if (!best || *best < move) best = move;
    }
  }
  return best;
}

std::string told(const std::optional<Exchange>& move) {
  if (!move) return "none";
  return "body " + std::to_string(move->first) + " to " + std::to_string(move->second) + ", gain " +
         std::to_string(move->gain);
}

// "" where every move that the search finds is the best and changes the cut by its gain; else the first that
// is not. Bodies that have moved are locked, as in a pass. disturb: a body that is moved behind the back of
// the search after the first move, -1 for none.
std::string search_fault(const Bodies& bodies, Partition partition, EdgeWeight unit, int most_bodies,
                         int disturb = -1) {
  const BodyGraph graph = bodies.graph();
  MoveSearch search(graph, unit, most_bodies, MoveKind::all, partition);
  std::vector<char> is_locked(bodies.count(), 0);
  for (int moves = 0; moves < bodies.count(); ++moves) {
    if (moves == 1 && disturb >= 0)
      partition.part_of_body[disturb] = (partition.part_of_body[disturb] + 1) % partition.part_count;
    const std::optional<Exchange> found = search.find(),
                                  best = best_by_counting(bodies, partition, unit, most_bodies, is_locked);
    if (told(found) != told(best)) return "found " + told(found) + ", counted " + told(best);
    if (!found) break;
    const long before = counted_cut(bodies, partition.part_of_body, unit);
    search.lock(found->first);
    is_locked[found->first] = 1;
    search.make(*found);
    const long fall = before - counted_cut(bodies, partition.part_of_body, unit);
    if (fall != found->gain) return told(found) + " lowers the cut by " + std::to_string(fall);
  }
  return "";
}

constexpr std::uint64_t kSeeds = 150;

TEST(MoveSearch, finds_what_counting_anew_finds_after_every_move) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Bodies bodies = random_bodies(seed);
    Random random(seed + 500);
    const Partition start = random_partition(random, bodies.count());
    const EdgeWeight unit =
        random.pick<EdgeWeight>({EdgeWeight::pairs, EdgeWeight::constraints, EdgeWeight::rows});
    const int most_bodies = random.integer(1, bodies.count() + 1);
    ASSERT_EQ(search_fault(bodies, start, unit, most_bodies), "")
        << "seed " << seed << ": " << describe(bodies);
  }
}

// Gains are not worked out anew from the partition: one that was changed unseen must be told by the check.
TEST(MoveSearch, the_check_sees_a_gain_that_has_gone_wrong) {
  Random random(1);
  const Bodies bodies = pile(random, 4, 4, 3);
  const Partition start = random_partition(random, bodies.count());
  int seen = 0;
  for (int body = 0; body < bodies.count(); ++body)
    seen += !search_fault(bodies, start, EdgeWeight::rows, bodies.count(), body).empty();
  EXPECT_GT(seen, bodies.count() / 2);
}

}  // namespace
}  // namespace cleave::partition_test

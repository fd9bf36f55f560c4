// The checks of this folder must be able to fail: each is shown an answer that is wrong in one way.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/partition/brute_force.h"
#include "tests/partition/test_graphs.h"

namespace cleave::partition_test {
namespace {

// A row of three bodies and one alone.
Bodies three_and_one() { return {"three and one", {1, 1, 1, 1}, {{0, 1, 3}, {1, 2, 3}}}; }

TEST(Checks, tell_what_is_wrong_with_a_partition) {
  const Bodies bodies = three_and_one();
  EXPECT_EQ(grown_fault(bodies, {{0, 0, 0, 1}, 2}, 3), "");
  EXPECT_NE(grown_fault(bodies, {{0, 0, 0, 1}, 2}, 2), "");   // too large
  EXPECT_NE(grown_fault(bodies, {{0, 1, 0, 2}, 3}, 3), "");   // 0 and 2 do not touch
  EXPECT_NE(grown_fault(bodies, {{0, 0, 0, 2}, 3}, 3), "");   // part 1 is empty
  EXPECT_NE(grown_fault(bodies, {{0, 0, 0, 2}, 2}, 3), "");   // id out of range
  EXPECT_NE(grown_fault(bodies, {{0, 0, 0, -1}, 1}, 3), "");  // in no part
  EXPECT_NE(grown_fault(bodies, {{0, 0, 0}, 1}, 3), "");      // a body is missing
}

TEST(Checks, tell_what_is_wrong_with_a_refinement) {
  const Bodies bodies = three_and_one();
  const RefineOptions options{.max_bodies = 2, .max_growth = 0};
  const Partition before{{0, 1, 1, 2}, 3};
  const RefineSummary unchanged{0, 3, 3};
  EXPECT_EQ(refined_fault(bodies, before, before, options, unchanged), "");
  EXPECT_NE(refined_fault(bodies, before, before, options, {0, 4, 3}), "");
  EXPECT_NE(refined_fault(bodies, before, before, options, {0, 3, 2}), "");
  EXPECT_NE(refined_fault(bodies, before, before, options, {-1, 3, 3}), "");
  EXPECT_NE(refined_fault(bodies, before, {{0, 1, 1, 1}, 2}, options, unchanged), "");  // a part is gone
  EXPECT_NE(refined_fault(bodies, before, {{0, 0, 0, 2}, 3}, options, {2, 3, 0}), "");  // emptied
  EXPECT_NE(refined_fault(bodies, {{0, 1, 2, 2}, 3}, {{2, 1, 2, 2}, 3}, options, unchanged), "");
  EXPECT_NE(refined_fault(bodies, {{0, 0, 1, 2}, 3}, {{0, 2, 1, 2}, 3}, options, {1, 3, 6}),
            "");  // the cut rises
  const Partition two_parts{{0, 0, 1, 1}, 2};
  const Partition grown{{0, 0, 0, 1}, 2};
  EXPECT_NE(refined_fault(bodies, two_parts, grown, options, {1, 3, 0}), "");  // three bodies, two allowed
  EXPECT_EQ(refined_fault(bodies, two_parts, grown, {.max_bodies = 2, .max_growth = 0.5}, {1, 3, 0}), "");
}

// Answers given whatever the question, to see that the public calls check what they return.
class FixedPartitioner : public Partitioner {
 public:
  explicit FixedPartitioner(Partition answer) : answer_(std::move(answer)) {}

 private:
  Partition do_run(const BodyGraph&) const override { return answer_; }
  Partition answer_;
};

class FixedRefiner : public Refiner {
 public:
  FixedRefiner(Partition answer, RefineSummary summary)
      : Refiner(EdgeWeight::rows), answer_(std::move(answer)), summary_(summary) {}

 private:
  void do_run(const BodyGraph&, int, Partition& partition, RefineSummary& summary) const override {
    partition = answer_;
    summary = summary_;
  }
  Partition answer_;
  RefineSummary summary_;
};

Partition run_promised(const Partition& answer, const PartsPromise& promise, int max_bodies) {
  FixedPartitioner partitioner(answer);
  partitioner.promise(promise, max_bodies);
  return partitioner.run(three_and_one().graph());
}

TEST(PartitionerDeathTest, run_asserts_how_far_parts_may_grow) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  FixedPartitioner partitioner({{0, 0, 0, 1}, 2});
  partitioner.promise({.at_most_grown_bodies = true}, 2, 3);
  EXPECT_EQ(partitioner.run(three_and_one().graph()).part_count, 2);
  partitioner.promise({.at_most_grown_bodies = true}, 2, 2);
  EXPECT_DEATH(partitioner.run(three_and_one().graph()), "");
}

constexpr PartsPromise kAll{.contiguous = true, .at_most_max_bodies = true, .grown_in_order = true};

TEST(PartitionerDeathTest, run_asserts_its_postconditions) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const Partition good{{0, 0, 0, 1}, 2};
  EXPECT_EQ(first_difference(good, run_promised(good, kAll, 3)), "");
  for (const Partition& bad :
       {Partition{{0, 0, 0, 2}, 3}, {{0, 0, 0, 2}, 2}, {{0, 0, 0, -1}, 1}, {{0, 0, 0}, 1}})
    EXPECT_DEATH(run_promised(bad, {}, 3), "");  // whatever is promised
}

// What was not promised may be.
TEST(PartitionerDeathTest, run_asserts_what_was_promised_and_no_more) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const Partition large{{0, 0, 0, 1}, 2}, scattered{{0, 1, 0, 2}, 3}, closed_early{{0, 1, 1, 2}, 3};
  EXPECT_EQ(run_promised(large, {.contiguous = true}, 2).part_count, 2);
  EXPECT_DEATH(run_promised(large, {.at_most_max_bodies = true}, 2), "");
  EXPECT_EQ(run_promised(scattered, {.at_most_max_bodies = true}, 3).part_count, 3);
  EXPECT_DEATH(run_promised(scattered, {.contiguous = true}, 3), "");
  EXPECT_EQ(run_promised(closed_early, {.contiguous = true, .at_most_max_bodies = true}, 3).part_count, 3);
  EXPECT_DEATH(run_promised(closed_early, kAll, 3), "");
}

TEST(RefinerDeathTest, run_asserts_its_postconditions) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const BodyGraph graph = three_and_one().graph();
  const Partition before{{0, 1, 1, 2}, 3};
  const auto run = [&](const Partition& answer, const RefineSummary& summary) {
    Partition partition = before;
    FixedRefiner(answer, summary).run(graph, 25, partition);
  };
  run(before, {0, 3, 3});
  EXPECT_DEATH(run(before, {0, 3, 2}), "");             // cut_after is not the cut
  EXPECT_DEATH(run({{0, 0, 0, 2}, 3}, {2, 3, 0}), "");  // part 1 is empty
}

}  // namespace
}  // namespace cleave::partition_test

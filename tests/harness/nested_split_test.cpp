// The bodies of a step split by recursion: what the harness hands over, times and keeps of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <numeric>
#include <stdexcept>

#include "harness/experiment/algorithms.h"
#include "harness/experiment/small_islands.h"
#include "harness/experiment/splitter.h"
#include "solver/parts.h"
#include "tests/harness/problem_file_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

// Chains of bodies, one after the other: the sample's single chain without the joints between two of them.
StepProblem chains(const std::vector<int>& lengths) {
  StepProblem problem = sample_problem(std::accumulate(lengths.begin(), lengths.end(), 0), 3);
  int end = 0;
  for (const int length : lengths) {
    end += length;
    const int joint = end - 1;  // its row joins it to the next body
    if (end < problem.body_count()) problem.row_body[2 * joint + 1] = -1;
  }
  return problem;
}

// A chain whose bodies also touch the sixth after them, where there is one.
StepProblem braid(int bodies) {
  StepProblem problem = sample_problem(bodies, 3);
  for (int row = 0; row < problem.row_count(); ++row) {
    int& other = problem.row_body[2 * row + 1];
    if (other < 0 && problem.row_body[2 * row] + 6 < bodies) other = problem.row_body[2 * row] + 6;
  }
  return problem;
}

SplitSetup setup(const std::string& partitioner, const std::string& refiner, int arity,
                 bool skip_small_islands = false) {
  return {read_named("partitioner", partitioner), read_named("refiner", refiner), skip_small_islands, arity};
}

std::string tree_error(const Split& split) {
  return PartsCheck().find_error({split.parts.part_of_body, split.parts.parent_of_part},
                                 split.graph.body_count());
}

TEST(NestedSplit, HandsOverATreeForEveryPair) {
  const StepProblem problem = chains({40, 7, 1, 30});
  for (const Algorithm& partitioner :
       read_list("partitioner", "paper,multilevel,karger@trials=3,random", {{"max-bodies", "4"}}))
    for (const Algorithm& refiner : read_list("refiner", "all", {})) {
      SCOPED_TRACE(partitioner.text + "+" + refiner.text);
      const Split split = Splitter({partitioner, refiner, false, 3}).run(problem);
      EXPECT_EQ(tree_error(split), "");
      const PartitionMetrics metrics = measure_partition(split.graph, split.parts.part_of_body);
      EXPECT_EQ(metrics.parts, split.parts.part_count);
      EXPECT_GE(metrics.parts, 78 / 4);
      EXPECT_GT(split.parts.parent_of_part.size(), split.parts.part_of_body.size() / 4);
      EXPECT_GT(split.partition_ms, 0);
      EXPECT_GE(split.refine_ms, 0);
      EXPECT_EQ(measure_partition(split.graph, split.before.part_of_body).parts, split.before.part_count);
    }
}

// What stands in the columns of the grown parts is the recursion without its refiner.
TEST(NestedSplit, BeforeIsWhatNoRefinerTouched) {
  const StepProblem problem = braid(90);
  const Split refined = Splitter(setup("maxdp@max-bodies=5", "fm", 2)).run(problem);
  const Split plain = Splitter(setup("maxdp@max-bodies=5", "none", 2)).run(problem);
  EXPECT_EQ(refined.before.part_of_body, plain.parts.part_of_body);
  EXPECT_EQ(plain.before.part_of_body, plain.parts.part_of_body);
  EXPECT_NE(refined.before.part_of_body, refined.parts.part_of_body);
}

TEST(NestedSplit, OneLevelHasNoTree) {
  const StepProblem problem = chains({40});
  const SplitSetup flat{read_named("partitioner", "mix@max-bodies=5"), read_named("refiner", "fm")};
  EXPECT_TRUE(Splitter(flat).run(problem).parts.parent_of_part.empty());
  EXPECT_EQ(Splitter(setup("mix@max-bodies=40", "fm", 2)).run(problem).parts.parent_of_part,
            std::vector<int>{-1});
}

TEST(NestedSplit, SmallIslandsHangFromTheRoot) {
  const StepProblem problem = chains({3, 40, 1, 2});
  for (const Algorithm& partitioner : read_list("partitioner", "paper", {{"max-bodies", "5"}})) {
    SCOPED_TRACE(partitioner.text);
    const Split split = Splitter({partitioner, read_named("refiner", "fm"), true, 2}).run(problem);
    EXPECT_EQ(tree_error(split), "");
    const std::vector<int>& part = split.parts.part_of_body;
    const int root = static_cast<int>(split.parts.parent_of_part.size()) - 1,
              last = split.parts.part_count - 1;
    for (const auto& [body, leaf] : {std::pair{0, last - 2}, {2, last - 2}, {43, last - 1}, {45, last}}) {
      EXPECT_EQ(part[body], leaf) << "body " << body;
      EXPECT_EQ(split.parts.parent_of_part[leaf], root);
    }
    const Split alone = Splitter({partitioner, read_named("refiner", "fm"), false, 2}).run(chains({40}));
    EXPECT_TRUE(std::equal(part.begin() + 3, part.begin() + 43, alone.parts.part_of_body.begin()));
    EXPECT_EQ(alone.parts.parent_of_part.size() + 3, split.parts.parent_of_part.size());
  }
}

TEST(NestedSplit, SmallIslandsAloneAreAllOfTheTree) {
  const auto parents = [](const std::vector<int>& lengths) {
    return Splitter(setup("mix@max-bodies=5", "fm", 2, true)).run(chains(lengths)).parts.parent_of_part;
  };
  using Parents = std::vector<int>;
  EXPECT_EQ(parents({}), Parents());
  EXPECT_EQ(parents({5}), Parents{-1});
  EXPECT_EQ(parents({1, 5, 2}), (Parents{3, 3, 3, -1}));
}

// Parts without a size of their own are as they are: one level, which needs no tree.
TEST(NestedSplit, PartsWithoutMaxBodiesAreOneLevel) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "parts") << "0\n1\n1\n";
  for (const std::string& partitioner :
       {"file@path=" + (directory / "parts").string(), std::string("single")}) {
    const Split nested = Splitter(setup(partitioner, "none", 2)).run(chains({3}));
    const Split once =
        Splitter({read_named("partitioner", partitioner), read_named("refiner", "none")}).run(chains({3}));
    EXPECT_EQ(nested.parts.part_of_body, once.parts.part_of_body) << partitioner;
    EXPECT_TRUE(nested.parts.parent_of_part.empty()) << partitioner;
  }
}

// The groups of a scene are the children of the root; a group is not split again, or into runs of its own.
TEST(NestedSplit, GroupsAreTheFirstLevelOfATree) {
  const StepProblem problem = chains({12});
  std::vector<int> group(12, 0);
  std::fill(group.begin() + 4, group.end(), 1);
  const auto split = [&](const std::string& partitioner, bool skips) {
    return Splitter(setup(partitioner, "none", 2, skips)).run(problem, std::nullopt, {{}, group});
  };
  const Split whole = split("semantic@max-bodies=3", false);
  EXPECT_EQ(whole.parts.part_of_body, group);
  EXPECT_EQ(whole.parts.parent_of_part, (std::vector<int>{2, 2, -1}));
  // A small group is no leftover that another would take in.
  std::vector<int> three = group;
  three[4] = 2;
  const Split small =
      Splitter(setup("semantic@max-bodies=3", "none", 2)).run(problem, std::nullopt, {{}, three});
  EXPECT_EQ(small.parts.part_of_body, (std::vector<int>{0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2, 2}));
  EXPECT_EQ(small.parts.parent_of_part, (std::vector<int>{3, 3, 3, -1}));
  const Split runs = split("semantic@max-bodies=4@split=chunks", false);
  EXPECT_EQ(runs.parts.part_of_body, (std::vector<int>{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2}));
  EXPECT_EQ(tree_error(runs), "");
  // One group alone is one leaf, beside which small islands hang from a root of their own.
  std::ranges::fill(group, 0);
  EXPECT_EQ(split("semantic@max-bodies=3", false).parts.parent_of_part, std::vector<int>{-1});
  const Split beside = Splitter(setup("semantic@max-bodies=3", "none", 2, true))
                           .run(chains({9, 3}), std::nullopt, {{}, group});
  EXPECT_EQ(beside.parts.parent_of_part, (std::vector<int>{2, 2, -1}));
  EXPECT_EQ(beside.parts.part_of_body, (std::vector<int>{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1}));
}

TEST(NestedSplit, ArityIsAParameterOfTheSolver) {
  const std::map<std::string, std::string> values = {{"arity", "3"}};
  const Algorithm solver{"some", "some", Settings(values)};
  EXPECT_EQ(arity_of(solver), 3);
  EXPECT_EQ(arity_of(read_named("solver", "schur")), std::nullopt);
}

}  // namespace
}  // namespace cleave

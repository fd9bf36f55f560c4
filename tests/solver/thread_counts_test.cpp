// Every name of the registry: the same bytes on any number of threads, or on each of them the same refusal.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "solver/registry.h"
#include "solver/step_solver.h"
#include "tests/solver/cone_contacts.h"
#include "tests/solver/part_trees.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"
#include "tests/solver/task_shapes.h"

namespace cleave {
namespace {

// Soft, where direct solvers come to their end in few factorisations. What the oracle and a dense interface
// take grows with the cube of their size.
constexpr PileOptions kLarge{.columns = 5, .rows = 5, .layers = 4, .cfm = 1e-3};
constexpr PileOptions kOfFewCutRows{.columns = 4, .rows = 4, .layers = 3, .cfm = 1e-3};
constexpr PileOptions kSmall{.columns = 2, .rows = 2, .layers = 2, .cfm = 1e-3};
// With more rows than are one task.
constexpr PileOptions kStiff{.columns = 3, .rows = 3, .layers = 3, .cfm = 1e-10};
constexpr PileOptions kSmallStiff{.columns = 2, .rows = 2, .layers = 2, .cfm = 1e-10};

// A part a layer, under a tree.
PartTree layers_of(const PileOptions& options) {
  return sliced_tree(options.columns * options.rows * options.layers, options.layers);
}

// Iterations that are enough to tell bytes apart, where a solver that may miss would take many.
std::string with_an_end(const std::string& name) {
  const auto has = [&](const std::string& parameter) {
    return std::ranges::count(solver_parameters(name), parameter, &Parameter::name) > 0;
  };
  if (has("sweeps")) return name + "@sweeps=20";
  return may_miss(name) && has("max-iterations") ? name + "@max-iterations=4" : name;
}

struct Outcome {
  SolveSummary summary;
  Solution solution;
};

Outcome run_on(int threads, const std::string& name, const StepProblem& problem, const Parts& parts) {
  Outcome outcome{{}, cold_start(problem)};
  outcome.summary =
      make_step_solver(with_an_end(name), {.threads = threads})->solve(problem, parts, outcome.solution);
  return outcome;
}

// Returns what one thread gives.
Outcome expect_same_bytes(const std::string& name, const StepProblem& problem, const Parts& parts) {
  const Outcome one = run_on(1, name, problem, parts);
  for (const int threads : {2, 3, 7}) {
    SCOPED_TRACE(std::to_string(threads) + " threads");
    const Outcome many = run_on(threads, name, problem, parts);
    EXPECT_EQ(many.summary.status, one.summary.status);
    EXPECT_EQ(many.summary.message, one.summary.message);
    EXPECT_EQ(many.summary.iterations, one.summary.iterations);
    EXPECT_EQ(many.summary.factorizations, one.summary.factorizations);
    EXPECT_TRUE(same_bytes(many.solution.impulse, one.solution.impulse));
    EXPECT_TRUE(same_bytes(many.solution.velocity, one.solution.velocity));
  }
  return one;
}

class ThreadCountsTest : public testing::TestWithParam<std::string> {
 protected:
  static bool is_dense() { return kernel_of(GetParam()) == "dense"; }
  static bool is_lemke() { return GetParam() == "lemke"; }
  static PileOptions large() {
    if (is_dense()) return kSmall;
    return kernel_of(GetParam()) == "schur-rows" ? kOfFewCutRows : kLarge;
  }

  // Those that may miss say so, or why they refuse.
  static SolveStatus expect_same_answer(const PileOptions& options) {
    const StepProblem problem = make_pile(3, options);
    const Outcome one = expect_same_bytes(GetParam(), problem, layers_of(options).parts());
    EXPECT_TRUE(may_miss(GetParam()) ? is_honest(problem, one.summary, one.solution)
                                     : is_exact(problem, one.summary, one.solution));
    return one.summary.status;
  }
};

TEST_P(ThreadCountsTest, GiveTheSameBytesOnALargePile) {
  const SolveStatus status = expect_same_answer(large());
  EXPECT_EQ(status == SolveStatus::refused, is_lemke());
}

TEST_P(ThreadCountsTest, GiveTheSameBytesOnAStiffPile) {
  const SolveStatus status = expect_same_answer(is_dense() || is_lemke() ? kSmallStiff : kStiff);
  EXPECT_NE(status, SolveStatus::refused);
}

INSTANTIATE_TEST_SUITE_P(Registry, ThreadCountsTest, testing::ValuesIn(all_solver_names()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::ranges::replace_if(
                               name, [](char c) { return c == '-' || c == ':'; }, '_');
                           return name;
                         });

// Most solvers take no cones.
TEST(ThreadCountsOfConesTest, AreAllRefusedOrNone) {
  const StepProblem problem = with_sets(make_pile(3, kSmall), ContactSet::cone);
  const PartTree tree = layers_of(kSmall);
  int refused = 0, solved = 0;
  for (const std::string& name : all_solver_names()) {
    SCOPED_TRACE(name);
    const Outcome one = expect_same_bytes(name, problem, tree.parts());
    if (one.summary.status == SolveStatus::refused) {
      ++refused;
    } else {
      EXPECT_TRUE(is_exact(problem, one.summary, one.solution));
      ++solved;
    }
  }
  EXPECT_GE(refused, 20);
  EXPECT_GE(solved, 10);
}

// What the tests above are about: sweeps over several slabs, and factorisations with a front in tiles, be it
// of the whole system, of parts side by side or of parts in a tree.
TEST(LargePileTest, HasSlabsAndFrontsInTiles) {
  const StepProblem large = make_pile(3, kLarge);
  const PartTree tree = layers_of(kLarge);
  EXPECT_GE(count_slabs(large), 3);
  EXPECT_TRUE(has_tiled_front(large, single_part(large.body_count())));
  EXPECT_TRUE(has_tiled_front(large, tree.part_of_body));
  EXPECT_TRUE(has_tiled_front(large, tree.parts()));
  EXPECT_GE(count_slabs(make_pile(3, kOfFewCutRows)), 2);
}

}  // namespace
}  // namespace cleave

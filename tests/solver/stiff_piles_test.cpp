// The interior point where stiffness, redundant contact and mass ratios meet: every answer exact, and the
// number of factorisations bounded.
#include <gtest/gtest.h>

#include <string>

#include "solver/registry.h"
#include "tests/solver/problem_makers.h"
#include "tests/solver/solver_checks.h"

namespace cleave {
namespace {

struct StiffPile {
  double mass_ratio;
  int most_factorizations;
};

class StiffPilesTest : public testing::TestWithParam<StiffPile> {};

TEST_P(StiffPilesTest, AreSolvedAtEveryCompliance) {
  for (const double cfm : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 0.0}) {
    for (int seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE("cfm " + std::to_string(cfm) + " seed " + std::to_string(seed));
      const StepProblem pile = make_pile(
          seed, {.columns = 3, .rows = 3, .layers = 5, .cfm = cfm, .mass_ratio = GetParam().mass_ratio});
      const auto solver = make_step_solver("interior-point:monolithic", {});
      Solution solution = cold_start(pile);
      const SolveSummary summary = solver->solve(pile, single_part(pile.body_count()), solution);
      EXPECT_TRUE(is_exact(pile, summary, solution));
      EXPECT_LE(summary.factorizations, GetParam().most_factorizations);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(MassRatios, StiffPilesTest,
                         testing::Values(StiffPile{1, 40}, StiffPile{1e3, 40}, StiffPile{1e6, 70}),
                         [](const auto& info) {
                           return "ratio_" + std::to_string(static_cast<int>(info.param.mass_ratio));
                         });

}  // namespace
}  // namespace cleave

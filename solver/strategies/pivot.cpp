// Strategy `pivot`: block principal pivoting, started from a few projected Gauss-Seidel sweeps.
//
// Each iteration solves the rows that are free and flips all rows that violate their condition at once; while
// the number of violations does not fall for several iterations it flips a single one (Murty's rule, the
// violated row of highest index). Source: Judice and Pires, "A block principal pivoting algorithm for
// large-scale strictly monotone linear complementarity problems", Computers & Operations Research 21, 1994;
// Murty 1974. Block pivoting may cycle and single pivots may take very long, so it gives up, to be followed
// by another strategy, when the count has stopped falling.
#include <limits>

#include "solver/gauss_seidel.h"
#include "solver/strategies/strategy.h"

namespace cleave {
namespace {

constexpr int kBlockPatience = 3;  // block flips without a new least count of violations, before single ones
constexpr int kSinglePatience = 10;  // single flips without one, before giving up

class Pivot : public Strategy {
 public:
  bool run(SolveState& state) override {
    {
      StageTimer timer(state.tasks.clock(), Stage::predict);
      gauss_seidel_sweeps(*state.step, state.options.sweeps, state.impulse, state.velocity);
      state.states_from_impulses();
    }
    int least = std::numeric_limits<int>::max(), patience = kBlockPatience, single = 0;
    const double tolerance = 0.1 * state.options.target_m_per_s * state.step->velocity_scale();
    while (state.summary->iterations < state.options.max_iterations) {
      ++state.summary->iterations;
      if (!state.factor_free()) return false;
      state.refine_free(tolerance, 3, false);
      const int count = state.find_violations(tolerance);
      if (count == 0) return finish(state, tolerance);
      if (count < least) {
        least = count;
        patience = kBlockPatience;
        single = 0;
      } else if (--patience < 0 && ++single > kSinglePatience) {
        return false;
      }
      if (patience >= 0) {
        for (int row : state.violated) state.flip(row);
      } else {
        state.flip(state.violated.back());
      }
    }
    return false;
  }

 private:
  static bool finish(SolveState& state, double tolerance) {
    StageTimer timer(state.tasks.clock(), Stage::refine);
    state.refine_free(0.1 * tolerance, 2, true);
    return state.residual() <= exact_limit_m_per_s(*state.step);
  }
};

}  // namespace

std::unique_ptr<Strategy> make_pivot() { return std::make_unique<Pivot>(); }

}  // namespace cleave

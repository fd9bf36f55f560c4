// Strategy `pivot`: block principal pivoting, started from projected Gauss-Seidel sweeps.
//
// Each iteration solves the rows that are free and flips all rows that violate their condition at once. When
// the number of violations does not fall, it restarts from a few sweeps at the clamped impulses; when that
// does not help either, it flips single rows (Murty's rule, the violated row of highest index). Source:
// Judice and Pires, "A block principal pivoting algorithm for large-scale strictly monotone linear
// complementarity problems", Computers & Operations Research 21, 1994; Murty 1974. Block pivoting may cycle
// and single pivots may take very long, so it gives up, to be followed by another strategy, when the count
// has stopped falling.
#include <algorithm>
#include <limits>
#include <utility>

#include "solver/slab_sweeps.h"
#include "solver/strategies/strategy.h"

namespace cleave {
namespace {

constexpr int kRestartSweeps = 30;
// Enough sweeps to start from, options.predictor_sweeps at most, where five of them
// (SlabSweeps::kSweepsOfALook) move no more than this share of the rows to or from a bound. Five cost about a
// tenth of a factorisation with what goes with it. Twelve recorded steps of a pile of 200 boxes (cfm 1e-5)
// take 84 factorisations from a cold start after 10 sweeps each, 41 after 40, 33 after 60 and after 80.
constexpr double kSettledShare = 0.003;
// An iteration makes progress when it leaves less than this share of the least number of violations so far.
constexpr double kProgress = 0.75;
// Without progress, before giving up: restarts from sweeps, then single flips where a handful of violations
// are left. On a tower that slides apart (500 steps, cfm 1e-5) 21 steps were given up after two restarts of
// 15 sweeps and one flip, 5 after these, which save a tenth of the time of all steps. Where rows are stiffer
// many violations are left, and more attempts bring nothing.
constexpr int kRestarts = 2, kRestartsOfFew = 3, kSingleFlips = 6;
constexpr int kFewViolations = 12;

int settled_rows(std::size_t rows) { return static_cast<int>(kSettledShare * static_cast<double>(rows)); }

int count_changes(const std::vector<RowState>& before, const std::vector<RowState>& after) {
  int changed = 0;
  for (std::size_t r = 0; r < before.size(); ++r) changed += before[r] != after[r];
  return changed;
}

class Pivot : public Strategy {
 public:
  bool run(SolveState& state) override {
    is_bound_ = false;
    take_states(state);
    warm_state_ = state.row_state;
    const double tolerance = state.violation_tolerance();
    if (!starts_settled(state, tolerance)) sweep(state, state.options.predictor_sweeps);
    state.changed_rows = state.step->row_count();
    int least = std::numeric_limits<int>::max(), stalled = 0;
    for (int k = 0; k < state.options.max_iterations; ++k) {
      ++state.summary->iterations;
      if (!state.factor_free()) return false;
      state.refine_free(tolerance, SolveState::kSearchRefinements, SolveState::Refining::search);
      const int count = state.find_violations(tolerance);
      if (count == 0) return finish(state, tolerance);
      const bool few = count <= kFewViolations;
      if (count < kProgress * least) {
        least = count;
        stalled = 0;
        for (int row : state.violated) state.flip(row);
      } else if (++stalled <= (few ? kRestartsOfFew : kRestarts)) {
        clamp(state);
        sweep(state, kRestartSweeps);
      } else if (few && stalled <= kRestartsOfFew + kSingleFlips) {
        state.flip(state.violated.back());
      } else {
        return false;
      }
    }
    return false;
  }

 private:
  // Of impulses within their bounds, as they begin.
  static void take_states(SolveState& state) {
    StageTimer timer(state.tasks.clock(), Stage::predict);
    state.states_from_impulses();
  }

  // Impulses within their bounds, which then tell the states.
  static void clamp(SolveState& state) {
    StageTimer timer(state.tasks.clock(), Stage::predict);
    const StepProblem& problem = state.step->problem();
    const auto move_inside = [&](int first, int last, int) {
      for (int r = first; r < last; ++r)
        state.impulse[r] = std::clamp(state.impulse[r], problem.lower[r], problem.upper[r]);
    };
    state.update_velocity({move_inside, {}});
    state.states_from_impulses();
  }

  // Whether warm states need no sweeps: few rows changed theirs in the step before, or would now.
  static bool starts_settled(SolveState& state, double tolerance) {
    StageTimer timer(state.tasks.clock(), Stage::predict);
    const std::size_t rows = state.impulse.size();
    return (state.options.session && state.last_changed_rows <= settled_rows(rows)) ||
           state.find_violations(tolerance, SolveState::Violated::after_a_step) <= settled_rows(rows);
  }

  void sweep(SolveState& state, int sweeps) {
    if (sweeps == 0) return;
    StageTimer timer(state.tasks.clock(), Stage::predict);
    if (!std::exchange(is_bound_, true)) predictor_.bind(*state.step, state.tasks);
    predictor_.take_in(state.impulse, state.velocity, state.tasks);
    const int settled = settled_rows(state.impulse.size());
    for (int done = 0; done < sweeps; done += SlabSweeps::kMostSweeps) {
      const int most = std::min(SlabSweeps::kMostSweeps, sweeps - done);
      if (predictor_.run(most, settled, state.tasks) <= settled) break;
    }
    predictor_.give_out(state.impulse, state.velocity, state.tasks);
    state.states_from_impulses();
  }

  bool finish(SolveState& state, double tolerance) {
    StageTimer timer(state.tasks.clock(), Stage::refine);
    state.refine_free(0.1 * tolerance, SolveState::kLastRefinements, SolveState::Refining::answer);
    state.changed_rows = count_changes(warm_state_, state.row_state);
    return state.residual() <= state.step->exact_limit_m_per_s();
  }

  SlabSweeps predictor_;
  bool is_bound_ = false;  // the predictor, to the step at hand
  std::vector<RowState> warm_state_;
};

}  // namespace

std::unique_ptr<Strategy> make_pivot(const Settings&) { return std::make_unique<Pivot>(); }

}  // namespace cleave

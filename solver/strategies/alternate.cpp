// Strategy `alternate`: the alternation between subsystems and interface of Peiret et al. 2019 (section 5),
// which the paper's parallel solver rests on. Each round:
//   1. every part solves its own complementarity problem by block pivoting, interface impulses fixed;
//   2. with the active interior rows that found, the interface problem is formed and solved by block
//   pivoting;
//   3. interior rows are checked against the new velocities; when all are consistent the result is exact.
// Nothing makes the rounds converge: on stiff or redundant piles they cycle. The strategy reports that
// honestly (it returns false after max_iterations rounds) and is kept as the reference.
//
// Both pivoting loops are written on the kernel's one system with the other side's rows held: the parts
// decouple when no cut row is free, so one pass over the whole matrix is a pass over every part.
#include <algorithm>
#include <limits>

#include "solver/parts.h"
#include "solver/strategies/strategy.h"

namespace cleave {
namespace {

constexpr int kMostPivots = 50;    // within one round, per side
constexpr int kBlockPatience = 3;  // block flips without a new least count, before single ones

class Alternate : public Strategy {
 public:
  bool run(SolveState& state) override {
    find_groups(state);
    state.states_from_impulses();
    const double tolerance = state.violation_tolerance();
    for (int round = 0; round < state.options.max_iterations; ++round) {
      ++state.summary->iterations;
      if (!pivot(state, Side::interior, tolerance) || !pivot(state, Side::interface, tolerance)) return false;
      // The interface impulses are new: are the interior rows still consistent?
      if (state.find_violations(tolerance) == 0) {
        StageTimer timer(state.tasks.clock(), Stage::refine);
        state.refine_free(0.1 * tolerance, SolveState::kLastRefinements, SolveState::Refining::answer);
        return state.residual() <= state.step->exact_limit_m_per_s();
      }
    }
    return false;
  }

 private:
  // group_[r]: the part of an interior row; the interface counts as one more part.
  void find_groups(const SolveState& state) {
    const StepProblem& problem = state.step->problem();
    group_count_ = count_parts(state.part_of_body) + 1;
    group_.resize(problem.row_count());
    for (int r = 0; r < problem.row_count(); ++r) {
      const int a = problem.row_body[2 * r], b = problem.row_body[2 * r + 1];
      const bool cut = b >= 0 && state.part_of_body[a] != state.part_of_body[b];
      group_[r] = cut ? group_count_ - 1 : state.part_of_body[a];
    }
  }

  enum class Side { interior, interface };

  bool is_cut(int row) const { return group_[row] == group_count_ - 1; }
  Side side_of(int row) const { return is_cut(row) ? Side::interface : Side::interior; }

  // Block pivoting over the interior rows (each part with its own count and patience) with the cut rows'
  // impulses held, or over the cut rows with the interior states held. A part that does not finish keeps its
  // last states.
  bool pivot(SolveState& state, Side side, double tolerance) {
    least_.assign(group_count_, std::numeric_limits<int>::max());
    patience_.assign(group_count_, kBlockPatience);
    for (int k = 0; k < kMostPivots; ++k) {
      if (!solve(state, side)) return false;
      state.find_violations(tolerance);
      count_.assign(group_count_, 0);
      for (int row : state.violated) count_[group_[row]] += side_of(row) == side;
      bool any = false;
      for (int g = 0; g < group_count_; ++g) {
        if (count_[g] == 0) continue;
        any = true;
        if (count_[g] < least_[g]) {
          least_[g] = count_[g];
          patience_[g] = kBlockPatience;
        } else {
          --patience_[g];
        }
      }
      if (!any) return true;
      for (std::size_t v = 0; v < state.violated.size(); ++v) {
        const int row = state.violated[v], g = group_[row];
        if (side_of(row) != side) continue;
        // After block flips have failed, only the last violated row of the group is flipped (Murty).
        if (patience_[g] >= 0 || --count_[g] == 0) state.flip(row);
      }
    }
    return true;
  }

  // Solves the free rows of one side. Interior pass: free cut rows keep their impulse. Interface pass: the
  // interior rows stay in the system with their states held, which is what the effective mass at the
  // interface means.
  bool solve(SolveState& state, Side side) {
    for (std::size_t r = 0; r < group_.size() && side == Side::interior; ++r) {
      if (is_cut(static_cast<int>(r)) && state.row_state[r] == RowState::free)
        state.row_state[r] = RowState::held;
    }
    const bool factored = state.factor_free();
    // To less than what counts as a violation: the other side starts from it.
    if (factored)
      state.refine_free(0.1 * state.violation_tolerance(), SolveState::kSearchRefinements,
                        SolveState::Refining::search);
    for (RowState& row : state.row_state) {
      if (row == RowState::held) row = RowState::free;
    }
    return factored;
  }

  std::vector<int> group_, least_, patience_, count_;
  int group_count_ = 1;
};

}  // namespace

std::unique_ptr<Strategy> make_alternate(const Settings&) { return std::make_unique<Alternate>(); }

}  // namespace cleave

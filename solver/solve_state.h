// The iterate shared by the strategies of one solve: impulses, velocities, row slacks, the state of every
// row, and the steps that all strategies take on a kernel. Scratch only grows.
//
// Impulses, slacks, weights, right-hand sides and increments of rows are those along the axes of the impulse
// set (impulse_set.h), where bounds are bounds of single numbers. They are the bases of the blocks that
// factor() hands the kernel, whose right-hand sides and increments are along them too. Without turned boxes
// axes and rows are the same.
//
// The rows of a cone (cone.h) have a block of the strategy's own; weights are along its basis, right-hand
// sides and increments in rows, which solve() turns. Where the law is Coulomb's, the strategy sees a cone
// whose normal slack is raised by `shift`, mu |w_t| of an earlier iterate.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "harness/base/larger_or_nan.h"
#include "solver/direct_options.h"
#include "solver/kernels/kernel.h"
#include "solver/prepared_step.h"

namespace cleave {

// Where a row of the active set stands. Rows with lower = upper are always at a bound; a held row keeps its
// impulse.
enum class RowState : std::uint8_t { free, lower, upper, held };

// Rows with less compliance than this, in units of d_r, are factored as if they had it: a larger D = 1 / C
// loses the soft directions to rounding. Residuals are those of C, so that increments correct for it.
inline constexpr double kFactoredCompliance = 3e-13;

// How often and how far SolveState::settle goes.
struct Settling {
  int rounds = 4;       // solves, each after flipping what the last one left violated
  int refinements = 8;  // steps of iterative refinement of each, at most
  // Given up above so many violations and this share of the rows: more never came right.
  int most_violations = 3;
  double violated_share = 0.005;
};

struct SolveState {
  SolveState(const DirectOptions& solve_options, StageClock& clock)
      : options(solve_options),
        tasks(clock, solve_options.threads, solve_options.stop, solve_options.memory_limit_bytes) {}

  // Binds the state to a problem; impulses start from the warm start (along the axes), moved into the set.
  void begin(const PreparedStep& prepared, Kernel& solve_kernel, SolveSummary& solve_summary,
             std::span<const double> warm_impulse);
  // Of that, what is kept by row.
  void begin_rows(std::span<const double> warm_impulse);

  // v = v0 + M^-1 J^T lambda and w = J v + C lambda - b (plus the shift) from the impulses. around: may write
  // the impulses of a chunk, and reads its w.
  void update_velocity(const RowsAround& around = {});

  // The same with the shift of these velocities.
  void update_velocity_and_shift();
  // These impulses (m), with their velocities and shift.
  void load(const std::vector<double>& impulses);

  // The kernel's factorisation for the weights, which `before` may write; counted. False when it finds a
  // non-positive pivot.
  bool factor(const RowWork& before = {});

  // Ends the kernel's analysis, which goes on beside the first work of a strategy. factor() does so itself.
  void finish_analysis() { tasks.finish_background(Stage::analyze); }

  // dv and dlambda from f_v and f_r by the kernel; f_r of cones is left along their bases.
  void solve(const RowsAround& around = {});
  std::span<WeightBlock> cone_blocks() { return std::span(blocks).last(step->set().cones().size()); }

  // Row states read off the impulses: at a bound exactly means bound, everything else free.
  void states_from_impulses();

  // Factors the system of the free rows (D = 1 / C, C at least kFactoredCompliance d_r; 0 on bounded rows);
  // bounded impulses are set to their bound. False when the kernel finds a non-positive pivot.
  bool factor_free();

  // One step of iterative refinement on the free rows with the present factor, in increments:
  //   solve  M dv - J^T dlambda = 0,  J dv + C dlambda = -w  on free rows;  lambda += dlambda
  // after: with the new w of a chunk.
  void correct_free(const RowWork& after = {});

  // The residual aimed at, m/s.
  double target_m_per_s() const { return options.target_m_per_s * step->velocity_scale(); }

  // What a row may be violated by while an active set is looked for, m/s: a tenth of that.
  double violation_tolerance() const { return 0.1 * target_m_per_s(); }

  // Most corrections of an answer of which only the violations are counted, and of one that stays.
  static constexpr int kSearchRefinements = 3, kLastRefinements = 2;

  // correct_free until w on the free rows is below `target` or no longer falls; returns the largest |w| left.
  // What only finds out whether an active set is right does not count as refinements of the answer.
  enum class Refining { answer, search };
  double refine_free(double target, int most_steps, Refining what);

  // Rows whose impulse left its bounds, or would after a step along its own slack, or whose slack has the
  // wrong sign, beyond `tolerance` (m/s); fills `violated` and moves nothing.
  enum class Violated { now, after_a_step };
  int find_violations(double tolerance, Violated when = Violated::now);

  // Solves on the present row states and flips what is violated, while the number of violations falls, a few
  // times. True when none is left.
  bool settle(double tolerance, const Settling& settling = {});

  // Moves one violated row to the state its violation asks for.
  void flip(int row);

  // Light work on rows as a pass of its own, a task for every chunk: task(first, last, chunk). Few rows are
  // one task: to hand out a part of them would take longer than to do it. On five steps of 200 rocks two
  // threads took from 14 % less to 7 % more time with chunks of 384 rows than with one of all rows, 4 % less
  // in the median.
  static constexpr int kFewRows = 1024;
  std::size_t chunk_count() const { return step->group_chunks().size(); }
  template <class Task>
  void run_over_rows(const Task& task);
  // The greatest of the values of all rows, at least 0; infinite where one is no number.
  template <class Value>
  double greatest_over_rows(const Value& value_of);
  // Of the rows first .. last - 1.
  template <class Value>
  static double greatest_of(int first, int last, const Value& value_of);
  // Of these.
  static double greatest_of(std::span<const double> values);
  // Of the values of whole chunks: value_of(first, last, chunk).
  template <class Value>
  double greatest_over_chunks(const Value& value_of);

  // The quantity the judge measures; infinite where it is no number.
  double residual();
  // The same with the shift left in, of the cones that the strategy sees in the place of Coulomb's law.
  double residual_with_shift();
  // The normal slacks of Coulomb's law (cone.h) in the place of those with the shift: taken(k, its mu |w_t|).
  template <class Taken>
  void put_law_into(std::span<double> slacks, const Taken& taken) const;
  double residual_of(std::span<const double> slacks);
  void list_violated();  // from row_is_violated
  // shift <- mu |w_t| of the present velocities, and into the slacks.
  void update_shift();

  DirectOptions options;
  ParallelTasks tasks;
  const PreparedStep* step = nullptr;
  Kernel* kernel = nullptr;
  SolveSummary* summary = nullptr;

  std::vector<double> impulse, velocity, slack;  // (m), (n, 6), (m)
  std::vector<RowState> row_state;               // (m)
  std::vector<double> weight;                    // (m) D of the present factor
  std::vector<WeightBlock> blocks;  // of the present factor: the axes of the set, then one a cone
  std::vector<double> shift;        // (cones) m/s, zero but for Coulomb's law; empty where no cone is
  std::vector<double> f_v, f_r, dv, dlambda;  // right-hand sides and increments
  // In a session: how many rows ended in another state than the warm start told, in the last solve and in
  // this one. The greatest number where the strategy does not say.
  int last_changed_rows = std::numeric_limits<int>::max(), changed_rows = std::numeric_limits<int>::max();
  std::vector<int> violated;        // rows found by find_violations
  std::vector<double> row_impulse;  // (m) scratch: impulses in rows where a box is turned
  std::vector<double> law_slack;    // (m) scratch: slacks with the shift of the present velocities
  // Scratch: of greatest_over_rows and find_violations.
  std::vector<double> chunk_values;
  std::vector<char> row_is_violated;
  std::span<const int> part_of_body;  // (n) of the solve, for strategies that look at the cut
};

template <class Task>
void SolveState::run_over_rows(const Task& task) {
  const auto chunks = step->group_chunks();
  const RowWork work = std::cref(task);
  const auto run_one = [&](const Chunk& chunk) { step->do_rows(work, chunk); };
  if (step->row_count() > kFewRows) return tasks.run_over(chunks, run_one);
  for (const Chunk& chunk : chunks) run_one(chunk);
}

template <class Value>
double SolveState::greatest_over_chunks(const Value& value_of) {
  chunk_values.assign(chunk_count(), 0.0);
  run_over_rows([&](int first, int last, int chunk) { chunk_values[chunk] = value_of(first, last, chunk); });
  return greatest_of(chunk_values);
}

inline double SolveState::greatest_of(std::span<const double> values) {
  double greatest = 0;
  for (const double value : values) greatest = larger_or_infinite(greatest, value);
  return greatest;
}

template <class Value>
double SolveState::greatest_of(int first, int last, const Value& value_of) {
  double greatest = 0;
  for (int r = first; r < last; ++r) greatest = larger_or_infinite(greatest, value_of(r));
  return greatest;
}

template <class Value>
double SolveState::greatest_over_rows(const Value& value_of) {
  return greatest_over_chunks([&](int first, int last, int) { return greatest_of(first, last, value_of); });
}

}  // namespace cleave

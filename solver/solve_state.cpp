#include "solver/solve_state.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "solver/cone.h"

namespace cleave {

void SolveState::begin(const PreparedStep& prepared, Kernel& solve_kernel, SolveSummary& solve_summary,
                       std::span<const double> warm_impulse) {
  step = &prepared;
  kernel = &solve_kernel;
  summary = &solve_summary;
  begin_rows(warm_impulse);
  const std::size_t n6 = 6 * static_cast<std::size_t>(prepared.body_count());
  velocity.resize(n6);
  f_v.assign(n6, 0.0);
  dv.resize(n6);
  blocks.assign(prepared.set().axes().begin(), prepared.set().axes().end());
  for (const FrictionCone& cone : prepared.set().cones())
    blocks.push_back({cone.first_row, cone.row_count, {}});
  shift.assign(prepared.set().cones().size(), 0.0);
  update_velocity();
}

void SolveState::begin_rows(std::span<const double> warm_impulse) {
  for (std::vector<double>* of_rows : {&impulse, &slack, &weight, &f_r, &dlambda})
    of_rows->resize(warm_impulse.size());
  row_state.resize(warm_impulse.size());
  violated.clear();
  run_over_rows([&](int first, int last, int) {
    std::copy(warm_impulse.begin() + first, warm_impulse.begin() + last, impulse.begin() + first);
    step->set().project(first, last, impulse);
    std::fill(row_state.begin() + first, row_state.begin() + last, RowState::free);
    std::fill(weight.begin() + first, weight.begin() + last, 0.0);
    std::fill(f_r.begin() + first, f_r.begin() + last, 0.0);
  });
}

void SolveState::update_velocity(const RowsAround& around) {
  const bool are_impulses_of_rows = step->set().axes().empty();
  if (around.before && !are_impulses_of_rows) run_over_rows(around.before);
  const std::span<const double> in_rows = step->set().in_rows(impulse, row_impulse);
  step->velocity(in_rows, velocity, are_impulses_of_rows ? around.before : RowWork());
  const bool is_slack_of_rows = are_impulses_of_rows && shift.empty();
  step->slack(velocity, in_rows, slack, is_slack_of_rows ? around.after : RowWork());
  if (is_slack_of_rows) return;
  step->set().to_axes(slack);
  for (std::size_t k = 0; k < shift.size(); ++k) slack[step->set().cones()[k].first_row] += shift[k];
  if (around.after) run_over_rows(around.after);
}

template <class Taken>
void SolveState::put_law_into(std::span<double> slacks, const Taken& taken) const {
  for (std::size_t k = 0; k < shift.size(); ++k) {
    const FrictionCone& cone = step->set().cones()[k];
    if (!cone.coulomb) continue;
    slacks[cone.first_row] -= shift[k];
    const Eigen::Vector3d w = load_contact(cone, slacks);
    store_contact(cone, shifted_slack(cone.mu, w), slacks);
    taken(k, slacks[cone.first_row] - w[0]);
  }
}

void SolveState::update_shift() {
  put_law_into(slack, [this](std::size_t k, double of_law) { shift[k] = of_law; });
}

// Without the old shift, whose rounding would stay.
void SolveState::update_velocity_and_shift() {
  std::ranges::fill(shift, 0.0);
  update_velocity();
  update_shift();
}

void SolveState::load(const std::vector<double>& impulses) {
  impulse = impulses;
  update_velocity_and_shift();
}

bool SolveState::factor(const RowWork& before) {
  check_stop(options.stop);
  finish_analysis();
  ++summary->factorizations;
  const bool factored = kernel->factor({weight, blocks}, tasks, before);
  summary->factor_mflop_done += kernel->done_mflop();
  return factored;
}

void SolveState::solve(const RowsAround& around) {
  check_stop(options.stop);
  if (cone_blocks().empty()) return kernel->solve(f_v, f_r, dv, dlambda, tasks, around);
  if (around.before) run_over_rows(around.before);
  to_basis(cone_blocks(), f_r);
  kernel->solve(f_v, f_r, dv, dlambda, tasks);
  from_basis(cone_blocks(), dlambda);
  if (around.after) run_over_rows(around.after);
}

void SolveState::states_from_impulses() {
  const StepProblem& problem = step->problem();
  run_over_rows([&](int first, int last, int) {
    for (int r = first; r < last; ++r) {
      row_state[r] = impulse[r] <= problem.lower[r]   ? RowState::lower
                     : impulse[r] >= problem.upper[r] ? RowState::upper
                                                      : RowState::free;
    }
  });
}

bool SolveState::factor_free() {
  const StepProblem& problem = step->problem();
  const auto take_states = [&](int first, int last, int) {
    for (int r = first; r < last; ++r) {
      const double compliance = std::max(problem.compliance[r], kFactoredCompliance * step->diagonal()[r]);
      weight[r] = row_state[r] == RowState::free ? 1 / compliance : 0.0;
      if (row_state[r] == RowState::lower) impulse[r] = problem.lower[r];
      if (row_state[r] == RowState::upper) impulse[r] = problem.upper[r];
    }
  };
  update_velocity({std::ref(take_states), {}});
  return factor();
}

void SolveState::correct_free(const RowWork& after) {
  std::fill(f_v.begin(), f_v.end(), 0.0);
  const auto turn_slack = [this](int first, int last, int) {
    for (int r = first; r < last; ++r) f_r[r] = -slack[r];
  };
  const auto add_increment = [this](int first, int last, int) {
    for (int r = first; r < last; ++r) {
      if (row_state[r] == RowState::free) impulse[r] += dlambda[r];
    }
  };
  solve({turn_slack, {}});
  update_velocity({add_increment, after});
}

double SolveState::refine_free(double target, int most_steps, Refining what) {
  const auto size = [this](int r) { return row_state[r] == RowState::free ? std::abs(slack[r]) : 0.0; };
  const auto find_largest = [&](int first, int last, int chunk) {
    chunk_values[chunk] = greatest_of(first, last, size);
  };
  double worst = greatest_over_rows(size);
  for (int k = 0; k < most_steps && worst > target; ++k) {
    correct_free(std::cref(find_largest));
    if (what == Refining::answer) ++summary->refinements;
    const double next = greatest_of(chunk_values);
    if (!(next < 0.5 * worst)) return next;
    worst = next;
  }
  return worst;
}

double SolveState::residual_of(std::span<const double> slacks) {
  return greatest_over_chunks([&](int first, int last, int) {
    return step->set().residual(first, last, step->diagonal(), impulse, slacks);
  });
}

double SolveState::residual_with_shift() { return residual_of(slack); }

double SolveState::residual() {
  if (!step->set().has_coulomb()) return residual_of(slack);
  law_slack = slack;
  put_law_into(law_slack, [](std::size_t, double) {});
  return residual_of(law_slack);
}

int SolveState::find_violations(double tolerance, Violated when) {
  StageTimer timer(tasks.clock(), Stage::check);
  const StepProblem& problem = step->problem();
  const std::span<const double> diagonal = step->diagonal();
  // Without branches, which would be guessed wrong. 0 times a bound that is infinite is beyond nothing.
  const auto is_violated = [&](int r) {
    const double lower = problem.lower[r], upper = problem.upper[r], d = diagonal[r];
    const double pull = when == Violated::now ? 0.0 : slack[r];
    const bool out =
        ((lower - impulse[r]) * d + pull > tolerance) | ((impulse[r] - upper) * d - pull > tolerance);
    const bool leaves_lower = slack[r]<-tolerance, leaves_upper = slack[r]> tolerance;
    const bool is_free = row_state[r] == RowState::free, is_lower = row_state[r] == RowState::lower;
    return (lower != upper) &
           ((is_free & out) | (is_lower & leaves_lower) | (!is_free & !is_lower & leaves_upper));
  };
  row_is_violated.resize(impulse.size());
  run_over_rows([&](int first, int last, int) {
    for (int r = first; r < last; ++r) row_is_violated[r] = is_violated(r);
  });
  list_violated();
  return static_cast<int>(violated.size());
}

// Few are: memchr goes over the others, many at a time.
void SolveState::list_violated() {
  violated.clear();
  const char *begin = row_is_violated.data(), *end = begin + row_is_violated.size();
  for (const char* next = begin; next != end; ++next) {
    next = static_cast<const char*>(std::memchr(next, 1, end - next));
    if (next == nullptr) return;
    violated.push_back(static_cast<int>(next - begin));
  }
}

bool SolveState::settle(double tolerance, const Settling& settling) {
  const double most =
      settling.most_violations + settling.violated_share * static_cast<double>(impulse.size());
  int least = std::numeric_limits<int>::max();
  for (int round = 0; round < settling.rounds && factor_free(); ++round) {
    refine_free(0.1 * tolerance, settling.refinements, Refining::answer);
    const int count = find_violations(tolerance);
    // A narrow row may stand at the wrong one of its bounds and yet be right to within the tolerance.
    if (count == 0 || residual() <= tolerance) return true;
    if (count >= least || count > most) return false;
    least = count;
    for (int row : violated) flip(row);
  }
  return false;
}

void SolveState::flip(int row) {
  if (row_state[row] == RowState::free) {
    row_state[row] = impulse[row] < step->problem().lower[row] ? RowState::lower : RowState::upper;
  } else {
    row_state[row] = RowState::free;
  }
}

}  // namespace cleave

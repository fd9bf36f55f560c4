#include "harness/experiment/model_watch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "harness/base/csv_text.h"
#include "harness/base/larger_or_nan.h"
#include "harness/base/median.h"
#include "harness/base/numbers.h"
#include "harness/base/value_spans.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/friction_box.h"
#include "harness/experiment/friction_cone.h"
#include "harness/experiment/model_changes.h"
#include "harness/experiment/step_columns.h"
#include "solver/registry.h"

namespace cleave {
namespace {

constexpr int kMostSamples = 8;     // half of them go when there is one more
constexpr int kTimedSolves = 3;     // of which the median counts
constexpr double kRounding = 1e-9;  // of an impulse at its bound

const Solution* found_by_anyone(const ObservedStep& step) {
  const auto found = std::ranges::find_if(step.outcomes, &Outcome::can_advance);
  return found == step.outcomes.end() ? nullptr : &found->solution;
}

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

// |lambda_t| of a contact.
double tangential_impulse(const StepProblem& problem, int normal, const std::vector<double>& impulse) {
  double length = 0;
  for (int row = normal + 1; row < problem.row_count() && problem.friction_row[row] == normal; ++row)
    length = std::hypot(length, impulse[row]);
  return length;
}

// Of a friction row; in a cone both rows of a contact reach it together.
bool is_at_bound(const StepProblem& problem, int row, const std::vector<double>& impulses) {
  const int normal = problem.friction_row[row];
  if (!problem.contact_set.empty() && problem.contact_set[normal] != ContactSet::box)
    return tangential_impulse(problem, normal, impulses) >=
           problem.friction_coefficient[row] * impulses[normal] * (1 - kRounding);
  const double impulse = impulses[row];
  const auto reaches = [impulse](double bound) {
    return std::isfinite(bound) && std::abs(impulse - bound) <= kRounding * std::abs(bound);
  };
  return reaches(problem.lower[row]) || reaches(problem.upper[row]);
}

struct TimedSolve {
  double t_s_ms = 0;
  std::vector<double> velocity;
  bool is_ok = false;
};

TimedSolve solve_timed(const StepProblem& problem) {
  const std::unique_ptr<StepSolver> solver = make_step_solver("exact");
  std::array<double, kTimedSolves> times{};
  TimedSolve result;
  for (double& t_s_ms : times) {
    Solution solution{problem.warm_impulse, {}};
    const SolveSummary summary = solver->solve(problem, {}, solution);
    result.is_ok = has_result(summary.status);
    t_s_ms = summary.times.total_ms;
    result.velocity = std::move(solution.velocity);
  }
  result.t_s_ms = median_in_place(times);
  return result;
}

ModelFinding named(const char* name, const char* advice, long found = 0, long of = 0) {
  ModelFinding finding;
  finding.name = name;
  finding.advice = advice;
  finding.found = found;
  finding.of = of;
  return finding;
}

}  // namespace

ModelWatch::Pair ModelWatch::pair_of(const StepProblem& problem, int row) {
  return std::minmax(problem.row_body[2 * std::size_t(row)], problem.row_body[2 * std::size_t(row) + 1]);
}

void ModelWatch::watch(const ObservedStep& step) {
  const Solution* solution = found_by_anyone(step);
  if (solution == nullptr || step.problem.row_count() == 0) return;
  watch_pairs(step, *solution);
  watch_bodies(step, *solution);
  watch_cone(step.problem, *solution);
  keep_sample(step);
  ++steps_;
}

void ModelWatch::watch_pairs(const ObservedStep& step, const Solution& solution) {
  const StepProblem& problem = step.problem;
  const double unloaded = kUnloaded * largest_of(solution.impulse);
  const std::vector<char> at_cap = contacts_behind(problem, step.context.contacts, options_.contact_cap - 1);
  for (int row = 0; row < problem.row_count(); ++row) {
    if (problem.row_kind[row] == RowKind::bilateral) continue;
    PairRecord& pair = pairs_[pair_of(problem, row)];
    const double impulse = solution.impulse[row];
    const bool is_loaded = std::abs(impulse) > unloaded;
    pair.touches |= is_loaded;
    if (problem.row_kind[row] == RowKind::normal) {
      pair.reached_cap |= at_cap[row] != 0;
    } else {
      pair.has_friction = true;
      pair.has_loaded_friction |= is_loaded;
      pair.was_at_bound |= is_loaded && is_at_bound(problem, row, solution.impulse);
    }
  }
}

void ModelWatch::watch_bodies(const ObservedStep& step, const Solution& solution) {
  const std::vector<double>& position_m = step.context.position_m;
  if (steps_ == 0) {
    first_position_m_ = position_m;
    has_moved_.assign(step.problem.free_velocity.size() / 6, 0);
  }
  for (std::size_t i = 0; i < has_moved_.size(); ++i) {
    for (std::size_t k = 6 * i; k < 6 * i + 6; ++k) has_moved_[i] |= std::abs(solution.velocity[k]) > kFast;
    for (std::size_t k = 3 * i; k < 3 * i + 3 && k < position_m.size(); ++k)
      has_moved_[i] |= std::abs(position_m[k] - first_position_m_[k]) > kMoved;
  }
}

void ModelWatch::watch_cone(const StepProblem& problem, const Solution& solution) {
  for (int row = 0; row + 1 < problem.row_count(); ++row) {
    if (problem.row_kind[row] != RowKind::normal || problem.friction_row[row + 1] != row ||
        !has_frozen_bound(problem, row + 1))
      continue;
    const double bound = coulomb_bound(problem, row + 1, solution.impulse);
    ++contacts_;
    contacts_beyond_cone_ += tangential_impulse(problem, row, solution.impulse) > bound * (1 + kRounding);
  }
}

void ModelWatch::keep_sample(const ObservedStep& step) {
  if (steps_ % stride_ != 0) return;
  const int half_cap = (options_.contact_cap + 1) / 2;
  samples_.push_back({step.problem, contacts_behind(step.problem, step.context.contacts, half_cap), steps_});
  if (static_cast<int>(samples_.size()) <= kMostSamples) return;
  stride_ *= 2;
  std::erase_if(samples_, [this](const Sample& sample) { return sample.number % stride_ != 0; });
}

// change: of a sample into what its step problem would be.
template <class Change>
ModelFinding ModelWatch::try_out(ModelFinding finding, Change change) const {
  finding.steps = steps_;
  if (finding.found == 0) return finding;
  long rows = 0, gone = 0;
  for (const Sample& sample : samples_) {
    const StepProblem changed = change(sample);
    const TimedSolve before = solve_timed(sample.problem), after = solve_timed(changed);
    if (!before.is_ok || !after.is_ok) continue;
    ++finding.samples;
    rows += sample.problem.row_count();
    gone += sample.problem.row_count() - changed.row_count();
    finding.t_s_ms += before.t_s_ms;
    finding.saved_ms += before.t_s_ms - after.t_s_ms;
    finding.change_m_per_s =
        larger_or_nan(finding.change_m_per_s, largest_difference(before.velocity, after.velocity));
  }
  if (finding.samples == 0) return finding;
  finding.rows_share = rows == 0 ? 0 : static_cast<double>(gone) / static_cast<double>(rows);
  finding.t_s_ms /= finding.samples;
  finding.saved_ms /= finding.samples;
  return finding;
}

// change: of a step problem and (m) which of its rows of a kind belong to pairs that are found.
template <class IsFound, class Change>
ModelFinding ModelWatch::find_pairs(const char* name, const char* advice, RowKind kind, IsFound is_found,
                                    Change change) const {
  ModelFinding finding = named(name, advice, 0, std::ssize(pairs_));
  for (const auto& [pair, record] : pairs_) finding.found += is_found(record);
  return try_out(std::move(finding), [&](const Sample& sample) {
    const StepProblem& problem = sample.problem;
    std::vector<char> rows(problem.rhs.size(), 0);
    for (int row = 0; row < problem.row_count(); ++row)
      rows[row] = problem.row_kind[row] == kind && is_found(pairs_.at(pair_of(problem, row)));
    return change(problem, rows);
  });
}

ModelFinding ModelWatch::find_still_bodies() const {
  std::vector<char> is_still = has_moved_;
  for (char& body : is_still) body = body == 0;
  return try_out(named("body_at_rest", "static geometry in their place would do",
                       std::ranges::count(is_still, 1), std::ssize(is_still)),
                 [&](const Sample& sample) { return with_static_bodies(sample.problem, is_still); });
}

ModelFinding ModelWatch::find_full_pairs() const {
  const long full = std::ranges::count_if(pairs_, [](const auto& pair) { return pair.second.reached_cap; });
  return try_out(
      named("contact_cap", "tried is half of --contact-cap; where that changes little, fewer points do", full,
            std::ssize(pairs_)),
      [](const Sample& sample) { return without_rows(sample.problem, sample.behind_half_cap); });
}

ModelFinding ModelWatch::find_boxes_beyond_cones() const {
  return try_out(
      named("box_beyond_cone", "--friction cone or coulomb keeps friction to mu times the normal impulse",
            contacts_beyond_cone_, contacts_),
      [](const Sample& sample) {
        StepProblem problem = sample.problem;
        set_cones(problem);
        return problem;
      });
}

std::vector<ModelFinding> ModelWatch::findings() const {
  return {find_pairs(
              "contact_apart", "--model auto leaves such rows out", RowKind::normal,
              [](const PairRecord& pair) { return !pair.touches; }, without_rows),
          find_pairs(
              "friction_unloaded", "--friction none, for a scene in which nothing else has friction",
              RowKind::friction,
              [](const PairRecord& pair) {
                return pair.touches && pair.has_friction && !pair.has_loaded_friction;
              },
              without_rows),
          find_pairs(
              "friction_never_at_bound", "these contacts only stick: joints would do", RowKind::friction,
              [](const PairRecord& pair) { return pair.has_loaded_friction && !pair.was_at_bound; },
              with_bilateral_rows),
          find_full_pairs(),
          find_still_bodies(),
          find_boxes_beyond_cones()};
}

std::string findings_csv(const std::vector<ModelFinding>& findings) {
  std::string text = "finding,found,of,steps,samples,rows_share,t_s_ms,saved_ms,change_m_per_s,advice\n";
  for (const ModelFinding& finding : findings)
    text += finding.name + "," + std::to_string(finding.found) + "," + std::to_string(finding.of) + "," +
            std::to_string(finding.steps) + "," + std::to_string(finding.samples) + "," +
            number_text(finding.rows_share) + "," + number_text(finding.t_s_ms) + "," +
            number_text(finding.saved_ms) + "," + number_text(finding.change_m_per_s) + "," +
            csv_cell(finding.advice) + "\n";
  return text;
}

std::string findings_text(const std::vector<ModelFinding>& findings) {
  std::string text, nothing;
  for (const ModelFinding& finding : findings) {
    if (finding.found == 0) {
      nothing += (nothing.empty() ? "" : ", ") + finding.name;
      continue;
    }
    std::array<char, 400> line;
    std::snprintf(line.data(), line.size(),
                  "%-24s %7ld of %-7ld %5.1f %% of the rows; saves %.3g of %.3g ms, changes %.2g m/s: %s\n",
                  finding.name.c_str(), finding.found, finding.of, 100 * finding.rows_share, finding.saved_ms,
                  finding.t_s_ms, finding.change_m_per_s, finding.advice.c_str());
    text += line.data();
  }
  return text + (nothing.empty() ? "" : "not found: " + nothing + "\n");
}

}  // namespace cleave

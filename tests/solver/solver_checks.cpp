#include "tests/solver/solver_checks.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "solver/registry.h"

namespace cleave {
namespace {

constexpr double kVelocityTolerance = 1e-9;

double largest_entry(std::span<const double> values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

testing::AssertionResult velocities_agree(const StepProblem& problem, std::span<const double> actual,
                                          std::span<const double> expected, double tolerance) {
  if (actual.size() != expected.size()) {
    return testing::AssertionFailure()
           << "velocity has " << actual.size() << " entries, not " << expected.size();
  }
  const double scale = std::max({1.0, largest_entry(problem.free_velocity), largest_entry(expected)});
  for (std::size_t i = 0; i < actual.size(); ++i) {
    if (std::abs(actual[i] - expected[i]) <= tolerance * scale) continue;
    return testing::AssertionFailure()
           << "velocity[" << i << "] = " << actual[i] << ", expected " << expected[i] << ", difference "
           << actual[i] - expected[i] << ", allowed " << tolerance * scale;
  }
  return testing::AssertionSuccess();
}

testing::AssertionResult is_exact(const StepProblem& problem, const SolveSummary& summary,
                                  const Solution& solution) {
  if (std::ssize(solution.impulse) != problem.row_count()) {
    return testing::AssertionFailure() << "impulse has " << solution.impulse.size() << " entries";
  }
  const ResidualReport report = judge(problem, solution.impulse);
  if (summary.status != SolveStatus::ok || !report.exact) {
    return testing::AssertionFailure()
           << "status " << to_string(summary.status) << " (" << summary.message << "), residual "
           << report.residual_m_per_s << ", limit " << report.limit_m_per_s << ", rows "
           << problem.row_count() << ", bodies " << problem.body_count() << ", strategy " << summary.strategy
           << ", iterations " << summary.iterations << ", fallbacks " << summary.fallbacks;
  }
  return velocities_agree(problem, solution.velocity, report.velocity, kVelocityTolerance);
}

testing::AssertionResult is_honest(const StepProblem& problem, const SolveSummary& summary,
                                   const Solution& solution) {
  if (summary.status == SolveStatus::ok) return is_exact(problem, summary, solution);
  const ResidualReport report = judge(problem, solution.impulse);
  if (report.residual_m_per_s <= 0.5 * report.limit_m_per_s) {
    return testing::AssertionFailure() << "status " << to_string(summary.status) << " with residual "
                                       << report.residual_m_per_s << ", limit " << report.limit_m_per_s;
  }
  if (summary.message.empty()) return testing::AssertionFailure() << "not ok, but no message";
  return testing::AssertionSuccess();
}

bool same_bytes(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

bool may_miss(std::string_view solver) {
  const std::string strategy = solver_halves(std::string(solver)).strategy;
  return std::ranges::none_of(strategy_table(), [&](const StrategyRow& row) {
    return row.name == strategy && row.traits.always_exact;
  });
}

std::string kernel_of(std::string_view solver) {
  const std::string kernel = solver_halves(std::string(solver)).kernel;
  return kernel == "auto" ? "" : kernel;
}

Solution cold_start(const StepProblem& problem) {
  Solution solution;
  solution.impulse.assign(problem.row_count(), 0);
  return solution;
}

}  // namespace cleave

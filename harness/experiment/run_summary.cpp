#include "harness/experiment/run_summary.h"

#include <cmath>
#include <cstdio>

#include "harness/base/larger_or_nan.h"
#include "solver/step_solver.h"

namespace cleave {
namespace {

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

// Why the row is not ok.
std::string reason(const StepRecord& row) {
  if (row.status_reason != "-" && !has_result(row.status)) return row.status_reason;
  return format("residual %.3g m/s", row.residual_m_per_s);
}

}  // namespace

void RunSummary::add(const StepRecord& row) {
  ++rows;
  if (has_result(row.status)) {  // others say nothing of residuals
    ++rows_with_result;
    worst_residual_m_per_s = larger_or_nan(worst_residual_m_per_s, row.residual_m_per_s);
    worst_velocity_spread_m_per_s = larger_or_nan(worst_velocity_spread_m_per_s, row.velocity_spread_m_per_s);
  }
  if (!std::isnan(row.t_s_waiting_ms)) {
    t_s_total_ms += row.t_s_ms;
    t_s_waiting_total_ms += row.t_s_waiting_ms;
  }
  if (!std::isnan(row.core_round_trip_ns)) {
    t_s_apart_total_ms += row.t_s_ms;
    if (row.core_round_trip_ns >= kFarNs) t_s_far_ms += row.t_s_ms;
  }
  if (row.status == "ok") {
    ++rows_ok;
  } else if (failures.size() < kListedFailures) {
    const std::string file = row.problem_file == "-" ? "" : row.problem_file + " ";
    failures.push_back(file +
                       format("step %d %s+%s %s: %s, ", row.step, row.partitioner.c_str(),
                              row.refiner.c_str(), row.solver.c_str(), row.status.c_str()) +
                       reason(row));
  }
}

std::vector<std::pair<std::string, double>> RunSummary::counts() const {
  return {{"steps", double(steps)},
          {"measured_steps", double(measured_steps)},
          {"measured_with_contacts", double(measured_with_contacts)},
          {"rows", double(rows)},
          {"rows_ok", double(rows_ok)},
          {"inexact_advances", double(inexact_advances)},
          {"stopped_worlds", double(stopped_worlds)},
          {"unconverged_bounds", double(unconverged_bounds)},
          {"worst_residual_m_per_s", worst_residual_m_per_s},
          {"worst_velocity_spread_m_per_s", worst_velocity_spread_m_per_s},
          {"t_s_total_ms", t_s_total_ms},
          {"t_s_waiting_total_ms", t_s_waiting_total_ms},
          {"wall_s", wall_s}};
}

std::string RunSummary::text() const {
  std::string lines;
  for (const std::string& failure : failures) lines += failure + "\n";
  const int unlisted = rows - rows_ok - static_cast<int>(failures.size());
  if (unlisted > 0) lines += format("... and %d more rows that are not ok\n", unlisted);
  if (inexact_advances > 0)
    lines += format("steps advanced by a solution outside the limit: %d\n", inexact_advances);
  if (stopped_worlds > 0)
    lines +=
        format("worlds stopped early by a solver that gave nothing to move them with: %d\n", stopped_worlds);
  if (unconverged_bounds > 0)
    lines += format("steps on which the friction bounds did not settle: %d\n", unconverged_bounds);
  if (measured_steps > 0 && 5 * measured_with_contacts < measured_steps)
    lines += format("only %d of %d measured steps have contacts (under 20 %%)\n", measured_with_contacts,
                    measured_steps);
  if (t_s_waiting_total_ms > kMostWaiting * t_s_total_ms)
    lines += format(
        "the threads of the solves waited %.3g ms for a core in solves of %.3g ms, used by others or by more "
        "threads than there are cores (a wait counts whole where it ends)\n",
        t_s_waiting_total_ms, t_s_total_ms);
  if (t_s_far_ms > kMostFar * t_s_apart_total_ms)
    lines += format(
        "for %.3g %% of the time of the solves their threads were on cores far apart (core_round_trip_ns >= "
        "%g): small ones take longer there\n",
        100 * t_s_far_ms / t_s_apart_total_ms, kFarNs);
  // Where no world moved (replay) there is no velocity to compare with.
  const bool simulated = steps > 0;
  lines += simulated ? format("%lld steps, ", steps) : format("%d problems, ", measured_steps);
  lines += format("%d rows: %d ok, %d not ok", rows, rows_ok, rows - rows_ok);
  if (rows_with_result > 0) lines += format("; worst residual %.3g m/s", worst_residual_m_per_s);
  if (rows_with_result > 0 && simulated)
    lines += format(", worst velocity spread %.3g m/s", worst_velocity_spread_m_per_s);
  return lines + format("; %.1f s\n", wall_s);
}

}  // namespace cleave

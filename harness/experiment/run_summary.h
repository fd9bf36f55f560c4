// What a run amounts to, counted row by row: the last line on the terminal, the manifest's result and the
// exit code.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "harness/experiment/step_record.h"

namespace cleave {

struct RunSummary {
  static constexpr int kListedFailures = 10;
  static constexpr double kMostWaiting = 0.05;  // of the time of the solves, before it is said
  static constexpr double kMostFar = 0.05;      // of that time on cores far apart, before it is said
  static constexpr double kFarNs = 300;         // core_round_trip_ns; cores that share a cache need some 100

  int rows = 0;
  int rows_ok = 0;
  long long steps = 0;     // simulated, over all worlds
  int measured_steps = 0;  // or problems replayed
  int measured_with_contacts = 0;
  int inexact_advances = 0;  // steps advanced by a solution outside the judge's limit
  int stopped_worlds = 0;    // worlds without a solution, or with velocities or positions that are no numbers
  int unconverged_bounds = 0;  // steps on which the bounds of box-converged did not settle
  int rows_with_result = 0;    // whose residuals are in the two below
  double worst_residual_m_per_s = 0;
  double worst_velocity_spread_m_per_s = 0;
  double t_s_total_ms = 0;  // over all rows that say how long their solve waited for a core
  double t_s_waiting_total_ms = 0;
  double t_s_apart_total_ms = 0;  // over all rows that say how far apart the cores of their solve were
  double t_s_far_ms = 0;          // over those with kFarNs or more
  double wall_s = 0;
  bool interrupted = false;
  std::vector<std::string> failures;  // the first kListedFailures rows that are not ok, in words

  // NaN counts as the worst of all.
  void add(const StepRecord& row);

  // Everything that ran is exact.
  bool all_ok() const { return rows_ok == rows && inexact_advances == 0 && stopped_worlds == 0; }

  // The totals by name, for the manifest.
  std::vector<std::pair<std::string, double>> counts() const;

  // Lines for people: listed failures, remarks, and the totals last.
  std::string text() const;
};

}  // namespace cleave

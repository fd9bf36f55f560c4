#include "harness/commands/verify_row_groups.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "harness/base/numbers.h"
#include "harness/experiment/run_summary.h"
#include "solver/step_solver.h"

namespace cleave {
namespace {

// Columns that are equal in rows of one group.
class EqualInGroup {
 public:
  EqualInGroup(std::vector<std::string> columns, std::string group)
      : columns_(std::move(columns)), group_(std::move(group)) {}

  void add(const StepsTable& table, std::size_t row, const std::string& key, Findings& findings) {
    const auto [first, is_new] = first_row_.emplace(key, row);
    if (is_new) return;
    for (const std::string& column : columns_)
      if (table.cell(row, column) != table.cell(first->second, column))
        findings.add(StepsTable::line_of(row) + ": " + column + " = " + table.cell(row, column) + ", in " +
                     StepsTable::line_of(first->second) + " " + table.cell(first->second, column) + ", " +
                     group_);
  }

 private:
  std::vector<std::string> columns_;
  std::string group_;
  std::map<std::string, std::size_t> first_row_;
};

// Solvers that take a tree of parts split by recursion, by the arity that they say; no other row has one.
std::string arity_cell(const StepsTable& table, std::size_t row) {
  return std::ranges::count(table.header(), "arity") > 0 ? table.cell(row, "arity") : "";
}

StepRecord counted_columns(const StepsTable& table, std::size_t row) {
  StepRecord record;
  record.status = table.cell(row, "status");
  record.residual_m_per_s = table.number(row, "residual_m_per_s");
  record.velocity_spread_m_per_s = table.number(row, "velocity_spread_m_per_s");
  record.t_s_ms = table.number(row, "t_s_ms");
  record.t_s_waiting_ms = table.number(row, "t_s_waiting_ms");
  return record;
}

}  // namespace

void check_rows_of_problems(const StepsTable& table, const ExpectedRows& expected, const std::string& subject,
                            CheckList& list) {
  EqualInGroup problem(
      {"bodies", "contacts", "contact_cap_hits", "rows", "rows_bilateral", "rows_normal", "rows_friction",
       "islands", "t_collide_ms", "t_extract_ms", "t_predict_ms", "max_penetration_m", "potential_energy_j",
       "problem_hash", "state_hash", "joint_drift_m", "last_body_z_m"},
      "of the same problem");
  EqualInGroup solved({"largest_free_velocity_m_per_s"}, "of the same problem");
  EqualInGroup grown({"parts_before", "max_part_bodies_before", "cut_pairs_before", "interface_rows_before",
                      "interface_bodies_before", "contiguous_before"},
                     "grown alike");
  EqualInGroup refined({"parts", "max_part_bodies", "cut_pairs", "interface_rows", "interface_bodies",
                        "interface_cover_bodies", "contiguous", "part_mass_ratio_max", "partition_origin"},
                       "refined alike");
  Findings findings;
  const std::size_t rows = expected.is_separate() ? 0 : std::min(table.row_count(), expected.count());
  for (std::size_t row = 0; row < rows; ++row) {
    const std::string of = std::to_string(expected.problem(row));
    const std::string pair = table.cell(row, "partitioner") + "+" + table.cell(row, "refiner");
    const std::string arity = " " + arity_cell(table, row);
    problem.add(table, row, of, findings);
    if (has_result(table.cell(row, "status"))) solved.add(table, row, of, findings);
    // Taken over, parts are those that were refined in the step before.
    if (table.cell(row, "partition_origin") == "fresh" || table.cell(row, "partition_origin") == "-")
      grown.add(table, row, of + " " + table.cell(row, "partitioner") + arity, findings);
    refined.add(table, row, of + " " + pair + arity, findings);
  }
  list.add(findings.none(), subject, "rows of a problem agree about it" + findings.text());
}

void check_totals(const StepsTable& table, const ExpectedRows& expected, const StoredManifest& manifest,
                  const std::string& subject, CheckList& list) {
  RunSummary summary;
  std::set<std::size_t> measured;  // problems; in separate worlds every row is one of its own
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    summary.add(counted_columns(table, row));
    if (table.cell(row, "status") == "skipped") continue;
    const std::size_t problem = expected.is_separate() ? row : expected.problem(row);
    if (!measured.insert(problem).second) continue;
    ++summary.measured_steps;
    if (table.number(row, "contacts") > 0) ++summary.measured_with_contacts;
  }
  // These the rows do not tell.
  static const std::set<std::string> untold = {"steps", "inexact_advances", "stopped_worlds",
                                               "unconverged_bounds", "wall_s"};
  Findings findings;
  for (const auto& [name, counted] : summary.counts()) {
    if (untold.contains(name)) continue;
    const auto stored = manifest.result.find(name);
    const double told = stored == manifest.result.end() ? kUnmeasured : stored->second;
    const bool same =
        told == counted || (stored != manifest.result.end() && std::isnan(told) && !std::isfinite(counted));
    if (!same)
      findings.add(name + " = " + number_text(told) + ", counted from the rows: " + number_text(counted));
  }
  list.add(findings.none(), subject, "counts are those of the rows" + findings.text());
}

}  // namespace cleave

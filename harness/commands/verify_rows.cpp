#include "harness/commands/verify_rows.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <vector>

#include "harness/base/names.h"
#include "harness/base/refusals.h"
#include "harness/commands/expected_rows.h"
#include "harness/commands/verify_file_rows.h"
#include "harness/commands/verify_row_groups.h"
#include "harness/commands/verify_row_sums.h"
#include "harness/commands/verify_table.h"
#include "harness/experiment/earlier_tables.h"
#include "harness/experiment/step_record.h"
#include "harness/files/manifest.h"
#include "solver/step_problem.h"
#include "solver/step_solver.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> header_of_program() {
  std::vector<std::string> header;
  for (const Column& column : columns()) header.push_back(column.name);
  return header;
}

std::string first_difference(const std::vector<std::string>& found, const std::vector<std::string>& wanted) {
  for (std::size_t i = 0; i < std::max(found.size(), wanted.size()); ++i) {
    const std::string here = i < found.size() ? found[i] : "nothing",
                      there = i < wanted.size() ? wanted[i] : "nothing";
    if (here != there) return "; column " + std::to_string(i + 1) + " is " + here + ", allowed: " + there;
  }
  return "";
}

// The table where it can be read and has the columns of its schema.
std::optional<StepsTable> check_header(const fs::path& path, const StoredManifest& manifest,
                                       CheckList& list) {
  std::optional<StepsTable> table;
  const std::string error = wrong_in([&] {
    table.emplace(path);
    std::string difference = first_difference(table->header(), manifest.columns);
    if (difference.empty() && manifest.steps_schema == kStepsSchema &&
        !are_columns_of_schema(table->header()))
      difference = first_difference(table->header(), header_of_program());
    return difference;
  });
  list.add(error.empty(), path.string(), "header and lines of its schema" + error);
  if (!error.empty()) table.reset();
  return table;
}

std::string key_of(const StepsTable& table, std::size_t row, bool is_replay) {
  return row_key(table.cell(row, is_replay ? "problem_file" : "step"), table.cell(row, "partitioner"),
                 table.cell(row, "refiner"), table.cell(row, "solver"));
}

// Rows that are too many, doubled, out of order or not there. Where all is well, row i is expected row i.
bool check_keys(const StepsTable& table, const ExpectedRows& expected, const StoredManifest& manifest,
                const std::string& subject, CheckList& list) {
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < expected.count(); ++i) place.emplace(expected.key(i), i);
  std::map<std::string, std::size_t> seen;
  Findings findings;
  std::size_t next = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const std::string key = key_of(table, row, expected.is_replay());
    const auto found = place.find(key);
    const std::string line = StepsTable::line_of(row) + ": " + key;
    const bool in_place = next < expected.count() && expected.key(next) == key;
    const auto [earlier, is_new] = seen.emplace(key, row);
    if (found == place.end()) {
      findings.add(line + " is no row of this run");
    } else if (!is_new && !in_place) {
      findings.add(line + " repeats " + StepsTable::line_of(earlier->second));
    } else if (!in_place && found->second < next) {
      findings.add(line + " stands out of order");
    }
    if (found != place.end() && (in_place || found->second >= next))
      next = (in_place ? next : found->second) + 1;
  }
  if (manifest.state == "complete")
    for (const auto& [key, i] : place)
      if (!seen.contains(key)) findings.add(key + " has no row");
  if (findings.none() && manifest.state == "complete" && table.row_count() != expected.count())
    findings.add(std::to_string(table.row_count()) + " rows, allowed: " + std::to_string(expected.count()));
  list.add(findings.none(), subject,
           std::to_string(table.row_count()) + " of " + std::to_string(expected.count()) +
               " rows, each in its place" + findings.text());
  return findings.none();
}

// Columns that only the problem file of a replayed row knows.
const std::set<std::string> kOfProblemFile = {"scene",    "seed", "step", "time_s",
                                              "friction", "dt_s", "cfm",  "erp"};
// Columns that no replayed row has a value of.
const std::set<std::string> kOfWorld = {"contact_cap_hits",   "ode_messages",  "max_penetration_m",
                                        "potential_energy_j", "state_hash",    "velocity_spread_m_per_s",
                                        "joint_drift_m",      "last_body_z_m", "t_collide_ms",
                                        "t_extract_ms",       "t_predict_ms"};
// Columns about what was done or found, beside those that were measured.
const std::set<std::string> kOfSolve = {"status", "status_reason", "strategy", "kernel"};

std::vector<std::string> columns_of_options(bool is_replay) {
  std::vector<std::string> names;
  for (const Column& column : columns()) {
    const bool of_options = column.about != About::measured && !kOfSolve.contains(column.name);
    const bool told =
        is_replay ? (of_options && !kOfProblemFile.contains(column.name)) || kOfWorld.contains(column.name)
                  : of_options;
    if (told) names.push_back(column.name);
  }
  return names;
}

void check_options_in_rows(const StepsTable& table, const ExpectedRows& expected, const std::string& subject,
                           CheckList& list) {
  const std::vector<std::string> columns = columns_of_options(expected.is_replay());
  Findings findings;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    StepRecord wanted = expected.row(row);
    const std::string& status = table.cell(row, "status");
    if (status == "skipped") {
      wanted.problem_file = "-";
      wanted.repeat_count = -1;
    }
    const auto cells = cells_of(wanted);
    for (const std::string& column : columns) {
      if (column == "repeat_count" && status != "skipped" && !has_result(status))
        continue;  // ended by a failure
      if (table.cell(row, column) != cells.at(column))
        findings.add(StepsTable::line_of(row) + ": " + column + " = " + table.cell(row, column) +
                     ", by the manifest " + cells.at(column));
    }
  }
  list.add(findings.none(), subject,
           std::to_string(columns.size()) + " columns are those of the manifest's options" + findings.text());
}

void check_limits(const StepsTable& table, const std::string& subject, CheckList& list) {
  std::size_t ok = 0;
  Findings wrong;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (table.cell(row, "status") != "ok") continue;
    ++ok;
    if (!residual_is_exact(table, row))
      wrong.add(StepsTable::line_of(row) + " says ok with a residual of " +
                table.cell(row, "residual_m_per_s") + " m/s");
  }
  list.add(wrong.none(), subject,
           std::to_string(ok) + " of " + std::to_string(table.row_count()) +
               " rows say ok, all within the limit" + wrong.text());
}

// What the options promise; nothing for options that no run can have.
std::optional<ExpectedRows> check_options(const fs::path& directory, const StoredManifest& manifest,
                                          CheckList& list) {
  std::optional<ExpectedRows> expected;
  const std::string error = wrong_in([&] { expected.emplace(manifest); });
  list.add(expected.has_value(), (directory / kManifestFile).string(), "options of a run" + error);
  return expected;
}

}  // namespace

void check_steps_table(const fs::path& directory, const StoredManifest& manifest, CheckList& list) {
  const fs::path path = directory / kStepsFile;
  const std::string subject = path.string();
  std::optional<StepsTable> table = check_header(path, manifest, list);
  if (!table) return;
  const bool is_earlier = manifest.steps_schema == kStepsSchema && are_columns_of_schema(table->header());
  if (table->header() != header_of_program() && !is_earlier) {
    check_limits(*table, subject, list);
    return CheckList::note(subject, "has the columns of another schema; no more of its rows was checked");
  }
  table->add_later_columns();
  if (!check_cells(*table, subject, list)) return;
  check_limits(*table, subject, list);
  check_rows_alone(*table, subject, list);
  const std::optional<ExpectedRows> expected = check_options(directory, manifest, list);
  if (expected && check_keys(*table, *expected, manifest, subject, list)) {
    check_options_in_rows(*table, *expected, subject, list);
    check_rows_of_problems(*table, *expected, subject, list);
    if (manifest.state == "complete") check_totals(*table, *expected, manifest, subject, list);
  }
  check_file_rows(directory, *table, manifest, list);
}

}  // namespace cleave

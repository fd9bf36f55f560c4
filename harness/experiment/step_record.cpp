#include "harness/experiment/step_record.h"

#include <cmath>
#include <cstdio>
#include <string_view>

#include "harness/base/csv_text.h"
#include "harness/base/numbers.h"
#include "harness/experiment/algorithms.h"

namespace cleave {
namespace {

// The machine's numbers are read by people, all others must be comparable digit by digit.
std::string cell_text(ColumnOf of, double value) {
  if (of == ColumnOf::machine || std::isnan(value)) return number_text(value);
  char text[32];
  return std::string(text, std::snprintf(text, sizeof text, "%.17g", value));
}

std::string cell_text(ColumnOf, const std::string& value) { return csv_cell(value); }
std::string cell_text(ColumnOf, int value) { return std::to_string(value); }
std::string cell_text(ColumnOf, std::uint64_t value) { return std::to_string(value); }

constexpr const char* type_of(const std::string&) { return "text"; }
constexpr const char* type_of(double) { return "number"; }
constexpr const char* type_of(int) { return "integer"; }
constexpr const char* type_of(std::uint64_t) { return "integer"; }

}  // namespace

void StepRecord::add_parameters(const Settings& settings) {
  for (const auto& [name, value] : settings.values())
    add_parameter(column_of(name), value == "true" ? "1" : value == "false" ? "0" : value);
}

void StepRecord::add_parameter(const std::string& column, const std::string& cell) {
  const auto [entry, is_new] = parameters.emplace(column, cell);
  if (!is_new && entry->second != cell) entry->second += ";" + cell;
}

void StepRecord::set_partition_before(const PartitionMetrics& metrics) {
  parts_before = metrics.parts;
  max_part_bodies_before = metrics.max_part_bodies;
  cut_pairs_before = metrics.cut_pairs;
  interface_rows_before = metrics.interface_rows;
  interface_bodies_before = metrics.interface_bodies;
  contiguous_before = metrics.contiguous;
}

void StepRecord::set_partition(const PartitionMetrics& metrics) {
  parts = metrics.parts;
  max_part_bodies = metrics.max_part_bodies;
  cut_pairs = metrics.cut_pairs;
  interface_rows = metrics.interface_rows;
  interface_bodies = metrics.interface_bodies;
  interface_cover_bodies = metrics.interface_cover_bodies;
  contiguous = metrics.contiguous;
  part_mass_ratio_max = metrics.part_mass_ratio_max;
}

void StepRecord::set_summary(const SolveSummary& summary) {
  if (!summary.strategy.empty()) strategy = summary.strategy;
  if (!summary.kernel.empty()) kernel = summary.kernel;
  auto_reason = summary.auto_reason;
  factor_predicted_mb = summary.factor_predicted_mb;
  if (!has_result(summary.status)) return;
  interface_unknowns = summary.interface_unknowns;
  factor_mflop_local = summary.factor_mflop_local;
  factor_mflop_interface = summary.factor_mflop_interface;
  factor_mflop_done = summary.factor_mflop_done;
  t_s_ms = summary.times.total_ms;
  t_s_stage_ms = summary.times.stage_ms;
  t_s_other_ms = summary.times.total_ms;
  for (const double stage_ms : t_s_stage_ms) t_s_other_ms -= stage_ms;
  t_s_model_ms = summary.times.model_ms;
  t_s_critical_path_ms = summary.times.critical_path_ms;
  iterations = summary.iterations;
  factorizations = summary.factorizations;
  fallbacks = summary.fallbacks;
  refinements = summary.refinements;
  factor_reuses = summary.factor_reuses;
  cg_iterations = summary.cg_iterations;
}

void StepRecord::set_verdict(const ResidualReport& report) {
  residual_m_per_s = report.residual_m_per_s;
  residual_bilateral_m_per_s = report.residual_bilateral_m_per_s;
  residual_normal_m_per_s = report.residual_normal_m_per_s;
  residual_friction_m_per_s = report.residual_friction_m_per_s;
  largest_free_velocity_m_per_s = report.largest_free_velocity_m_per_s;
  kinetic_energy_j = report.kinetic_energy_j;
  energy_excess_j = report.energy_excess_j;
  residual_relative = report.residual_relative;
}

void StepRecord::set_friction(const FrictionMismatch& mismatch) {
  bound_mismatch = mismatch.bound_mismatch;
  friction_beyond_share = mismatch.friction_beyond_share;
}

void StepRecord::set_model(const ModelCounts& counts) {
  model_rows_left_out = counts.rows_left_out;
  model_rows_at_rest = counts.rows_at_rest;
  model_rows_returned = counts.rows_returned;
  model_passes = counts.passes;
}

std::vector<Column> columns() {
  std::vector<Column> list;
  const StepRecord record;
  visit_fields(record,
               [&list](std::string_view name, const auto& value, const char* help, ColumnOf of, About about) {
                 list.push_back({std::string(name), help, of == ColumnOf::machine, about, type_of(value)});
               });
  return list;
}

std::string csv_header() {
  std::string line;
  for (const Column& column : columns()) line += column.name + ",";
  line.back() = '\n';
  return line;
}

std::string csv_line(const StepRecord& record) {
  std::string line;
  visit_fields(record, [&line](std::string_view, const auto& value, const char*, ColumnOf of, About) {
    line += cell_text(of, value) + ",";
  });
  line.back() = '\n';
  return line;
}

std::string csv_lines(std::span<const StepRecord> records) {
  std::string lines;
  for (const StepRecord& record : records) lines += csv_line(record);
  return lines;
}

}  // namespace cleave

// Every column of steps.csv, once: one row per measured (step, combination).
//
// visit_fields is the only list of fields. The CSV header, the CSV rows and the manifest's description of the
// columns are all drawn from it, in its order. To add a column: a member, and a line at the end of
// visit_fields: visit_machine where two runs of the same experiment may differ, visit elsewhere.
//
// Counts that were not measured are -1, numbers that were not measured NaN (printed "nan"), names "-". A
// solver that ignores partitions has "-" as partitioner and refiner and leaves the partition's columns
// unmeasured. Columns named t_... are times in milliseconds. A solve that was refused, crashed or found no
// memory measured nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/base/about.h"
#include "harness/base/column.h"
#include "harness/base/parameter.h"
#include "harness/experiment/cell_measures.h"
#include "harness/experiment/friction_mismatch.h"
#include "harness/experiment/model_planner.h"
#include "harness/experiment/parameter_columns.h"
#include "partition/partition.h"
#include "solver/residual.h"
#include "solver/step_solver.h"

namespace cleave {

// In the column schema_version of every row. Counts up when a column changes its meaning; new ones come at
// the end.
inline constexpr const char* kStepsSchema = "cleave-steps-5";

// Who a column is about. The machine's may differ between two runs of the same experiment, all others may
// not.
enum class ColumnOf { experiment, machine };

inline constexpr double kUnmeasured = std::numeric_limits<double>::quiet_NaN();

struct StepRecord {
  // The experiment.
  std::string run_id = "-", scene = "-";
  std::uint64_t seed = 0;
  int step = -1;
  double time_s = kUnmeasured;
  int repeat_count = -1;
  std::string partitioner = "-", refiner = "-", solver = "-", strategy = "-", kernel = "-", friction = "-";
  int threads = -1;
  std::string status = "skipped";
  // Parameters of the row's algorithms, by column; others have "-".
  std::map<std::string, std::string> parameters;
  // The problem.
  int bodies = -1, contacts = -1, contact_cap_hits = -1, ode_messages = -1;
  int rows = -1, rows_bilateral = -1, rows_normal = -1, rows_friction = -1;
  double bound_mismatch = kUnmeasured;
  int islands = -1;
  // The partition.
  int parts_before = -1, parts = -1, max_part_bodies_before = -1, max_part_bodies = -1;
  int cut_pairs_before = -1, cut_pairs = -1, interface_rows_before = -1, interface_rows = -1;
  int interface_bodies_before = -1, interface_bodies = -1, interface_cover_bodies = -1;
  int contiguous_before = -1, contiguous = -1;
  double part_mass_ratio_max = kUnmeasured;
  // The solve.
  int interface_unknowns = -1;
  double factor_mflop_local = kUnmeasured, factor_mflop_interface = kUnmeasured;
  double factor_mflop_done = kUnmeasured;
  double t_collide_ms = kUnmeasured, t_extract_ms = kUnmeasured, t_predict_ms = kUnmeasured,
         t_graph_ms = kUnmeasured;
  double t_partition_ms = kUnmeasured, t_refine_ms = kUnmeasured, t_pr_ms = kUnmeasured;
  double t_s_ms = kUnmeasured, t_s_min_ms = kUnmeasured;
  std::array<double, kStageNames.size()> t_s_stage_ms = filled<kStageNames.size()>();
  double t_s_other_ms = kUnmeasured;
  std::array<double, kModelWorkers.size()> t_s_model_ms = filled<kModelWorkers.size()>();
  double t_s_critical_path_ms = kUnmeasured;
  int iterations = -1, factorizations = -1, fallbacks = -1, refinements = -1;
  int factor_reuses = -1, cg_iterations = -1;
  std::string auto_reason = "-";
  // The verdict.
  double residual_m_per_s = kUnmeasured, residual_bilateral_m_per_s = kUnmeasured;
  double residual_normal_m_per_s = kUnmeasured, residual_friction_m_per_s = kUnmeasured;
  double largest_free_velocity_m_per_s = kUnmeasured, max_penetration_m = kUnmeasured;
  double kinetic_energy_j = kUnmeasured, potential_energy_j = kUnmeasured, energy_excess_j = kUnmeasured;
  std::string problem_hash = "-", solution_hash = "-", state_hash = "-";
  double velocity_spread_m_per_s = kUnmeasured;
  std::string problem_file = "-";
  double joint_drift_m = kUnmeasured, last_body_z_m = kUnmeasured;
  std::string status_reason = "-";
  std::vector<double> measures;  // in the order of cell_measures(); empty where nothing was solved
  double t_s_cpu_ms = kUnmeasured, t_s_waiting_ms = kUnmeasured, t_s_max_ms = kUnmeasured;
  double core_round_trip_ns = kUnmeasured;
  double peak_memory_mb = kUnmeasured;
  double residual_relative = kUnmeasured;
  // The options that can change a cell and have no column above.
  double dt_s = kUnmeasured, cfm = kUnmeasured, erp = kUnmeasured;
  double gravity_m_per_s2 = kUnmeasured, match_tolerance = kUnmeasured;
  int contact_cap = -1;
  int skip_small_islands = -1, cold = -1, session = -1;
  std::string mode = "-", advance = "-", repartition = "-", partition_origin = "-";
  int steps = -1;
  std::string scene_options = "-";
  std::string schema_version = kStepsSchema;
  double factor_predicted_mb = kUnmeasured;
  std::string auto_choice = "-";
  double friction_beyond_share = kUnmeasured;
  std::string body_order = "-", model = "-";
  int model_rows_left_out = -1, model_rows_at_rest = -1, model_rows_returned = -1, model_passes = -1;

  std::string parameter(const std::string& column) const {
    const auto found = parameters.find(column);
    return found == parameters.end() ? "-" : found->second;
  }

  // Adds the values of one algorithm. Where two of a row have a parameter with other values, both are named.
  void add_parameters(const Settings& settings);
  void add_parameter(const std::string& column, const std::string& cell);

  // Parts of a row that are copied from one result each.
  void set_partition_before(const PartitionMetrics& metrics);
  void set_partition(const PartitionMetrics& metrics);
  void set_summary(const SolveSummary& summary);
  void set_verdict(const ResidualReport& report);
  void set_friction(const FrictionMismatch& mismatch);
  void set_model(const ModelCounts& counts);

 private:
  template <std::size_t N>
  static constexpr std::array<double, N> filled() {
    std::array<double, N> values;
    values.fill(kUnmeasured);
    return values;
  }
};

// Calls visitor(column name, member, what it is, ColumnOf, About) for every column in order.
template <class Visitor>
void visit_fields(const StepRecord& r, Visitor&& visitor) {
  const auto visit = [&](std::string_view name, const auto& member, const char* help,
                         About about = About::measured) {
    visitor(name, member, help, ColumnOf::experiment, about);
  };
  const auto visit_machine = [&](std::string_view name, const auto& member, const char* help,
                                 About about = About::measured) {
    visitor(name, member, help, ColumnOf::machine, about);
  };
  visit("run_id", r.run_id,
        "fingerprint of all options but threads, memory-limit, out, force, record-motion and explain-model: "
        "equal experiments have equal ids",
        About::bookkeeping);
  visit("scene", r.scene, "name of the scene", About::bookkeeping);
  visit("seed", r.seed, "seed of the scene's random choices", About::bookkeeping);
  visit("step", r.step, "number of the step, from 0", About::bookkeeping);
  visit("time_s", r.time_s, "simulated time at the start of the step", About::bookkeeping);
  visit("repeat_count", r.repeat_count, "solves of this cell from the same warm start", About::bookkeeping);
  visit("partitioner", r.partitioner, "who grew the parts; - for a solver that ignores parts",
        About::bookkeeping);
  visit("refiner", r.refiner, "who refined the parts", About::bookkeeping);
  visit("solver", r.solver, "name as asked for", About::bookkeeping);
  visit("strategy", r.strategy, "strategy that ran at the end");
  visit("kernel", r.kernel, "kernel that ran at the end");
  visit("friction", r.friction, "friction model", About::problem);
  visit_machine("threads", r.threads, "threads of a solve", About::bookkeeping);
  visit("status", r.status,
        "ok, not_converged, timeout, out_of_memory, diverged, refused, crashed or skipped; ok means solved "
        "and within "
        "the judge's limit",
        About::bookkeeping);
  const auto visit_parameters = [&](ParameterColumn::Place place) {
    for (const ParameterColumn& column : parameter_columns())
      if (column.place == place)
        visit(column.name, r.parameter(column.name), column.help.c_str(), column.about);
  };
  visit_parameters(ParameterColumn::Place::after_status);
  visit("bodies", r.bodies, "dynamic bodies");
  visit("contacts", r.contacts, "contact points");
  visit("contact_cap_hits", r.contact_cap_hits, "geom pairs that reached the contact cap");
  visit("ode_messages", r.ode_messages,
        "messages ODE printed in this step, for ODE's own solvers those of the solve among them");
  visit("rows", r.rows, "constraint rows m");
  visit("rows_bilateral", r.rows_bilateral, "joint rows");
  visit("rows_normal", r.rows_normal, "contact normal rows");
  visit("rows_friction", r.rows_friction, "friction rows");
  visit("bound_mismatch", r.bound_mismatch,
        "sum over friction rows of |bound - mu n| over the sum of mu n, n the normal impulse; nan where no "
        "bound "
        "stands for mu n");
  visit("islands", r.islands, "connected components of the body graph");
  visit("parts_before", r.parts_before, "parts before refinement");
  visit("parts", r.parts, "parts after refinement, as for all columns with a _before beside them");
  visit("max_part_bodies_before", r.max_part_bodies_before, "bodies of the largest part");
  visit("max_part_bodies", r.max_part_bodies, "bodies of the largest part");
  visit("cut_pairs_before", r.cut_pairs_before, "body pairs that are joined across parts");
  visit("cut_pairs", r.cut_pairs, "body pairs that are joined across parts");
  visit("interface_rows_before", r.interface_rows_before, "constraint rows across parts");
  visit("interface_rows", r.interface_rows, "constraint rows across parts");
  visit("interface_bodies_before", r.interface_bodies_before, "bodies with an edge across parts");
  visit("interface_bodies", r.interface_bodies, "bodies with an edge across parts");
  visit("interface_cover_bodies", r.interface_cover_bodies,
        "bodies of a greedy vertex cover of the cut edges");
  visit("contiguous_before", r.contiguous_before, "1 when every part is connected within itself, else 0");
  visit("contiguous", r.contiguous, "1 when every part is connected within itself, else 0");
  visit("part_mass_ratio_max", r.part_mass_ratio_max, "largest heaviest / lightest body within one part");
  visit("interface_unknowns", r.interface_unknowns, "size of the solver's interface system");
  visit("factor_mflop_local", r.factor_mflop_local, "Mflop of one factorisation of all subsystem interiors");
  visit("factor_mflop_interface", r.factor_mflop_interface,
        "Mflop of one factorisation of the interface system");
  visit_machine("t_collide_ms", r.t_collide_ms, "collision detection (once per step)");
  visit_machine("t_extract_ms", r.t_extract_ms, "building the rows (once per step)");
  visit_machine("t_predict_ms", r.t_predict_ms, "predicting the friction bounds (once per step)");
  visit_machine("t_graph_ms", r.t_graph_ms, "building the body graph, median over the repeats");
  visit_machine("t_partition_ms", r.t_partition_ms, "growing the parts, median over the repeats");
  visit_machine("t_refine_ms", r.t_refine_ms, "refining the parts, median over the repeats");
  visit_machine("t_pr_ms", r.t_pr_ms, "growing + refining, median over the repeats");
  visit_machine("t_s_ms", r.t_s_ms,
                "solve, median over the repeats (the lower middle one of an even number)");
  visit_machine("t_s_min_ms", r.t_s_min_ms, "solve, least over the repeats");
  for (std::size_t stage = 0; stage < kStageNames.size(); ++stage)
    visit_machine("t_s_" + std::string(kStageNames[stage]) + "_ms", r.t_s_stage_ms[stage],
                  "stage of the solve that took t_s_ms");
  visit_machine("t_s_other_ms", r.t_s_other_ms, "t_s_ms less its named stages");
  const auto visit_model = [&](std::size_t i) {
    visit_machine("t_s_model_p" + std::to_string(kModelWorkers[i]) + "_ms", r.t_s_model_ms[i],
                  "solve modelled on so many workers from the task times of one-thread runs");
  };
  constexpr std::size_t kFirstModels = 5;  // those of the first tables; the others stand at the end
  for (std::size_t i = 0; i < kFirstModels; ++i) visit_model(i);
  visit("iterations", r.iterations, "iterations of the strategy");
  visit("factorizations", r.factorizations, "numeric factorisations");
  visit("fallbacks", r.fallbacks, "hand-overs from one strategy to the next");
  visit("refinements", r.refinements, "iterative refinement steps");
  visit("auto_reason", r.auto_reason, "why auto chose what ran");
  visit("residual_m_per_s", r.residual_m_per_s, "the judge's residual over all rows");
  visit("residual_bilateral_m_per_s", r.residual_bilateral_m_per_s, "over joint rows");
  visit("residual_normal_m_per_s", r.residual_normal_m_per_s, "over normal rows");
  visit("residual_friction_m_per_s", r.residual_friction_m_per_s, "over friction rows");
  visit("largest_free_velocity_m_per_s", r.largest_free_velocity_m_per_s,
        "largest entry of v0; scales the limit");
  visit("max_penetration_m", r.max_penetration_m,
        "deepest contact at the start of the step, 0 without contacts");
  visit("kinetic_energy_j", r.kinetic_energy_j, "1/2 v^T M v of this row's solution");
  visit("potential_energy_j", r.potential_energy_j, "sum of m g z after the advance");
  visit("energy_excess_j", r.energy_excess_j, "energy gained beyond lambda^T b; an exact step has <= 0");
  visit("problem_hash", r.problem_hash, "FNV-1a-64 of the step problem");
  visit("solution_hash", r.solution_hash, "FNV-1a-64 of impulses and part ids");
  visit("state_hash", r.state_hash, "FNV-1a-64 of all body states after the advance");
  visit("velocity_spread_m_per_s", r.velocity_spread_m_per_s,
        "largest difference between this row's velocities and those that advanced the world");
  visit("problem_file", r.problem_file, "problem file that was recorded or replayed", About::bookkeeping);
  visit("joint_drift_m", r.joint_drift_m, "widest gap of a joint after the advance, 0 without joints");
  visit("last_body_z_m", r.last_body_z_m, "height of the last body's centre after the advance");
  visit("status_reason", r.status_reason, "why the status is not ok, as far as the solver says",
        About::bookkeeping);
  for (std::size_t i = 0; i < cell_measures().size(); ++i)
    visit(cell_measures()[i].name, r.measures.empty() ? kUnmeasured : r.measures[i], cell_measures()[i].help);
  visit_machine("t_s_cpu_ms", r.t_s_cpu_ms, "processor time of all threads in the solve that took t_s_ms");
  visit_machine("t_s_waiting_ms", r.t_s_waiting_ms,
                "time in which threads of that solve were ready to run and had no core, summed over threads");
  visit_machine("t_s_max_ms", r.t_s_max_ms, "solve, greatest over the repeats");
  visit_machine("peak_memory_mb", r.peak_memory_mb, "largest resident set of the process so far, 1e6 bytes");
  visit("residual_relative", r.residual_relative,
        "residual_m_per_s over the largest entry of v0, J v0 and b, in the problem's own units");
  visit("dt_s", r.dt_s, "step h", About::problem);
  visit("cfm", r.cfm, "constraint force mixing; compliance C = cfm / h", About::problem);
  visit("erp", r.erp, "share of a position error removed per step", About::problem);
  visit("gravity_m_per_s2", r.gravity_m_per_s2, "gravity along -z", About::problem);
  visit(
      "match_tolerance", r.match_tolerance,
      "how far a contact may move and still be that of the last step, in least extents of the smaller shape",
      About::problem);
  visit("contact_cap", r.contact_cap, "most contact points of a geom pair", About::problem);
  visit_parameters(ParameterColumn::Place::after_contact_cap);
  visit("skip_small_islands", r.skip_small_islands, "1 where small islands are one part each, else 0",
        About::partition);
  visit("cold", r.cold, "1 where solves start from zero impulses, 0 where from those of the last step",
        About::problem);
  visit("mode", r.mode, "lockstep or separate worlds", About::problem);
  visit("advance", r.advance, "solver that advances the world in lockstep", About::problem);
  visit("steps", r.steps, "steps that were to be simulated", About::bookkeeping);
  visit("scene_options", r.scene_options, "the scene's own options, name=value;name=value", About::problem);
  visit("schema_version", r.schema_version, "what the columns of this row mean", About::bookkeeping);
  for (std::size_t i = kFirstModels; i < kModelWorkers.size(); ++i) visit_model(i);
  visit_machine("t_s_critical_path_ms", r.t_s_critical_path_ms,
                "solve modelled on as many workers as there are tasks");
  visit("factor_predicted_mb", r.factor_predicted_mb,
        "memory of a factor and its workspace as predicted before the factorisation, 1e6 bytes");
  visit("session", r.session, "1 where a solver carries what it can from step to step, else 0",
        About::solver);
  visit("factor_reuses", r.factor_reuses, "systems solved with the factor of another, in a session");
  visit("cg_iterations", r.cg_iterations, "iterations of conjugate gradients with such a factor");
  visit("factor_mflop_done", r.factor_mflop_done,
        "Mflop of all factorisations of the solve, less what was kept of the one before");
  visit_parameters(ParameterColumn::Place::after_factor_mflop_done);
  visit("repartition", r.repartition, "when steps are split anew, as given", About::partition);
  visit("partition_origin", r.partition_origin,
        "fresh, repaired or kept: where the parts of the step come from");
  visit("auto_choice", r.auto_choice,
        "partitioner+refiner/kernel that the partitioner auto chose, the kernel being that of the model");
  visit("friction_beyond_share", r.friction_beyond_share,
        "share of the same friction rows whose |impulse| is above mu n (1 + 1e-9)");
  visit_parameters(ParameterColumn::Place::after_friction_beyond_share);
  visit("body_order", r.body_order, "numbers by which bodies are split, as given", About::partition);
  visit_parameters(ParameterColumn::Place::after_body_order);
  visit("model", r.model, "full: every row is solved; auto: those that can matter", About::solver);
  visit("model_rows_left_out", r.model_rows_left_out, "rows that the first solve left at impulse 0");
  visit("model_rows_at_rest", r.model_rows_at_rest,
        "rows of islands that kept the impulses of the step before in the first solve");
  visit("model_rows_returned", r.model_rows_returned, "rows of both that the judge brought back");
  visit("model_passes", r.model_passes, "solves of the step, one more each time rows came back");
  visit_machine(
      "core_round_trip_ns", r.core_round_trip_ns,
      "time of a number from one thread of that solve to another and back, just before it; nan on one");
  visit_parameters(ParameterColumn::Place::at_end);
}

// "run_id,scene,...\n"
std::string csv_header();

// One line with its "\n". The machine's numbers are printed in the shortest form that reads back unchanged,
// other numbers with 17 significant digits; texts as csv_cell has them.
std::string csv_line(const StepRecord& record);
std::string csv_lines(std::span<const StepRecord> records);

// All of them, in order.
std::vector<Column> columns();

}  // namespace cleave

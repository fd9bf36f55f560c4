// steps.csv: the columns that readers rely on, how values are printed, and that only complete lines are
// written.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>

#include "harness/experiment/step_record.h"
#include "harness/files/csv_recorder.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

// The contract with everything that reads steps.csv: these names in this order; more may follow.
constexpr const char* kContract =
    "run_id,scene,seed,step,time_s,repeat_count,partitioner,refiner,solver,strategy,kernel,friction,threads,"
    "status,"
    "max_bodies,tau_mr,tau_mix,max_growth,bodies,contacts,contact_cap_hits,ode_messages,rows,rows_bilateral,"
    "rows_normal,rows_friction,bound_mismatch,islands,parts_before,parts,max_part_bodies_before,max_part_"
    "bodies,"
    "cut_pairs_before,cut_pairs,interface_rows_before,interface_rows,interface_bodies_before,interface_"
    "bodies,"
    "interface_cover_bodies,contiguous_before,contiguous,part_mass_ratio_max,interface_unknowns,factor_mflop_"
    "local,"
    "factor_mflop_interface,t_collide_ms,t_extract_ms,t_predict_ms,t_graph_ms,t_partition_ms,t_refine_ms,t_"
    "pr_ms,"
    "t_s_ms,t_s_min_ms,t_s_analyze_ms,t_s_predict_ms,t_s_assemble_ms,t_s_factor_local_ms,t_s_form_interface_"
    "ms,"
    "t_s_factor_interface_ms,t_s_solve_ms,t_s_check_ms,t_s_refine_ms,t_s_other_ms,t_s_model_p1_ms,t_s_model_"
    "p2_ms,"
    "t_s_model_p4_ms,t_s_model_p8_ms,t_s_model_p16_ms,iterations,factorizations,fallbacks,refinements,auto_"
    "reason,"
    "residual_m_per_s,residual_bilateral_m_per_s,residual_normal_m_per_s,residual_friction_m_per_s,"
    "largest_free_velocity_m_per_s,max_penetration_m,kinetic_energy_j,potential_energy_j,energy_excess_j,"
    "problem_hash,solution_hash,state_hash";

TEST(Csv, HeaderStartsWithTheContract) {
  const std::string header = csv_header();
  EXPECT_EQ(header.substr(0, std::string(kContract).size()), kContract);
  const char next = header[std::string(kContract).size()];
  EXPECT_TRUE(next == ',' || next == '\n');
  EXPECT_EQ(count_lines(header), 1);
}

// New columns come after those of earlier tables, and after them parameters that came later still.
TEST(Csv, LaterColumnsStandAtTheEnd) {
  std::string end =
      ",schema_version,t_s_model_p32_ms,t_s_model_p64_ms,t_s_critical_path_ms,factor_predicted_mb,"
      "session,factor_reuses,cg_iterations,factor_mflop_done,partition_seed,trials,karger_method,ufactor,"
      "scotch_strategy,effort,patience,merge_small,split,calibration,cost_kernel,cost_threads,lemke_max_rows,"
      "repartition,partition_origin,auto_choice,friction_beyond_share,"
      "restart,body_order,until,order,order_seed,coloring,coloring_seed,"
      "model,model_rows_left_out,model_rows_at_rest,model_rows_returned,model_passes,core_round_trip_ns";
  for (const ParameterColumn& column : parameter_columns())
    if (column.place == ParameterColumn::Place::at_end) end += "," + column.name;
  EXPECT_TRUE(csv_header().ends_with(end + "\n"));
}

TEST(Csv, AParameterThatNobodyListedComesAtTheEnd) {
  std::vector<CommonParameter> parameters(common_parameters().begin(), common_parameters().end());
  CommonParameter later = parameters.front();
  later.parameter.name = "later-one";
  parameters.insert(parameters.begin(), later);
  const std::vector<ParameterColumn> list = columns_of(parameters);
  EXPECT_EQ(list.back().name, "later_one");
  EXPECT_EQ(list.back().place, ParameterColumn::Place::at_end);
  ASSERT_EQ(list.size(), parameter_columns().size() + 1);
  for (std::size_t k = 0; k + 1 < list.size(); ++k) EXPECT_EQ(list[k].name, parameter_columns()[k].name);
}

TEST(Csv, HeaderRowAndColumnListAgree) {
  const CsvTable table = parse_csv(csv_header() + csv_line(StepRecord{}));
  const std::vector<Column> list = columns();
  ASSERT_EQ(table.header.size(), list.size());
  ASSERT_EQ(table.rows.at(0).size(), list.size());
  std::set<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    EXPECT_EQ(table.header[i], list[i].name);
    EXPECT_FALSE(list[i].help.empty()) << list[i].name;
    EXPECT_TRUE(names.insert(list[i].name).second) << "twice: " << list[i].name;
  }
}

// A number nobody measured must not pass for zero.
TEST(Csv, FreshRecordHoldsNoZeroButTheSeed) {
  const CsvTable table = parse_csv(csv_header() + csv_line(StepRecord{}));
  for (const std::string& name : table.header) {
    if (name == "seed" || name == "schema_version") continue;
    const std::string& cell = table.at(0, name);
    const bool unmeasured = cell == "nan" || cell == "-1" || cell == "-" || cell == "skipped";
    EXPECT_TRUE(unmeasured) << name << " is " << cell;
  }
}

// What the documents say may differ between two runs of the same experiment, and nothing else.
TEST(Csv, TheMachinesColumnsAreTimesThreadsAndMemory) {
  for (const Column& column : columns())
    EXPECT_EQ(column.machine, column.name.starts_with("t_") || column.name == "threads" ||
                                  column.name == "core_round_trip_ns" || column.name == "peak_memory_mb")
        << column.name;
}

TEST(Csv, ASolveWithoutResultMeasuredNothing) {
  SolveSummary summary;
  summary.message = "why";
  summary.times.total_ms = 3;  // until it crashed
  const std::string fresh = csv_line(StepRecord{});
  for (const SolveStatus status : {SolveStatus::refused, SolveStatus::crashed, SolveStatus::out_of_memory}) {
    summary.status = status;
    StepRecord record;
    record.set_summary(summary);
    EXPECT_EQ(csv_line(record), fresh) << to_string(status);
  }
  summary.status = SolveStatus::not_converged;
  StepRecord record;
  record.set_summary(summary);
  EXPECT_EQ(record.t_s_ms, 3);
  EXPECT_EQ(record.factorizations, 0);
}

TEST(Csv, NumbersReadBackUnchanged) {
  const std::vector<double> values = {
      0.1, 1.0 / 3, 1e-300, 5e-324, 1.7976931348623157e308, 123456789.123456789, -2.5, 0.0};
  for (const double value : values) {
    StepRecord record;
    record.residual_m_per_s = value;
    record.t_s_ms = value;
    const CsvTable table = parse_csv(csv_header() + csv_line(record));
    EXPECT_EQ(std::strtod(table.at(0, "residual_m_per_s").c_str(), nullptr), value);
    EXPECT_EQ(std::strtod(table.at(0, "t_s_ms").c_str(), nullptr), value);
  }
}

TEST(Csv, TimesAreShortStateIsLong) {
  StepRecord record;
  record.t_s_ms = 0.1;
  record.kinetic_energy_j = 0.1;
  record.seed = 18446744073709551615u;
  const CsvTable table = parse_csv(csv_header() + csv_line(record));
  EXPECT_EQ(table.at(0, "t_s_ms"), "0.1");
  EXPECT_EQ(table.at(0, "kinetic_energy_j"), "0.10000000000000001");
  EXPECT_EQ(table.at(0, "seed"), "18446744073709551615");
}

TEST(Csv, NotANumberHasOneSpelling) {
  StepRecord record;
  record.residual_m_per_s = -std::nan("");
  record.energy_excess_j = -INFINITY;
  const CsvTable table = parse_csv(csv_header() + csv_line(record));
  EXPECT_EQ(table.at(0, "residual_m_per_s"), "nan");
  EXPECT_EQ(table.at(0, "energy_excess_j"), "-inf");
}

TEST(Csv, TextWithCommaAndQuoteIsQuoted) {
  StepRecord record;
  record.auto_reason = "stiff, \"redundant\"";
  const std::string line = csv_line(record);
  EXPECT_NE(line.find("\"stiff, \"\"redundant\"\"\""), std::string::npos) << line;
  EXPECT_EQ(parse_csv(csv_header() + line).rows.at(0).size(), columns().size());
}

TEST(Csv, StageTimesAndRestAddUpToTheTotal) {
  SolveSummary summary;
  summary.times.total_ms = 10;
  for (std::size_t i = 0; i < summary.times.stage_ms.size(); ++i)
    summary.times.stage_ms[i] = 0.5 * (i + 1.0) / 9;
  StepRecord record;
  record.set_summary(summary);
  double sum = record.t_s_other_ms;
  for (const double stage : record.t_s_stage_ms) sum += stage;
  EXPECT_NEAR(sum, record.t_s_ms, 1e-12);
}

TEST(CsvRecorder, WritesEachStepAtOnce) {
  const TemporaryDirectory directory;
  CsvRecorder recorder(directory / "steps.csv", csv_header());
  EXPECT_EQ(read_text(directory / "steps.csv"), csv_header());
  std::vector<StepRecord> rows(3);
  for (int step = 0; step < 4; ++step) {
    for (StepRecord& row : rows) row.step = step;
    recorder.append(csv_lines(rows));
    const CsvTable table = read_csv(directory / "steps.csv");  // while the recorder is still open
    ASSERT_EQ(table.rows.size(), 3u * (step + 1));
    EXPECT_EQ(table.at(table.rows.size() - 1, "step"), std::to_string(step));
  }
  recorder.append("");
  EXPECT_EQ(count_lines(read_text(directory / "steps.csv")), 13);
}

TEST(CsvRecorder, NamesTheFileItCannotWrite) {
  try {
    CsvRecorder recorder("/nowhere/at/all/steps.csv", csv_header());
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/at/all/steps.csv"), std::string::npos);
  }
  EXPECT_THROW(CsvRecorder("/dev/full", csv_header()), std::runtime_error);
}

}  // namespace
}  // namespace cleave

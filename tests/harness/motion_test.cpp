// motion.h5: that it holds what was simulated, changes nothing else, and can be read whatever ends the run.
#include "harness/commands/motion_recorder.h"

#include <gtest/gtest.h>
#include <malloc.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "harness/experiment/body_marks.h"
#include "harness/experiment/simulation.h"
#include "harness/files/csv_recorder.h"
#include "harness/files/hdf5_reader.h"
#include "harness/files/hdf5_writer.h"
#include "solver/residual.h"
#include "tests/harness/machine_columns.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

using Pair = std::pair<int, int>;

constexpr int kSteps = 37;  // no multiple of what is written at once

// One step as the simulation had it.
struct Seen {
  int step = -1;
  std::vector<BodyState> states;
  StepProblem problem;
  std::vector<StepRecord> rows;
  std::vector<Outcome> outcomes;
};

struct Recorded {
  TemporaryDirectory directory;
  std::vector<Seen> seen;
  std::filesystem::path path() const { return directory / "motion.h5"; }
};

void simulate_and_record(const RunOptions& options, Recorded& recorded) {
  const std::atomic<bool> stop = false;
  MotionRecorder motion(recorded.path(), options);
  const auto observe = [&](const ObservedStep& step) {
    motion.record(step);
    const OdeWorld& world = *step.context.world;
    Seen seen{step.step,
              {},
              step.problem,
              {step.rows.begin(), step.rows.end()},
              {step.outcomes.begin(), step.outcomes.end()}};
    for (int i = 0; i < world.body_count(); ++i) seen.states.push_back(world.state(i));
    recorded.seen.push_back(seen);
  };
  Simulation simulation(options, stop, observe);
  simulation.run([](std::span<const StepRecord>) {}, [](int, int) {});
  motion.finish();
}

RunOptions pile_options(const std::string& measure_every) {
  return parse_run_options({{"scene", "rock_pile"},
                            {"bodies", "14"},
                            {"steps", std::to_string(kSteps)},
                            {"measure-every", measure_every},
                            {"repeats", "1"},
                            {"max-bodies", "4"},
                            {"partitioner", "mix,bfs"},
                            {"refiner", "none,fm"},
                            {"solver", "schur,pgs"},
                            {"out", "unused"}});
}

// The pile has fallen and lies in several parts before the last step.
void record_pile(const std::string& measure_every, Recorded& recorded) {
  RunOptions options = pile_options(measure_every);
  options.gravity_m_per_s2 = 200;
  simulate_and_record(options, recorded);
}

template <class Number>
std::vector<Number> read(const Hdf5Reader& reader, const std::string& name, const Hdf5Shape& shape) {
  std::vector<Number> values;
  reader.array(name, shape, values);
  return values;
}

std::vector<Seen> measured_of(const std::vector<Seen>& seen) {
  std::vector<Seen> measured;
  for (const Seen& step : seen)
    if (!step.rows.empty()) measured.push_back(step);
  return measured;
}

// Pairs of bodies that share a row, straight from the rows.
std::set<Pair> pairs_of(const StepProblem& problem) {
  std::set<Pair> pairs;
  for (int r = 0; r < problem.row_count(); ++r) {
    const auto [a, b] = std::minmax(problem.row_body[2 * r], problem.row_body[2 * r + 1]);
    if (a >= 0) pairs.emplace(a, b);
  }
  return pairs;
}

// Largest |value| of the rows that name a body.
double largest_at(const StepProblem& problem, std::span<const double> of_row, int body) {
  double largest = 0;
  for (int r = 0; r < problem.row_count(); ++r)
    if (problem.row_body[2 * r] == body || problem.row_body[2 * r + 1] == body)
      largest = std::max(largest, std::abs(of_row[r]));
  return largest;
}

TEST(Motion, HoldsThePosesOfEveryStep) {
  Recorded recorded;
  record_pile("5", recorded);
  const Hdf5Reader reader(recorded.path());
  const std::size_t s = kSteps, n = 14;
  const auto step = read<int>(reader, "step", {s});
  const auto position = read<float>(reader, "position", {s, n, 3});
  const auto orientation = read<float>(reader, "orientation", {s, n, 4});
  ASSERT_EQ(recorded.seen.size(), s);
  for (std::size_t i = 0; i < s; ++i) {
    EXPECT_EQ(step[i], recorded.seen[i].step);
    for (std::size_t body = 0; body < n; ++body) {
      const BodyState& state = recorded.seen[i].states[body];
      for (int k = 0; k < 3; ++k)
        EXPECT_EQ(position[3 * (n * i + body) + k], static_cast<float>(state.position_m[k]));
      for (int k = 0; k < 4; ++k)
        EXPECT_EQ(orientation[4 * (n * i + body) + k], static_cast<float>(state.orientation[k]));
    }
  }
}

TEST(Motion, HoldsTheGraphOfEveryMeasuredStep) {
  for (const std::string measure_every : {"1", "5"}) {
    SCOPED_TRACE(measure_every);
    Recorded recorded;
    record_pile(measure_every, recorded);
    const std::vector<Seen> measured = measured_of(recorded.seen);
    const Hdf5Reader reader(recorded.path());
    const Hdf5Reader group = reader.group("measured");
    const std::size_t k = measured.size();
    const auto step = read<int>(group, "step", {k});
    const auto count = read<int>(group, "edge_count", {k});
    const auto edge = read<std::uint16_t>(group, "edge", {group.length("edge"), 2});
    std::size_t at = 0, most = 0;
    for (std::size_t i = 0; i < k; ++i) {
      EXPECT_EQ(step[i], measured[i].step);
      std::set<Pair> pairs;
      for (int e = 0; e < count[i]; ++e, ++at) pairs.emplace(edge[2 * at], edge[2 * at + 1]);
      EXPECT_EQ(pairs, pairs_of(measured[i].problem));
      most = std::max(most, pairs.size());
    }
    EXPECT_EQ(2 * at, edge.size());
    EXPECT_GT(most, 8u) << "nothing touches, so nothing was tested";
  }
}

// The marks of one combination of one measured step against the rows of its problem.
struct Cell {
  std::span<const std::uint16_t> part;
  std::span<const std::uint8_t> interface;
  std::span<const float> residual, impulse;
};

void expect_marks(const Cell& cell, const StepProblem& problem, const Outcome& outcome,
                  const StepRecord& row) {
  const std::vector<double> residuals = row_residuals(problem, outcome.solution.impulse);
  std::set<int> cut;
  for (const auto& [a, b] : pairs_of(problem)) {
    if (cell.part[a] != cell.part[b]) cut.insert({a, b});
  }
  double worst = 0;
  for (int body = 0; body < problem.body_count(); ++body) {
    const bool has_parts = !outcome.parts.part_of_body.empty();
    EXPECT_EQ(cell.part[body], has_parts ? outcome.parts.part_of_body[body] : kNoPart);
    EXPECT_EQ(cell.interface[body], cut.contains(body));
    const double residual = largest_at(problem, residuals, body);
    const double impulse = largest_at(problem, outcome.solution.impulse, body);
    EXPECT_NEAR(cell.residual[body], residual, residual / 2048);
    EXPECT_NEAR(cell.impulse[body], impulse, impulse / 2048);
    worst = std::max(worst, residual);
  }
  EXPECT_EQ(worst, row.residual_m_per_s);  // the judge's word
}

TEST(Motion, HoldsWhatEveryCombinationMadeOfTheStep) {
  Recorded recorded;
  record_pile("4", recorded);
  const std::vector<Seen> measured = measured_of(recorded.seen);
  const Hdf5Reader reader(recorded.path());
  const Hdf5Reader group = reader.group("measured");
  const std::size_t k = measured.size(), n = 14, c = measured.front().rows.size();
  ASSERT_EQ(c, 5u);  // two partitioners by two refiners, and pgs, which has no parts
  const auto part = read<std::uint16_t>(group, "part", {k, c, n});
  const auto interface = read<std::uint8_t>(group, "interface", {k, c, n});
  const auto residual = read<float>(group, "residual_m_per_s", {k, c, n});
  const auto impulse = read<float>(group, "largest_impulse_n_s", {k, c, n});
  const auto t_s_ms = read<float>(group, "t_s_ms", {k, c});
  const auto rows = read<int>(group, "interface_rows", {k, c});
  const auto ok = read<std::uint8_t>(group, "ok", {k, c});
  bool any_cut = false, any_failed = false;
  for (std::size_t i = 0; i < k; ++i) {
    for (std::size_t j = 0; j < c; ++j) {
      const std::size_t cell = i * c + j;
      const auto of = [&](const auto& values) { return std::span(values).subspan(cell * n, n); };
      const StepRecord& row = measured[i].rows[j];
      expect_marks({of(part), of(interface), of(residual), of(impulse)}, measured[i].problem,
                   measured[i].outcomes[j], row);
      EXPECT_EQ(t_s_ms[cell], static_cast<float>(row.t_s_ms));
      EXPECT_EQ(rows[cell], row.interface_rows);
      EXPECT_EQ(ok[cell], row.status == "ok");
      any_cut |= row.interface_rows > 0;
      any_failed |= row.status != "ok";
    }
  }
  EXPECT_TRUE(any_cut && any_failed) << "nothing of interest happened, so nothing was tested";
}

TEST(Motion, ChangesNothingElse) {
  const TemporaryDirectory directory;
  const Arguments run = {"run",     "--scene",         "log_tower", "--layers",  "3", "--steps", "20",
                         "--force", "--measure-every", "3",         "--repeats", "1", "--out"};
  const auto cells = [&](const std::string& name, const Arguments& more) {
    Arguments arguments = run;
    arguments.push_back(directory / name);
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_cleave(arguments).exit_code, 0);
    const CsvTable table = read_csv(directory / name / "steps.csv");
    std::map<std::string, std::vector<std::string>> columns;
    for (const std::string& column : table.header)
      if (!is_of_the_machine(column)) columns[column] = table.column(column);
    return columns;
  };
  EXPECT_EQ(cells("with", {"--record-motion"}), cells("without", {}));
  EXPECT_TRUE(std::filesystem::exists(directory / "with/motion.h5"));
  EXPECT_FALSE(std::filesystem::exists(directory / "without/motion.h5"));
  cells("with", {});
  EXPECT_FALSE(std::filesystem::exists(directory / "with/motion.h5")) << "that of another run was left";
}

TEST(Motion, IsRefusedWhereItMeansNothing) {
  const TemporaryDirectory directory;
  const Arguments run = {"run",     "--scene", "chain_drop",      "--links", "3",
                         "--steps", "2",       "--record-motion", "--out"};
  const auto refused = [&](const Arguments& more, const std::string& words) {
    Arguments arguments = run;
    arguments.push_back(directory / "out");
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run_cleave(arguments);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    EXPECT_EQ(count_lines(result.err), 1);
  };
  refused({"--mode", "separate"}, "--record-motion: records one world");
  std::filesystem::create_directory(directory / "out");
  Hdf5Writer(directory / "out/motion.h5").close();
  refused({}, "already holds motion.h5");
}

// A run that would take very long, ended by a signal as soon as so much of it is on disk.
struct Ended {
  TemporaryDirectory directory;
  int exit_code = -1;
  std::filesystem::path path() const { return directory / "out/motion.h5"; }
  std::filesystem::path part() const { return directory / "out/motion.h5.part"; }
};

void end_by(int signal, std::uintmax_t bytes, Ended& ended) {
  const pid_t process = start_cleave({"run", "--scene", "rock_pile", "--bodies", "20", "--partitioner", "mix",
                                      "--refiner", "fm", "--repeats", "1", "--steps", "1000000",
                                      "--record-motion", "--out", ended.directory / "out"});
  std::error_code error;
  for (int waited = 0; waited < 30000; ++waited) {
    const auto size = std::filesystem::file_size(ended.part(), error);
    if (!error && size >= bytes) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ::kill(process, signal);
  ended.exit_code = finish_cleave(process);
  ASSERT_FALSE(error) << "motion.h5.part was never written";
}

std::size_t length_of(const Hdf5Handle& file, const std::string& name) {
  const Hdf5Handle dataset(H5Dopen2(file.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(H5Dget_space(dataset.id()), H5Sclose);
  std::vector<hsize_t> extents(H5Sget_simple_extent_ndims(space.id()));
  H5Sget_simple_extent_dims(space.id(), extents.data(), nullptr);
  return extents.at(0);
}

TEST(Motion, CanBeReadAfterTheRunWasKilled) {
  for (int attempt = 0; attempt < 3; ++attempt) {
    Ended ended;
    end_by(SIGKILL, 200000, ended);
    EXPECT_EQ(ended.exit_code, 128 + SIGKILL);
    EXPECT_FALSE(std::filesystem::exists(ended.path()));
    const Hdf5Handle file(H5Fopen(ended.part().c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, H5P_DEFAULT),
                          H5Fclose);
    ASSERT_TRUE(file.valid());
    const std::size_t steps = length_of(file, "step");
    EXPECT_GE(steps, 16u);
    EXPECT_GE(length_of(file, "position"), steps);
    EXPECT_GE(length_of(file, "measured/part"), length_of(file, "measured/step"));
    const Hdf5Handle dataset(H5Dopen2(file.id(), "orientation", H5P_DEFAULT), H5Dclose);
    std::vector<float> orientation(length_of(file, "orientation") * 20 * 4);
    ASSERT_GE(H5Dread(dataset.id(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, orientation.data()), 0);
    for (std::size_t i = 0; i < steps * 20; ++i) {
      double squared = 0;
      for (int k = 0; k < 4; ++k) squared += std::pow(orientation[4 * i + k], 2);
      ASSERT_NEAR(squared, 1, 1e-5) << "body pose " << i << " of " << steps * 20;
    }
  }
}

// However early: what bears the name is a whole file.
TEST(Motion, KilledAtOnceLeavesNothingUnderItsName) {
  Ended ended;
  end_by(SIGKILL, 0, ended);
  EXPECT_EQ(ended.exit_code, 128 + SIGKILL);
  EXPECT_FALSE(std::filesystem::exists(ended.path()));
}

// Of the steps that are on disk nothing stays in memory.
TEST(Motion, MemoryDoesNotGrowWithTheSteps) {
  constexpr int kBodies = 40, kWarmUp = 500, kMeasured = 2000;
  const TemporaryDirectory directory;
  MotionSetup setup;
  setup.labels = {"mix+fm+schur"};
  setup.mass_kg.assign(kBodies, 1.0);
  MotionFile file(directory / "motion.h5", setup);
  std::mt19937_64 random(3);  // what compresses badly
  std::size_t before = 0;
  for (int step = 0; step < kWarmUp + kMeasured; ++step) {
    if (step == kWarmUp) before = ::mallinfo2().uordblks;
    std::vector<MotionPose> poses(kBodies);
    for (MotionPose& pose : poses)
      for (double& value : pose.position_m) value = static_cast<double>(random());
    file.add_poses(step, poses);
    file.end_step();
  }
  const std::size_t after = ::mallinfo2().uordblks;
  EXPECT_LT(after, before + 64 * kMeasured) << after - std::min(before, after) << " bytes more";
  file.publish();
}

TEST(Motion, AnInterruptedRunLeavesAFinishedFile) {
  Ended ended;
  end_by(SIGINT, 200000, ended);
  EXPECT_EQ(ended.exit_code, 130);
  EXPECT_FALSE(std::filesystem::exists(ended.part()));
  const Hdf5Reader reader(ended.path());  // in the ordinary mode
  EXPECT_EQ(reader.length("position"), reader.length("step"));
  const std::size_t rows = read_csv(ended.directory / "out/steps.csv").rows.size();
  EXPECT_EQ(reader.group("measured").length("step"), rows);  // one combination
}

TEST(BodyMarks, RoundingKeeps11BitsAndWhatIsNoNumber) {
  const unsigned seed = 5;
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  for (int i = 0; i < 10000; ++i) {
    const double mantissa = 1 + static_cast<double>(random() >> 12) / 4503599627370496.0;
    const double value = std::ldexp(mantissa, static_cast<int>(random() % 200) - 100);
    const float rounded = round_to_11_bits(value);
    EXPECT_NEAR(rounded, value, value / 2048);
    EXPECT_EQ(round_to_11_bits(rounded), rounded);
    int exponent = 0;
    const double scaled = std::ldexp(std::frexp(rounded, &exponent), 11);
    EXPECT_EQ(scaled, std::floor(scaled));
  }
  EXPECT_EQ(round_to_11_bits(0), 0);
  EXPECT_TRUE(std::isnan(round_to_11_bits(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(std::isinf(round_to_11_bits(std::numeric_limits<double>::infinity())));
}

TEST(BodyMarks, ASolutionThatIsNoNumberMarksTheBodiesItTouches) {
  Recorded recorded;
  record_pile("4", recorded);
  const StepProblem& problem = recorded.seen.back().problem;
  std::vector<double> impulse(problem.row_count(), 0.0);
  ASSERT_GT(impulse.size(), 0u);
  impulse[0] = std::numeric_limits<double>::quiet_NaN();
  const BodyMarks marks = mark_bodies(problem, BodyGraph(), {}, impulse);
  EXPECT_TRUE(std::isnan(marks.residual_m_per_s[problem.row_body[0]]));
  for (int body = 0; body < problem.body_count(); ++body) {
    EXPECT_EQ(std::isnan(marks.largest_impulse_n_s[body]),
              body == problem.row_body[0] || body == problem.row_body[1]);
  }
}

}  // namespace
}  // namespace cleave

// What is written to a problem file is what is read from it, to the last bit.
#include "harness/files/problem_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "harness/base/hash.h"
#include "solver/problem_hash.h"
#include "tests/harness/problem_file_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Every array of `a` has the bits of the same array of `b`.
void expect_same_arrays(const ProblemFile& a, const ProblemFile& b) {
  std::vector<std::string> of_a;
  const auto bits = [](std::vector<std::string>& into) {
    return [&into](const std::string& name, const auto& values, const Hdf5Shape& shape, Presence) {
      using Number = typename std::decay_t<decltype(values)>::value_type;
      const std::string bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number));
      into.push_back(name + hdf5_shape_text(shape) + bytes);
    };
  };
  std::vector<std::string> of_b;
  visit_arrays(a, a.problem.body_count(), a.problem.row_count(), bits(of_a));
  visit_arrays(b, b.problem.body_count(), b.problem.row_count(), bits(of_b));
  ASSERT_EQ(of_a.size(), of_b.size());
  for (std::size_t i = 0; i < of_a.size(); ++i)
    EXPECT_TRUE(of_a[i] == of_b[i]) << of_a[i].substr(0, of_a[i].find(')') + 1);
}

void expect_same_attributes(const ProblemFile& a, const ProblemFile& b) {
  EXPECT_EQ(a.scene, b.scene);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.problem.h_s, b.problem.h_s);
  EXPECT_EQ(a.friction_model, b.friction_model);
  EXPECT_EQ(a.erp, b.erp);
  EXPECT_EQ(a.cfm, b.cfm);
}

ProblemFile write_and_read(const ProblemFile& file) {
  const TemporaryDirectory directory;
  write_problem_file(directory / "problem.h5", file);
  return read_problem_file(directory / "problem.h5");
}

TEST(ProblemFile, RoundTripKeepsEveryBit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ProblemFile file = sample_file(static_cast<int>(1 + seed % 7), seed);
    // What text formats and careless conversions lose.
    file.problem.rhs[0] = -0.0;
    file.problem.warm_impulse[0] = std::numeric_limits<double>::denorm_min();
    file.problem.contact_point[0] = std::nextafter(1.0, 2.0);
    file.position[0] = -1.7976931348623157e308;
    const ProblemFile read = write_and_read(file);
    expect_same_attributes(file, read);
    expect_same_arrays(file, read);
    EXPECT_EQ(problem_hash(file.problem), problem_hash(read.problem));
    EXPECT_EQ(file.body_group, read.body_group);
    EXPECT_TRUE(file.shapes == read.shapes);
  }
}

TEST(ProblemFile, RoundTripKeepsSetsOfContacts) {
  for (const int bodies : {1, 5}) {
    ProblemFile file = sample_file(bodies);
    EXPECT_TRUE(write_and_read(file).problem.contact_set.empty());
    give_sample_sets(file.problem);
    const ProblemFile read = write_and_read(file);
    EXPECT_TRUE(read.is_checked);
    EXPECT_EQ(read.problem.contact_set, file.problem.contact_set);
    expect_same_arrays(file, read);
    EXPECT_EQ(problem_hash(file.problem), problem_hash(read.problem));
  }
}

// What has no sets is a file that a program from before them reads.
TEST(ProblemFile, SchemaIsTheFirstThatHoldsIt) {
  const TemporaryDirectory directory;
  ProblemFile file = sample_file();
  const auto holds = [&](const std::string& text) {
    write_problem_file(directory / "a.h5", file);
    return read_text(directory / "a.h5").find(text) != std::string::npos;
  };
  EXPECT_TRUE(holds("cleave-problem-1"));
  EXPECT_FALSE(holds("contact_set"));
  give_sample_sets(file.problem);
  EXPECT_TRUE(holds("cleave-problem-2"));
  EXPECT_FALSE(holds("cleave-problem-1"));
}

TEST(ProblemFile, RoundTripKeepsSolutionsAndPartitions) {
  ProblemFile file = sample_file();
  StoredSolution diverged = file.solutions.begin()->second;
  diverged.partitioner = diverged.refiner = "-";
  diverged.solver = "interior-point:monolithic";
  diverged.residual_m_per_s = std::nan("");
  diverged.impulse[2] = std::numeric_limits<double>::infinity();
  diverged.velocity[3] = std::nan("");
  file.solutions["-+-+interior-point:monolithic"] = diverged;
  const ProblemFile read = write_and_read(file);

  ASSERT_EQ(read.solutions.size(), 2u);
  for (const auto& [label, solution] : file.solutions) {
    const StoredSolution& other = read.solutions.at(label);
    EXPECT_EQ(solution.solver, other.solver);
    EXPECT_EQ(solution.strategy, other.strategy);
    EXPECT_EQ(solution.kernel, other.kernel);
    EXPECT_EQ(solution.partitioner, other.partitioner);
    EXPECT_EQ(solution.refiner, other.refiner);
    EXPECT_TRUE(same_bits<double>({solution.residual_m_per_s}, {other.residual_m_per_s}));
    EXPECT_TRUE(same_bits(solution.impulse, other.impulse));
    EXPECT_TRUE(same_bits(solution.velocity, other.velocity));
  }
  const StoredPartition& a = file.partitions.at("mix+fm+schur");
  const StoredPartition& b = read.partitions.at("mix+fm+schur");
  EXPECT_EQ(a.partitioner, b.partitioner);
  EXPECT_EQ(a.refiner, b.refiner);
  EXPECT_EQ(a.part_of_body, b.part_of_body);
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  for (std::size_t i = 0; i < a.parameters.size(); ++i) {
    EXPECT_EQ(a.parameters[i].name, b.parameters[i].name);
    EXPECT_EQ(a.parameters[i].kind, b.parameters[i].kind) << a.parameters[i].name;
    EXPECT_EQ(a.parameters[i].text, b.parameters[i].text) << a.parameters[i].name;
  }
}

TEST(ProblemFile, StepWithoutRowsOrBodies) {
  ProblemFile no_rows = sample_file(3);
  StepProblem bodies_only;
  bodies_only.h_s = no_rows.problem.h_s;
  bodies_only.mass = no_rows.problem.mass;
  bodies_only.free_velocity = no_rows.problem.free_velocity;
  no_rows.problem = bodies_only;
  no_rows.solutions.clear();
  no_rows.partitions.clear();
  ProblemFile read = write_and_read(no_rows);
  expect_same_arrays(no_rows, read);
  EXPECT_EQ(read.problem.row_count(), 0);

  ProblemFile nothing;
  nothing.problem.h_s = 0.01;
  nothing.friction_model = "none";
  read = write_and_read(nothing);
  EXPECT_EQ(read.problem.body_count(), 0);
  EXPECT_FALSE(read.body_group || read.shapes);
  EXPECT_TRUE(read.solutions.empty() && read.partitions.empty());
}

// So that two recordings of one experiment can be compared with cmp.
TEST(ProblemFile, EqualContentsAreEqualBytes) {
  const TemporaryDirectory directory;
  write_problem_file(directory / "a.h5", sample_file());
  write_problem_file(directory / "b.h5", sample_file());
  EXPECT_TRUE(read_text(directory / "a.h5") == read_text(directory / "b.h5"));
  write_problem_file(directory / "b.h5", sample_file(5, 2));  // and the comparison sees a difference
  EXPECT_FALSE(read_text(directory / "a.h5") == read_text(directory / "b.h5"));
}

TEST(ProblemFile, NumbersLieLittleEndian) {
  const TemporaryDirectory directory;
  write_problem_file(directory / "a.h5", sample_file());
  const Hdf5Handle file(H5Fopen((directory / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const auto type_is = [&file](const char* name, hid_t type) {
    const Hdf5Handle dataset(H5Dopen2(file.id(), name, H5P_DEFAULT), H5Dclose);
    const Hdf5Handle stored(H5Dget_type(dataset.id()), H5Tclose);
    return H5Tequal(stored.id(), type) > 0;
  };
  EXPECT_TRUE(type_is("jacobian", H5T_IEEE_F64LE));
  EXPECT_TRUE(type_is("row_body", H5T_STD_I32LE));
  EXPECT_TRUE(type_is("row_kind", H5T_STD_U8LE));
  EXPECT_TRUE(type_is("solution/mix+fm+schur/impulse", H5T_IEEE_F64LE));
}

// Files of other programs: the other byte order, texts of fixed length, integers of another width.
TEST(ProblemFile, ReadsWhatOthersMayWrite) {
  const TemporaryDirectory directory;
  const ProblemFile file = sample_file();
  write_unchecked(directory / "a.h5", file, [](const Hdf5Writer&, const std::string& name) {
    return name == "rhs" || name == "scene" || name == "step" || name == "erp";
  });
  const Hdf5Handle open(H5Fopen((directory / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const hsize_t rows = file.problem.rhs.size();
  const Hdf5Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose);
  const Hdf5Handle rhs(
      H5Dcreate2(open.id(), "rhs", H5T_IEEE_F64BE, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  H5Dwrite(rhs.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, file.problem.rhs.data());
  const Hdf5Handle one(H5Screate(H5S_SCALAR), H5Sclose);
  const auto attribute = [&](const char* name, hid_t file_type, hid_t memory_type, const void* value) {
    const Hdf5Handle handle(H5Acreate2(open.id(), name, file_type, one.id(), H5P_DEFAULT, H5P_DEFAULT),
                            H5Aclose);
    H5Awrite(handle.id(), memory_type, value);
  };
  const Hdf5Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(text.id(), 9);
  const long long step = 17, erp = 1;
  attribute("scene", text.id(), text.id(), "rock_pile");  // fills its nine characters, so no zero at the end
  attribute("step", H5T_STD_I64BE, H5T_NATIVE_LLONG, &step);
  attribute("erp", H5T_STD_I64LE, H5T_NATIVE_LLONG, &erp);

  const ProblemFile read = read_problem_file(directory / "a.h5");
  expect_same_arrays(file, read);
  EXPECT_EQ(read.scene, "rock_pile");
  EXPECT_EQ(read.step, 17);
  EXPECT_EQ(read.erp, 1);
}

// What may be left out means what the page says. The sample has joint rows, then normal and friction row of
// every contact.
TEST(ProblemFile, WhatIsLeftOutHasItsDefault) {
  const TemporaryDirectory directory;
  ProblemFile file = sample_file();
  const auto is_optional = [&](const std::string& name) {
    bool found = false;
    visit_attributes(file, [&](const std::string& other, auto&, Presence presence) {
      found |= other == name && presence == Presence::optional;
    });
    visit_arrays(file, 0, 0, [&](const std::string& other, auto&, const Hdf5Shape&, Presence presence) {
      found |= other == name && presence == Presence::optional;
    });
    return found && !name.starts_with("friction_row") && name != "friction_coefficient";
  };
  write_unchecked(directory / "a.h5", file,
                  [&](const Hdf5Writer&, const std::string& name) { return is_optional(name); });
  const ProblemFile read = read_problem_file(directory / "a.h5");
  EXPECT_EQ(read.scene, "-");
  EXPECT_EQ(read.step, 0);
  EXPECT_EQ(read.seed, 0u);
  EXPECT_EQ(read.friction_model, "-");
  EXPECT_EQ(read.erp, 0);
  EXPECT_EQ(read.cfm, 0);
  EXPECT_EQ(read.problem.row_kind, file.problem.row_kind);
  EXPECT_EQ(read.problem.row_constraint, (std::vector<int>{0, 1, 2, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8}));
  EXPECT_EQ(read.problem.contact_point, std::vector<double>(3 * 14));
  EXPECT_EQ(read.problem.warm_impulse, std::vector<double>(14));
  EXPECT_EQ(read.position, std::vector<double>(3 * 5));
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(read.orientation[i], i % 4 == 0 ? 1 : 0) << i;
  EXPECT_EQ(read.problem.jacobian, file.problem.jacobian);
}

// Two joint rows of one joint, a joint to the next body, two contacts of one pair: five constraints.
TEST(ProblemFile, ConstraintsThatAreLeftOutAreToldByBodiesAndKinds) {
  const TemporaryDirectory directory;
  ProblemFile file = sample_file(3);
  StepProblem& p = file.problem;
  p.row_body = {0, 1, 0, 1, 1, 2, 1, 2, 1, 2, 1, 2, 1, 2, 2, -1};
  const auto J = RowKind::bilateral, N = RowKind::normal, F = RowKind::friction;
  p.row_kind = {J, J, J, N, F, N, F, J};
  p.friction_row = {-1, -1, -1, -1, 3, -1, 5, -1};
  p.friction_coefficient = {0, 0, 0, 0, 0.5, 0, 0.5, 0};
  for (std::vector<double>* array : {&p.lower, &p.upper, &p.rhs, &p.compliance, &p.warm_impulse})
    array->assign(8, 0.0);
  p.upper.assign(8, 1.0);
  p.jacobian.resize(96);
  p.contact_point.resize(24);
  write_unchecked(directory / "a.h5", file,
                  [](const Hdf5Writer&, const std::string& name) { return name == "row_constraint"; });
  EXPECT_EQ(read_problem_file(directory / "a.h5").problem.row_constraint,
            (std::vector<int>{0, 0, 1, 2, 2, 3, 3, 4}));
}

// Where no row is friction nothing about friction need be there; a row whose bounds are those of neither
// joint nor contact is not guessed at.
TEST(ProblemFile, WithoutFrictionItsArraysMayBeLeftOut) {
  const TemporaryDirectory directory;
  ProblemFile file = sample_file(2);
  StepProblem& p = file.problem;
  for (const std::size_t row : {2u, 4u}) p.lower[row] = -kInfinity, p.upper[row] = kInfinity;
  const Instead without = [](const Hdf5Writer&, const std::string& name) {
    return name == "row_kind" || name.starts_with("friction_row") || name == "friction_coefficient";
  };
  write_unchecked(directory / "a.h5", file, without);
  const StepProblem read = read_problem_file(directory / "a.h5").problem;
  EXPECT_EQ(read.friction_row, std::vector<int>(5, -1));
  EXPECT_EQ(read.friction_coefficient, std::vector<double>(5));
  p.upper[2] = 7;
  write_unchecked(directory / "b.h5", file, without);
  EXPECT_THROW(read_problem_file(directory / "b.h5"), std::invalid_argument);
}

// 32-bit floats are exact as 64-bit ones; integers of 64 bits are read where they fit.
TEST(ProblemFile, ReadsNarrowFloatsAndWideIntegers) {
  const TemporaryDirectory directory;
  ProblemFile file = sample_file();
  std::vector<float> narrow(file.problem.rhs.begin(), file.problem.rhs.end());
  file.problem.rhs.assign(narrow.begin(), narrow.end());
  const auto add_wide = [&](const fs::path& path, const std::string& name, std::vector<long long> values,
                            std::vector<hsize_t> extents) {
    const Hdf5Handle open(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const Hdf5Handle space(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr),
                           H5Sclose);
    const Hdf5Handle set(
        H5Dcreate2(open.id(), name.c_str(), H5T_STD_I64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    H5Dwrite(set.id(), H5T_NATIVE_LLONG, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  };
  const auto write = [&](const fs::path& path, std::vector<long long> row_body) {
    write_unchecked(path, file, [&](const Hdf5Writer& writer, const std::string& name) {
      if (name == "rhs") writer.array(name, {14}, narrow);
      return name == "rhs" || name == "row_body" || name == "row_kind";
    });
    add_wide(path, "row_body", std::move(row_body), {14, 2});
    std::vector<long long> kinds;
    for (const RowKind kind : file.problem.row_kind) kinds.push_back(static_cast<int>(kind));
    add_wide(path, "row_kind", kinds, {14});
  };
  std::vector<long long> bodies(file.problem.row_body.begin(), file.problem.row_body.end());
  write(directory / "a.h5", bodies);
  expect_same_arrays(file, read_problem_file(directory / "a.h5"));
  bodies[4] = (1LL << 32) + bodies[4];  // the lower half is a good body
  write(directory / "b.h5", bodies);
  try {
    read_problem_file(directory / "b.h5");
    FAIL() << "no error";
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("row_body[4] = 4294967298, allowed: -2147483648 to 2147483647"), std::string::npos)
        << text;
  }
}

TEST(ProblemFile, InvalidProblemIsNotWritten) {
  const TemporaryDirectory directory;
  ProblemFile file = sample_file();
  file.problem.rhs[3] = std::nan("");
  try {
    write_problem_file(directory / "a.h5", file);
    FAIL() << "no error";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("rhs[3] = nan"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(fs::is_empty(directory.path()));
}

TEST(ProblemFile, FailedWriteNamesTheFileAndLeavesTheOldOne) {
  const TemporaryDirectory directory;
  try {
    write_problem_file(directory / "missing/a.h5", sample_file());
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("missing/a.h5"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
  // The place of the temporary file is taken by a directory, so that nothing can be written.
  write_problem_file(directory / "a.h5", sample_file());
  const std::string before = read_text(directory / "a.h5");
  fs::create_directories(directory / "a.h5.part/keep");
  EXPECT_THROW(write_problem_file(directory / "a.h5", sample_file(5, 2)), std::runtime_error);
  EXPECT_TRUE(read_text(directory / "a.h5") == before);
}

TEST(ProblemFile, WritingLeavesNoTemporaryFile) {
  const TemporaryDirectory directory;
  write_problem_file(directory / "a.h5", sample_file());
  write_problem_file(directory / "a.h5", sample_file(4, 2));  // replaces
  EXPECT_EQ(read_problem_file(directory / "a.h5").problem.body_count(), 4);
  const fs::directory_iterator entries(directory.path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

TEST(ProblemFile, LabelNamesTheCombination) {
  EXPECT_EQ(combination_label("mix", "fm", "schur"), "mix+fm+schur");
  EXPECT_EQ(combination_label("-", "-", "pivot:dense"), "-+-+pivot:dense");
}

}  // namespace
}  // namespace cleave

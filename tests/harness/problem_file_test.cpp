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

// Every array of `a` has the bits of the same array of `b`.
void expect_same_arrays(const ProblemFile& a, const ProblemFile& b) {
  std::vector<std::string> of_a;
  const auto bits = [](std::vector<std::string>& into) {
    return [&into](const std::string& name, const auto& values, const Hdf5Shape& shape) {
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

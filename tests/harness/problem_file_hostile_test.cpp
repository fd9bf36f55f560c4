// Problem files that lead elsewhere, ask for more than they hold or bring texts that are none: refused by
// name.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <stdexcept>

#include "tests/harness/problem_file_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

// The sample without one array, which `add` then adds in its own way.
class HostileProblemFile : public ::testing::Test {
 protected:
  using Add = std::function<void(hid_t file)>;

  std::string error_with(const std::string& left_out, const Add& add) const {
    write_unchecked(path_, sample_file(),
                    [&](const Hdf5Writer&, const std::string& name) { return name == left_out; });
    {
      const Hdf5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
      add(file.id());
    }
    return error_of(path_);
  }

  // A dataset rhs of the sample's 14 rows, without data, with properties of its own.
  std::string error_with_rhs(const std::function<void(hid_t properties)>& set,
                             hid_t type = H5T_IEEE_F64LE) const {
    return error_with("rhs", [&](hid_t file) {
      const hsize_t rows = 14;
      const Hdf5Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose);
      const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      set(properties.id());
      const Hdf5Handle rhs(
          H5Dcreate2(file, "rhs", type, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT), H5Dclose);
      ASSERT_TRUE(rhs.valid());
    });
  }

  void expect(const std::string& error, const std::string& text) const {
    EXPECT_TRUE(error.starts_with(path_.string() + ": " + text)) << error;
    EXPECT_EQ(count_lines(error), 0) << error;
  }

  const TemporaryDirectory directory_;
  const fs::path path_ = directory_ / "a.h5";
};

TEST_F(HostileProblemFile, ANameThatIsNoneInAFileOfOurs) {
  write_problem_file(path_, sample_file());
  {
    const Hdf5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    ASSERT_GE(H5Lmove(file.id(), "row_constraint", file.id(), "row_constraiGt", H5P_DEFAULT, H5P_DEFAULT), 0);
  }
  expect(error_of(path_), "row_constraiGt is no data of a problem file that cleave wrote");
}

TEST_F(HostileProblemFile, LinksAreNotFollowed) {
  ASSERT_EQ(::mkfifo((directory_ / "fifo").c_str(), 0600), 0);
  expect(error_with("rhs",
                    [&](hid_t file) {
                      H5Lcreate_external((directory_ / "fifo").c_str(), "/rhs", file, "rhs", H5P_DEFAULT,
                                         H5P_DEFAULT);
                    }),
         "rhs = external link, allowed: a dataset or group in its place");
  const auto soft = [](const char* target, const char* name) {
    return [=](hid_t file) { H5Lcreate_soft(target, file, name, H5P_DEFAULT, H5P_DEFAULT); };
  };
  expect(error_with("rhs", soft("/lower", "rhs")), "rhs = soft link");
  expect(error_with("", soft("/", "solution")), "solution = soft link");
}

TEST_F(HostileProblemFile, FifoIsNotOpened) {
  ASSERT_EQ(::mkfifo(path_.c_str(), 0600), 0);
  expect(error_of(path_), "is no file");
}

TEST_F(HostileProblemFile, ReferencesAreNoValues) {
  const auto reference = [](hid_t file) {
    const Hdf5Handle one(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle scene(H5Acreate2(file, "scene", H5T_STD_REF_OBJ, one.id(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    hobj_ref_t to;
    H5Rcreate(&to, file, "/lower", H5R_OBJECT, -1);
    H5Awrite(scene.id(), H5T_STD_REF_OBJ, &to);
  };
  expect(error_with("scene", reference), "type of attribute scene = object reference, allowed: text");
}

TEST_F(HostileProblemFile, NumbersOfUnusualBitsAreNotRead) {
  const Hdf5Handle shifted(H5Tcopy(H5T_IEEE_F64LE), H5Tclose), narrow(H5Tcopy(H5T_STD_I64LE), H5Tclose);
  ASSERT_GE(H5Tset_ebias(shifted.id(), 1022), 0);
  ASSERT_GE(H5Tset_precision(narrow.id(), 40), 0);
  const auto nothing = [](hid_t) {};
  expect(error_with_rhs(nothing, shifted.id()), "type of rhs = 64-bit unusual float, allowed: 64-bit float");
  expect(error_with_rhs(nothing, narrow.id()),
         "type of rhs = 64-bit unusual signed integer, allowed: 64-bit float");
  EXPECT_EQ(error_with_rhs(nothing, H5T_IEEE_F64BE), "");
}

TEST_F(HostileProblemFile, DataOfOtherFilesAreNotRead) {
  expect(error_with_rhs([](hid_t properties) { H5Pset_external(properties, "/dev/zero", 0, 14 * 8); }),
         "storage of rhs = another file, allowed: this file");
  expect(error_with_rhs([](hid_t properties) {
           const hsize_t rows = 14;
           const Hdf5Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose);
           H5Pset_virtual(properties, space.id(), "/dev/zero", "rhs", space.id());
         }),
         "storage of rhs = another file");
}

TEST_F(HostileProblemFile, OfFiltersOnlyTheListedOnesAreUsed) {
  const auto chunked = [](hid_t properties) {
    const hsize_t rows = 14;
    H5Pset_chunk(properties, 1, &rows);
  };
  EXPECT_EQ(error_with_rhs([&](hid_t properties) {
              chunked(properties);
              H5Pset_shuffle(properties);
              H5Pset_deflate(properties, 9);
              H5Pset_fletcher32(properties);
            }),
            "");
  expect(error_with_rhs([&](hid_t properties) {
           chunked(properties);
           H5Pset_nbit(properties);
         }),
         "filter of rhs = number 5, allowed: gzip, shuffle, fletcher32");
}

TEST_F(HostileProblemFile, NothingIsMadeRoomForThatTheFileCannotHold) {
  const auto huge = [](const char* name, hsize_t width) {
    return [=](hid_t file) {
      const hsize_t extents[] = {40'000'000, width};
      const Hdf5Handle space(H5Screate_simple(2, extents, nullptr), H5Sclose);
      const Hdf5Handle array(
          H5Dcreate2(file, name, H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
          H5Dclose);
    };
  };
  expect(error_with("free_velocity", huge("free_velocity", 6)),
         "size of free_velocity = 240000000 entries of 8 bytes, allowed: what a file of ");
  expect(error_with("jacobian", huge("jacobian", 12)), "size of jacobian = 480000000 entries of 8 bytes");
}

TEST_F(HostileProblemFile, TextsArePrintable) {
  const auto expect_scene = [&](const std::string& scene, const std::string& shown) {
    ProblemFile file = sample_file();
    file.scene = scene;
    write_unchecked(path_, file);
    expect(error_of(path_),
           "scene = \"" + shown + "\", allowed: printable UTF-8 text without control characters");
    EXPECT_THROW(write_problem_file(path_, file), std::invalid_argument);
  };
  expect_scene("rock\npile", "rock\\x0apile");
  expect_scene("rock\x1b[2J", "rock\\x1b[2J");
  expect_scene("rock\xff", "rock\\xff");
  expect_scene("\xc0\xaf", "\\xc0\\xaf");
  expect_scene(
      "a\xe2\x80\xa8"
      "b",
      "a\\xe2\\x80\\xa8b");
  ProblemFile file = sample_file();
  file.scene = "Gesteinshaufen, \"groß\" 岩";
  write_problem_file(path_, file);
  EXPECT_EQ(read_problem_file(path_).scene, file.scene);
  file.solutions["a\tb"] = file.solutions.begin()->second;
  EXPECT_THROW(write_problem_file(path_, file), std::invalid_argument);
}

// The disk gets full in the middle: one line that says so, no crash of the library at the end, no half file.
TEST_F(HostileProblemFile, FullDiskIsOneLine) {
  const auto run = [&](const std::string& kilobytes, const std::string& command) {
    return run_program(
        "/bin/bash", {"-c", "trap '' XFSZ; ulimit -c 0; ulimit -f " + kilobytes + "; exec " + CLEAVE_PROGRAM +
                                " " + command + " --scene rock_pile --out " + (directory_ / "out").string()});
  };
  const ProgramResult recorded = run("64", "record --bodies 60 --at 100,120");
  EXPECT_EQ(recorded.exit_code, 1);
  const std::string line = (directory_ / "out/rock_pile_step000100.h5").string();
  EXPECT_NE(recorded.err.find(line + ": cannot be written: File too large\n"), std::string::npos)
      << recorded.err;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory_ / "out"))
    EXPECT_EQ(entry.path().string().find(".h5"), std::string::npos) << entry.path();
  fs::remove_all(directory_ / "out");
  const ProgramResult ran = run(
      "64", "run --bodies 20 --steps 400 --measure-every 400 --partitioner mix --refiner fm --record-motion");
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_NE(ran.err.find("motion.h5"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("cannot be written: File too large"), std::string::npos) << ran.err;
  EXPECT_FALSE(fs::exists(directory_ / "out/motion.h5"));
}

}  // namespace
}  // namespace cleave

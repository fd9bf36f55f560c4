// A changed byte of a problem file never crashes, never hangs, and never gives another problem without a
// word.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <random>
#include <stdexcept>

#include "harness/files/problem_file_hashes.h"
#include "tests/harness/problem_file_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

void write_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

class FlippedProblemFile : public ::testing::Test {
 protected:
  void SetUp() override {
    write_problem_file(path_, file_);
    bytes_ = read_text(path_);
  }

  // The error of the file with `change` made to its bytes; empty where it is read.
  std::string error_after(const std::function<void(std::string&)>& change) const {
    std::string bytes = bytes_;
    change(bytes);
    write_bytes(path_, bytes);
    return error_of(path_);
  }

  std::string error_without(const std::string& from, const std::string& to) const {
    return error_after([&](std::string& bytes) {
      const std::size_t at = bytes.find(from);
      ASSERT_NE(at, std::string::npos) << from;
      bytes.replace(at, from.size(), to);
    });
  }

  const TemporaryDirectory directory_;
  const fs::path path_ = directory_ / "a.h5";
  const ProblemFile file_ = sample_file();
  std::string bytes_;
};

void expect_refused_or_same(const fs::path& path, const StoredHashes& hashes, int& refused) {
  try {
    const ProblemFile read = read_problem_file(path);
    EXPECT_TRUE(read.is_checked);
    EXPECT_TRUE(hashes_of(read) == hashes);
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    EXPECT_TRUE(text.starts_with(path.string() + ": ")) << text;
    EXPECT_EQ(count_lines(text), 0) << text;
    ++refused;
  }
}

TEST_F(FlippedProblemFile, IsRefusedOrTheSame) {
  const unsigned seed = 11;
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  const StoredHashes hashes = hashes_of(file_);
  int refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::string bytes = bytes_;
    const std::size_t at = random() % bytes.size();
    bytes[at] = static_cast<char>(bytes[at] ^ (1 + random() % 255));
    SCOPED_TRACE("byte " + std::to_string(at));
    write_bytes(path_, bytes);
    expect_refused_or_same(path_, hashes, refused);
  }
  EXPECT_GT(refused, 100);  // the sample is small: half of its bytes are padding
}

// The two schemas are a byte apart, and so are the sets.
TEST_F(FlippedProblemFile, ChangedSchemasAndSetsAreTold) {
  EXPECT_NE(error_without("cleave-problem-1", "cleave-problem-2").find("where there is a contact_set"),
            std::string::npos);
  ProblemFile file = file_;
  give_sample_sets(file.problem);
  write_problem_file(path_, file);
  bytes_ = read_text(path_);
  EXPECT_NE(error_without("cleave-problem-2", "cleave-problem-1").find("where there is a contact_set"),
            std::string::npos);
  EXPECT_NE(error_without("contact_set", "contact_sex"), "");
  const auto bytes_of = [](const std::vector<ContactSet>& sets) {
    return std::string(reinterpret_cast<const char*>(sets.data()), sets.size());
  };
  std::vector<ContactSet> other = file.problem.contact_set;
  other[4] = ContactSet::coulomb;
  ASSERT_NE(other, file.problem.contact_set);
  const std::string error = error_without(bytes_of(file.problem.contact_set), bytes_of(other));
  EXPECT_TRUE(error.starts_with(path_.string() + ": problem_hash = \"")) << error;
}

// A bit in the last place of a number makes another problem, which only a hash can tell.
TEST_F(FlippedProblemFile, BitsOfDataAreToldByTheHashOverThem) {
  const auto error_of_bit = [&](const std::vector<double>& array) {
    const std::string data(reinterpret_cast<const char*>(array.data()), array.size() * sizeof(double));
    std::string other = data;
    other[0] = static_cast<char>(other[0] ^ 1);
    return error_without(data, other);
  };
  const auto begins = [&](const std::string& name, const std::string& error) {
    EXPECT_TRUE(error.starts_with(path_.string() + ": " + name + " = \"")) << error;
    EXPECT_NE(error.find("damaged"), std::string::npos) << error;
  };
  begins("problem_hash", error_of_bit(file_.problem.jacobian));
  begins("problem_hash", error_of_bit(file_.problem.warm_impulse));
  begins("description_hash", error_of_bit(file_.position));
  begins("description_hash", error_of_bit(file_.shapes->convex_points));
  begins("solutions_hash", error_of_bit(file_.solutions.begin()->second.impulse));
  begins("description_hash", error_without("rock_pile", "rock_pole"));
  begins("solutions_hash", error_without("constraints", "constraintz"));
}

TEST_F(FlippedProblemFile, LostHashesAndMarksAreNoticed) {
  const std::vector<std::string> names = {"problem_hash", "description_hash", "solutions_hash", "written_by"};
  for (const std::string& name : names) {
    const std::string lost = name.substr(0, name.size() - 1) + "_";
    EXPECT_NE(error_without(name, lost).find("attribute " + name + " is missing"), std::string::npos) << name;
  }
  const std::string none = error_after([&](std::string& bytes) {
    for (const char* name : {"problem_hash", "description_hash", "solutions_hash"})
      bytes.replace(bytes.find(name), 1, "x");
  });
  EXPECT_NE(none.find("attribute problem_hash is missing, which every file has that cleave wrote"),
            std::string::npos)
      << none;
}

TEST_F(FlippedProblemFile, FilesOfOthersAreReadAsUnchecked) {
  EXPECT_TRUE(read_problem_file(path_).is_checked);
  write_unchecked(path_, file_);
  EXPECT_FALSE(read_problem_file(path_).is_checked);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"verify"}, {"replay", "--out", directory_ / "out", "--repeats", "1"}}) {
    std::vector<std::string> arguments = command;
    arguments.push_back(path_);
    const std::string err = run_cleave(arguments).err;
    const std::string line = path_.string() + ": unchecked: it carries no hashes";
    EXPECT_NE(err.find(line), std::string::npos) << err;
    EXPECT_EQ(err.find(line), err.rfind(line)) << err;
  }
}

// A text's type is its class, a byte with padding and characters, and its size.
TEST_F(FlippedProblemFile, TextsOfUnusualTypesAreRefused) {
  write_problem_file(path_, file_);
  const std::string bytes = read_text(path_), type("\x13\x11\0\0\x09\0\0\0", 8);
  ASSERT_EQ(file_.scene.size(), 9u);
  const std::size_t scene = bytes.find(type, bytes.find("scene"));
  ASSERT_NE(scene, std::string::npos);
  for (const char flipped : {'\x02', '\x20'}) {
    std::string damaged = bytes;
    damaged[scene + 1] ^= flipped;
    std::ofstream(path_, std::ios::binary) << damaged;
    EXPECT_NE(error_of(path_).find("type of attribute scene = unusual text, allowed: text"),
              std::string::npos)
        << error_of(path_);
  }
}

// An integer's type is its class, its sign, its size, and where its bits begin: a place beyond them is read
// as nobody knows what.
TEST_F(FlippedProblemFile, IntegersOfUnusualTypesAreRefused) {
  write_problem_file(path_, file_);
  const std::string bytes = read_text(path_);
  const std::size_t step = bytes.find(std::string("\x10\x08\0\0", 4), bytes.find(std::string("step\0", 5)));
  ASSERT_NE(step, std::string::npos);
  constexpr int kOffset = 8, kPrecision = 10;
  for (const int changed : {kOffset, kPrecision}) {
    std::string damaged = bytes;
    damaged[step + changed] ^= '\x08';
    std::ofstream(path_, std::ios::binary) << damaged;
    EXPECT_NE(error_of(path_).find("bit unusual signed integer, allowed: an integer"), std::string::npos)
        << error_of(path_);
  }
}

// What h5py writes of a Python string lies in a heap; pointers into it are followed by the library alone.
TEST_F(FlippedProblemFile, DamagedHeapOfTextsEndsInALine) {
  write_unchecked(path_, file_, [](const Hdf5Writer&, const std::string& name) { return name == "scene"; });
  {
    const Hdf5Handle open(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const Hdf5Handle one(H5Screate(H5S_SCALAR), H5Sclose), text(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(text.id(), H5T_VARIABLE);
    const Hdf5Handle scene(H5Acreate2(open.id(), "scene", text.id(), one.id(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    const char* value = "rock_pile";
    H5Awrite(scene.id(), text.id(), &value);
  }
  EXPECT_EQ(read_problem_file(path_).scene, "rock_pile");
  const std::string bytes = read_text(path_);
  const std::size_t heap = bytes.find("GCOL");
  ASSERT_NE(heap, std::string::npos);
  int refused = 0;
  for (std::size_t at = heap; at < heap + 48; ++at)
    for (const char value : {'\0', '\x01', '\x7f', '\xff'}) {
      std::string damaged = bytes;
      damaged[at] = value;
      write_bytes(path_, damaged);
      refused += error_of(path_).empty() ? 0 : 1;
    }
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace cleave

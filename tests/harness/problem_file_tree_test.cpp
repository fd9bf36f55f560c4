// Trees of parts in problem files: kept to the last node, refused where they are none, and made again by
// verify.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "harness/commands/stored_partition.h"
#include "harness/experiment/algorithms.h"
#include "harness/experiment/splitter.h"
#include "tests/harness/problem_file_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTree = "mix+fm+schur";  // of the sample, where it is one level

ProblemFile sample_with_tree() {
  ProblemFile file = sample_file();
  StoredPartition& partition = file.partitions.at(kTree);
  partition.part_of_body = {0, 0, 1, 1, 2};
  partition.parent_of_part = {3, 3, 4, 4, -1};
  partition.parameters.insert(partition.parameters.begin(), {"arity", Parameter::Kind::integer, "2"});
  return file;
}

std::string error_of(const fs::path& path) {
  try {
    read_problem_file(path);
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

// The bytes of the tree as they stand in a file.
std::string bytes_of(const std::vector<int>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(int)};
}

class ProblemFileTree : public ::testing::Test {
 protected:
  std::string error_written(const std::vector<int>& part_of_body, const std::vector<int>& parent_of_part) {
    ProblemFile file = sample_with_tree();
    file.partitions.at(kTree).part_of_body = part_of_body;
    file.partitions.at(kTree).parent_of_part = parent_of_part;
    try {
      write_problem_file(path_, file);
      return "";
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  }

  // Read from a file of another program, which has no hashes.
  std::string error_read(const std::vector<int>& part_of_body, const std::vector<int>& parent_of_part) {
    write_unchecked(path_, sample_file(), [&](const Hdf5Writer& writer, const std::string& name) {
      if (!name.empty()) return false;
      const Hdf5Writer group = writer.group("partition").group(kTree);
      group.attribute("partitioner", std::string("mix"));
      group.attribute("refiner", std::string("fm"));
      group.array("part_of_body", {part_of_body.size()}, part_of_body);
      group.array("parent_of_part", {parent_of_part.size()}, parent_of_part);
      return true;
    });
    return error_of(path_);
  }

  const TemporaryDirectory directory_;
  const fs::path path_ = directory_ / "a.h5";
};

TEST_F(ProblemFileTree, RoundTripKeepsEveryNode) {
  const ProblemFile file = sample_with_tree();
  write_problem_file(path_, file);
  const ProblemFile read = read_problem_file(path_);
  EXPECT_TRUE(read.is_checked);
  EXPECT_EQ(read.partitions.at(kTree).part_of_body, file.partitions.at(kTree).part_of_body);
  EXPECT_EQ(read.partitions.at(kTree).parent_of_part, file.partitions.at(kTree).parent_of_part);
  EXPECT_EQ(read.partitions.at(kTree).parameters, file.partitions.at(kTree).parameters);
  write_problem_file(path_, sample_file());
  EXPECT_EQ(read_problem_file(path_).partitions.at(kTree).parent_of_part, std::vector<int>());
}

TEST_F(ProblemFileTree, WhatIsNoTreeIsNeitherReadNorWritten) {
  const std::vector<int> parts = {0, 0, 1, 1, 2}, tree = {3, 3, 4, 4, -1};
  EXPECT_EQ(error_read(parts, tree), "");
  EXPECT_EQ(error_written(parts, tree), "");
  const std::string label = "partition/mix+fm+schur/";
  struct Case {
    std::vector<int> part_of_body, parent_of_part;
    std::string error;
  };
  for (const auto& [part_of_body, parent_of_part, error] : {
           Case{parts, {3, 3, 4, 4, 4}, "parent_of_part[4] = 4, allowed: -1, the root"},
           Case{parts, {3, 3, 4, 3, -1}, "parent_of_part[3] = 3, allowed: 4, a later node"},
           Case{parts, {3, 3, 2147483647, 4, -1}, "parent_of_part[2] = 2147483647, allowed: 3 to 4"},
           Case{parts, {2, 2, 4, 4, -1}, "parent_of_part: node 3 has no children"},
           Case{{0, 0, 1, 1, 3}, tree, "part_of_body[4] = 3, allowed: 0 to 2, a leaf"},
           Case{{0, 0, 1, -1, 2}, tree, "part_of_body[3] = -1, allowed: 0 to 2, a leaf"},
       }) {
    EXPECT_TRUE(error_read(part_of_body, parent_of_part).starts_with(path_.string() + ": " + label + error))
        << error_of(path_) << " in place of " << error;
    const std::string written = error_written(part_of_body, parent_of_part);
    EXPECT_NE(written.find("not written: " + label + error), std::string::npos) << written;
  }
}

// Still a tree, but not the one that was written.
TEST_F(ProblemFileTree, AChangedByteIsToldByTheHash) {
  write_problem_file(path_, sample_with_tree());
  const std::string bytes = read_text(path_), parents = bytes_of({3, 3, 4, 4, -1});
  const std::size_t at = bytes.find(parents);
  ASSERT_NE(at, std::string::npos);
  ASSERT_EQ(bytes.find(parents, at + 1), std::string::npos);
  const auto error_with = [&](std::size_t place, const std::string& text) {
    std::string damaged = bytes;
    damaged.replace(place, text.size(), text);
    std::ofstream(path_, std::ios::binary) << damaged;
    return error_of(path_);
  };
  for (std::size_t i = 0; i < parents.size(); ++i)
    for (int bit = 0; bit < 8; ++bit)
      EXPECT_NE(error_with(at + i, std::string(1, static_cast<char>(parents[i] ^ (1 << bit)))), "")
          << "byte " << i << " bit " << bit;
  const std::string told = path_.string() + ": solutions_hash = \"";
  EXPECT_TRUE(error_with(at, bytes_of({3, 4, 3, 4, -1})).starts_with(told)) << error_of(path_);
  // A tree whose name is damaged is not passed over.
  const std::size_t name = bytes.find("parent_of_part");
  ASSERT_NE(name, std::string::npos);
  EXPECT_NE(error_with(name, "qarent_of_part"), "");
}

// A replayed file with a tree beside its parts of one level.
class VerifiedTree : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_cleave({"record", "--scene", "rock_pile", "--bodies", "40", "--at", "80", "--out",
                          directory_ / "out"})
                  .exit_code,
              0);
    file_ = read_problem_file(path_);
    const SplitSetup setup{read_named("partitioner", "mix@max-bodies=5"), read_named("refiner", "fm"), false,
                           2};
    Split split = Splitter(setup).run(file_.problem, file_.step);
    file_.partitions[label_] =
        stored_partition(setup, split.parts.part_of_body, split.parts.parent_of_part, split.origin);
  }

  StoredPartition& tree() { return file_.partitions.at(label_); }

  // What verify prints of the tree.
  std::string verified(int exit_code) {
    write_problem_file(path_, file_);
    const ProgramResult result = run_cleave({"verify", path_});
    EXPECT_EQ(result.exit_code, exit_code) << result.out << result.err;
    const std::size_t at = result.out.rfind(" parts, ");
    EXPECT_NE(at, std::string::npos);
    return result.out.substr(std::min(at, result.out.size()));
  }

  void set_arity(const std::string& text) {
    for (StoredParameter& parameter : tree().parameters)
      if (parameter.name == "arity") parameter.text = text;
  }

  const TemporaryDirectory directory_;
  const fs::path path_ = directory_ / "out/rock_pile_step000080.h5";
  const std::string label_ = "mix@max-bodies=5+fm+some";
  ProblemFile file_;
};

TEST_F(VerifiedTree, IsMadeAgain) {
  ASSERT_GT(tree().parent_of_part.size(), 12u);
  EXPECT_NE(verified(0).find("split again, the same"), std::string::npos);
}

TEST_F(VerifiedTree, AnotherTreeOfTheSamePartsIsFound) {
  std::vector<int>& parents = tree().parent_of_part;
  const int root = static_cast<int>(parents.size()) - 1;
  const auto below = std::ranges::find_if(parents, [root](int parent) { return parent != root; });
  ASSERT_LT(below - parents.begin(), root);
  *below = root;
  EXPECT_NE(verified(3).find("the parts are the same and their tree is another"), std::string::npos);
  parents.clear();
  EXPECT_NE(verified(3).find("the parts are the same and their tree is another"), std::string::npos);
}

// Rows of one pair agree about their parts with those of the same arity, and with no others.
TEST_F(VerifiedTree, AReplayWithAndWithoutATreePasses) {
  const fs::path out = directory_ / "replayed";
  const ProgramResult replayed =
      run_cleave({"replay", path_, "--partitioner", "mix", "--refiner", "none,fm", "--max-bodies", "5",
                  "--solver", "schur,pivot:schur-nested,pivot:schur-nested@arity=4", "--repeats", "1",
                  "--write-solutions", "--out", out});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  const ProgramResult result = run_cleave({"verify", out});
  EXPECT_EQ(result.exit_code, 0) << result.out;
  const std::string file = out / path_.filename();
  const auto partitions = read_problem_file(file).partitions;
  EXPECT_TRUE(partitions.at("mix+fm+schur").parent_of_part.empty());
  const std::vector<int>& two = partitions.at("mix+fm+pivot:schur-nested").parent_of_part;
  const std::vector<int>& four = partitions.at("mix+fm+pivot:schur-nested@arity=4").parent_of_part;
  EXPECT_GT(two.size(), 8u);
  EXPECT_GT(four.size(), 8u);
  EXPECT_NE(two, four);
}

TEST_F(VerifiedTree, ItsArityIsNeededAndTrue) {
  set_arity("4");
  EXPECT_NE(verified(3).find("differ"), std::string::npos);
  set_arity("1");
  EXPECT_NE(verified(3).find("cannot be split again: --arity: 1 is not in [2, inf)"), std::string::npos);
  std::erase_if(tree().parameters, [](const auto& parameter) { return parameter.name == "arity"; });
  EXPECT_NE(verified(3).find("cannot be split again: arity is missing, which parts in a tree have"),
            std::string::npos);
}

TEST_F(VerifiedTree, PartsOfFilesAreOneLevel) {
  const StoredPartition nested = tree();
  file_.partitions.clear();
  file_.partitions["file@0123456789abcdef+fm+some"] = nested;
  file_.partitions.begin()->second.partitioner = "file@0123456789abcdef";
  EXPECT_NE(verified(3).find("allowed: one level, as parts from files are"), std::string::npos);
}

}  // namespace
}  // namespace cleave

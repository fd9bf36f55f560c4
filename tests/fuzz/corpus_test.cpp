// What fuzzers found, and what takes them to every place they know, through the same functions: no fuzzer is
// needed.
#include <gtest/gtest.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "harness/experiment/options.h"
#include "harness/files/problem_file.h"
#include "tests/fuzz/child_reports.h"
#include "tests/fuzz/problem_image.h"
#include "tests/fuzz/scratch_file.h"
#include "tests/fuzz/target.h"

namespace cleave::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path kCorpus = fs::path(CLEAVE_SOURCE_DIR) / "tests/fuzz/corpus";
constexpr std::uintmax_t kMostBytes = 500'000;  // of all corpora

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Corpus : public testing::TestWithParam<Target> {};

TEST_P(Corpus, NothingInItIsAFinding) {
  int inputs = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(kCorpus / GetParam().name)) {
    SCOPED_TRACE(entry.path().string());
    EXPECT_NO_THROW(GetParam().run(bytes_of(entry.path())));
    ++inputs;
  }
  EXPECT_GE(inputs, 10);
}

// A change is of the target's own making: it is one that the target can be given.
TEST_P(Corpus, ItsChangesAreNoFindings) {
  if (GetParam().mutate == nullptr) return;
  Random random(1);
  std::string bytes;
  for (int i = 0; i < 200; ++i) {
    bytes = GetParam().mutate(i % 20 == 0 ? "" : bytes, random);
    SCOPED_TRACE(bytes);
    EXPECT_NO_THROW(GetParam().run(bytes));
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& info) { return info.param.name; });

// A value of another kind is refused at once, and nothing behind its reader is reached.
TEST(OptionChanges, GiveNumbersToOptionsThatTakeThem) {
  Random random(1);
  int given = 0, numbers = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::string bytes = mutate_options("run\n--scene=rock_pile\n--out=o", random) + "\n";
    for (const OptionSpec& spec : run_option_specs()) {
      const std::size_t place = bytes.find("--" + spec.name + "=");
      if (spec.kind != OptionKind::number || place == std::string::npos) continue;
      const char* const first = bytes.data() + place + spec.name.size() + 3;
      double value = 0;
      ++given;
      numbers += *std::from_chars(first, bytes.data() + bytes.size(), value).ptr == '\n';
    }
  }
  EXPECT_GE(given, 100);
  EXPECT_GE(numbers, given / 3);
}

// Else what is edited is refused whatever the edit is, and the target tests nothing.
TEST(SoundImages, AreRead) {
  for (const std::string& recipe : {std::string(1, '\0'), std::string(1, '\1')}) {
    const ScratchFile file(problem_image(recipe));
    EXPECT_EQ(read_problem_file(file.path()).problem.body_count(), 3);
  }
}

std::string stack_of(const std::vector<std::string>& modules) {
  std::string text;
  for (std::size_t i = 0; i < modules.size(); ++i)
    text += "    #" + std::to_string(i) + " 0x12 (" + modules[i] + "+0x34) in f /a/b.cpp:1:2\n";
  return text + "\n";
}

// The sanitiser is linked into the program: its frames are the program's.
TEST(ChildReports, TellTheFaultsOfTheLibrary) {
  const std::string own = fs::read_symlink("/proc/self/exe"), library = "/lib/libhdf5.so";
  EXPECT_TRUE(is_own_fault(stack_of({own, own, own, library})));
  EXPECT_TRUE(is_own_fault(stack_of({own, library, own}) + stack_of({own, own, library})));
  EXPECT_TRUE(is_own_fault("a.cpp:1:2: runtime error: division by zero\n"));
  EXPECT_FALSE(is_own_fault(stack_of({own, library, own, own})));
  EXPECT_FALSE(is_own_fault(stack_of({own, own, library, own})));  // frees what is no memory
  EXPECT_FALSE(is_own_fault(stack_of({own, library, own}) + stack_of({own, library, own})));
}

TEST(CorpusFolder, HoldsTargetsOnlyAndIsSmall) {
  std::uintmax_t bytes = 0;
  std::size_t folders = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kCorpus)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
    folders += entry.is_directory();
  }
  EXPECT_EQ(folders, targets().size());
  EXPECT_LT(bytes, kMostBytes);
}

}  // namespace
}  // namespace cleave::fuzz

// Parts from files: what is read, what is refused, and the fingerprint that stands for a file.
#include "partition/part_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "harness/base/hash.h"
#include "partition/registry.h"

namespace cleave::partition_test {
namespace {

namespace fs = std::filesystem;

class PartFileTest : public testing::Test {
 protected:
  PartFileTest() : directory_(fs::temp_directory_path() / ("cleave_parts_" + std::to_string(::getpid()))) {
    fs::remove_all(directory_);
    fs::create_directories(directory_);
  }
  ~PartFileTest() override { fs::remove_all(directory_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ / name, std::ios::binary) << text;
    return directory_ / name;
  }
  std::string path(const std::string& name) const { return directory_ / name; }

  // Four bodies in a row.
  static BodyGraph graph(std::optional<int> step) {
    const std::vector<double> mass_kg(4, 1.0);
    const std::vector<ConstraintLink> links = {{0, 1, 3}, {1, 2, 3}, {2, 3, 3}};
    return BodyGraph(mass_kg, links, step);
  }

 private:
  fs::path directory_;
};

template <class Error, class Act>
std::string error_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(PartFileTest, FingerprintIsThatOfTheBytesOfMetis) {
  const std::string bytes = "1\n0\n1\n12\n2\n3\n4\n5\n6\n7\n8\n9\n10\n11\n";
  const PartFile file = read_part_file(write("a.part", bytes));
  EXPECT_EQ(file.partition.part_count, 13);
  EXPECT_EQ(file.partition.part_of_body[3], 12);
  Fnv1a64 hash;
  hash.add(bytes);
  EXPECT_EQ(part_ids_fingerprint(file.partition.part_of_body), hex(hash.value()));
  EXPECT_EQ(PartFiles(path("a.part")).fingerprint(), hex(hash.value()));
  // A last line without its end is the same parts.
  EXPECT_EQ(PartFiles(write("b.part", bytes.substr(0, bytes.size() - 1))).fingerprint(), hex(hash.value()));
}

TEST_F(PartFileTest, RefusesWhatIsNoPartition) {
  const std::vector<std::pair<std::string, std::string>> damages = {
      {"0\n1\n-1\n", "line 3 is '-1', allowed: a part id, 0 or more"},
      {"0\nx\n", "line 2 is 'x', allowed: a part id"},
      {"0\n\n1\n", "line 2 is '', allowed: a part id"},
      {"0 1\n", "line 1 is '0 1', allowed: a part id"},
      {"0\n99999999999\n", "line 2 is '99999999999'"},
      {"0\n3\n1\n", "line 2 is '3', allowed: 0 to 2, as there are 3 different ids"},
      {"1\n1\n", "line 1 is '1', allowed: 0 to 0"},
  };
  for (const auto& [text, message] : damages) {
    const std::string file = write("bad.part", text);
    const std::string error = error_of<std::invalid_argument>([&] { read_part_file(file); });
    EXPECT_TRUE(error.starts_with(file + ": ")) << error;
    EXPECT_NE(error.find(message), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  EXPECT_NE(error_of<std::invalid_argument>([&] { read_part_file(path("none.part")); }).find("no such file"),
            std::string::npos);
}

TEST_F(PartFileTest, OneFileForAllStepsSplitsEveryStep) {
  const auto partitioner = make_partitioner("file@path=" + write("a.part", "1\n0\n0\n1\n"));
  for (const std::optional<int> step : {std::optional<int>(), std::optional(3), std::optional(70)}) {
    const Partition partition = partitioner->run(graph(step));
    EXPECT_EQ(partition.part_of_body, (std::vector<int>{1, 0, 0, 1}));  // not contiguous, and ids as they are
    EXPECT_EQ(partition.part_count, 2);
  }
}

TEST_F(PartFileTest, OneFileAStepIsFoundByItsStep) {
  write("p7.part", "0\n0\n1\n1\n");
  write("p12.part", "0\n1\n2\n3\n");
  write("p012.part", "0\n0\n0\n0\n");  // no number of a step without zeros
  write("p.part", "x\n");
  write("px.part", "x\n");
  const auto partitioner = make_partitioner("file@path=" + path("p{step}.part"));
  EXPECT_EQ(partitioner->run(graph(7)).part_count, 2);
  EXPECT_EQ(partitioner->run(graph(12)).part_count, 4);
  EXPECT_NE(error_of<CannotSplit>([&] { partitioner->run(graph(8)); }).find("no file of step 8"),
            std::string::npos);
  EXPECT_NE(error_of<CannotSplit>([&] { partitioner->run(graph({})); }).find("of no step"),
            std::string::npos);
  // Filled up with zeros.
  EXPECT_EQ(make_partitioner("file@path=" + path("p{step:03}.part"))->run(graph(12)).part_count, 1);
}

TEST_F(PartFileTest, AnotherNumberOfLinesThanBodiesCannotBeSplit) {
  const std::string file = write("a.part", "0\n1\n");
  const auto partitioner = make_partitioner("file@path=" + file);
  EXPECT_EQ(error_of<CannotSplit>([&] { partitioner->run(graph(0)); }),
            file + ": 2 lines, allowed: 4, one a body");
}

TEST_F(PartFileTest, FingerprintOfStepsDependsOnStepsAndIdsAlone) {
  write("a1.part", "0\n1\n");
  write("a10.part", "0\n0\n");
  write("b000001.x", "0\n1\n");
  write("b000010.x", "0\n0");
  const std::string a = PartFiles(path("a{step}.part")).fingerprint();
  EXPECT_EQ(a.size(), 22u);
  EXPECT_TRUE(a.starts_with("steps-"));
  EXPECT_EQ(PartFiles(path("b{step:06}.x")).fingerprint(), a);
  fs::rename(path("a1.part"), path("a2.part"));
  EXPECT_NE(PartFiles(path("a{step}.part")).fingerprint(), a);
}

TEST_F(PartFileTest, RefusesPatternsThatNameNothing) {
  write("{step.part", "0\n");
  for (const char* name : {"p{stepp}.part", "p{step:6}.part", "p{step:00}.part", "{step.part", "{step}{step}",
                           "{step}/a.part"}) {
    const std::string error = error_of<std::invalid_argument>([&] { PartFiles(path(name)); });
    EXPECT_NE(error.find("allowed: {step} or {step:06}"), std::string::npos) << name << ": " << error;
  }
  for (const char* name : {"q{step}.part", "none/q{step}.part"})
    EXPECT_NE(error_of<std::invalid_argument>([&] { PartFiles(path(name)); }).find("no file is called so"),
              std::string::npos);
}

TEST(ContentText, StandsInPlaceOfThePathAndKeepsTheRest) {
  const std::vector<Parameter> parameters = {{.name = "path", .kind = Parameter::Kind::path},
                                             {.name = "x", .kind = Parameter::Kind::integer}};
  EXPECT_EQ(text_with_content("file@path=a/b.c", parameters, "12ab"), "file@12ab");
  EXPECT_EQ(text_with_content("file@x=1@path=a/b.c", parameters, "12ab"), "file@12ab@x=1");
  EXPECT_EQ(fingerprint_of("file@12ab@x=1"), "12ab");
  EXPECT_EQ(fingerprint_of("mix@max-bodies=3"), "");
  EXPECT_EQ(fingerprint_of("mix"), "");
}

}  // namespace
}  // namespace cleave::partition_test

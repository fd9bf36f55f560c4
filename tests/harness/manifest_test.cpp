// manifest.json: valid JSON that a foreign parser reads, with everything needed to repeat the run.
#include "harness/files/manifest.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>

#include "harness/base/names.h"
#include "harness/experiment/options.h"
#include "harness/experiment/step_record.h"
#include "harness/files/json_writer.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

// Evaluates a Python expression over `m`, the parsed file; the text it prints, or the traceback.
std::string ask(const std::filesystem::path& file, const std::string& expression) {
  const ProgramResult result = run_program(
      "/usr/bin/python3",
      {"-c", "import json, sys; m = json.load(open(sys.argv[1])); print((" + expression + "))", file});
  return result.exit_code == 0 ? result.out.substr(0, result.out.size() - 1) : result.err;
}

TEST(JsonWriter, ForeignParserReadsBackWhatWasWritten) {
  const TemporaryDirectory directory;
  const std::string awkward = "quote \" backslash \\ tab \t line \n bell \a umlaut \xc3\xbc";
  JsonWriter json;
  json.begin_object();
  json.field("text", awkward);
  json.field("third", 1.0 / 3);
  json.field("huge", 1e300);
  json.field("missing", std::numeric_limits<double>::quiet_NaN());
  json.field("count", -7);
  json.field("seed", JsonLiteral{"18446744073709551615"});
  json.begin_array("empty");
  json.end_array();
  json.begin_array("list");
  json.value("a");
  json.value(2);
  json.end_array();
  json.begin_object("inner");
  json.end_object();
  json.end_object();
  std::ofstream(directory / "x.json") << json.text();
  EXPECT_EQ(
      ask(directory / "x.json",
          "m['text'] == 'quote \" backslash \\\\ tab \\t line \\n bell \\a umlaut \\u00fc' and m['third'] == "
          "1/3 and "
          "m['huge'] == 1e300 and m['missing'] is None and m['count'] == -7 and m['seed'] == 2**64 - 1 and "
          "m['empty'] == [] and m['list'] == ['a', 2] and m['inner'] == {}"),
      "True");
}

class ManifestOfARun : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("OMP_WAIT_POLICY", "passive", 1);
    const ProgramResult result =
        run_cleave({"run", "--scene", "rock_pile", "--bodies", "3", "--steps", "6", "--measure-every", "3",
                    "--solver", "monolithic", "--advance", "monolithic", "--seed", "18446744073709551615",
                    "--threads", "2", "--out", directory_ / "run"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  std::string ask_manifest(const std::string& expression) {
    return ask(directory_ / "run/manifest.json", expression);
  }
  TemporaryDirectory directory_;
};

TEST_F(ManifestOfARun, SaysWhatRanAndHowItEnded) {
  EXPECT_EQ(ask_manifest("m['schema'], m['state'], m['command']"), "('cleave-run-1', 'complete', 'run')");
  EXPECT_EQ(ask_manifest("m['argv'][1:4]"), "['run', '--scene', 'rock_pile']");
  EXPECT_EQ(ask_manifest("m['seed'] == 2**64 - 1 and m['options']['seed'] == m['seed']"), "True");
  EXPECT_EQ(ask_manifest("m['result']['rows'], m['result']['rows_ok'], m['result']['steps']"), "(2, 2, 6)");
  EXPECT_EQ(ask_manifest("m['utc_start'] <= m['utc_end'] and len(m['utc_end']) == 20"), "True");
  EXPECT_EQ(
      ask_manifest(
          "m['options']['threads'], m['machine']['omp_threads'] >= 1, len(m['machine']['load_average'])"),
      "(2, True, 3)");
  EXPECT_EQ(ask_manifest("m['machine']['cores'] >= 1 and m['machine']['cpu_model'] != ''"), "True");
  EXPECT_EQ(ask_manifest("all(m['build'][k] for k in ('git_hash', 'git_dirty', 'compiler', 'flags'))"),
            "True");
  EXPECT_EQ(ask_manifest("all(m['build']['libraries'][k] for k in ('ode', 'eigen', 'suitesparse', 'hdf5', "
                         "'openmp'))"),
            "True");
}

TEST_F(ManifestOfARun, SaysWhatTheTimesDependOn) {
  EXPECT_EQ(ask_manifest("len(m['machine']['load_average_end']), m['machine']['governor'] != ''"),
            "(3, True)");
  EXPECT_EQ(ask_manifest("m['machine']['omp_environment'].get('OMP_WAIT_POLICY')"), "passive");
  EXPECT_EQ(ask_manifest("len(m['machine']['dense_kernel']) > 2 and m['machine']['dense_gflop_per_s'] > 0"),
            "True");
  EXPECT_EQ(ask_manifest("sorted(m['machine']['dispatch']), m['machine']['dispatch']['timing_us'] > 0"),
            "(['graph_task_us', 'stage_us', 'task_us', 'timing_us'], True)");
  EXPECT_EQ(ask_manifest("m['result']['t_s_total_ms'] > 0 and m['result']['t_s_waiting_total_ms'] >= 0"),
            "True");
}

TEST_F(ManifestOfARun, HoldsEveryOptionWithItsValue) {
  std::vector<std::string> names;
  for (const OptionSpec& spec : run_option_specs()) names.push_back(spec.name);
  for (const CommonParameter& common : common_parameters()) names.push_back(common.parameter.name);
  EXPECT_EQ(ask_manifest("[n for n in '" + joined(names, ",") + "'.split(',') if n not in m['options']]"),
            "[]");
  EXPECT_EQ(ask_manifest("m['options']['mu'], m['options']['stiffness'], m['options']['as-printed']"),
            "(0.5, None, False)");
  EXPECT_EQ(ask_manifest("m['options']['bodies'], m['options']['rock-shape'], m['options']['refiner']"),
            "('3', 'box', 'none,kl,fm')");
}

TEST_F(ManifestOfARun, DescribesTheColumnsOfStepsCsv) {
  const CsvTable table = read_csv(directory_ / "run/steps.csv");
  EXPECT_EQ(ask_manifest("','.join(c['name'] for c in m['columns'])"), joined(table.header, ","));
  EXPECT_EQ(ask_manifest("m['run_id']"), table.at(0, "run_id"));
  EXPECT_EQ(ask_manifest("[c['name'] for c in m['columns'] if c['machine'] and c['name'][:2] != 't_']"),
            "['threads', 'peak_memory_mb', 'core_round_trip_ns']");
}

TEST_F(ManifestOfARun, LeavesNoTemporaryFile) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory_ / "run"))
    files.insert(entry.path().filename());
  EXPECT_EQ(files, (std::set<std::string>{"checksums", "manifest.json", "steps.csv"}));
  EXPECT_EQ(ask_manifest("','.join(sorted(m['files']))"), "checksums,manifest.json,steps.csv");
}

}  // namespace
}  // namespace cleave

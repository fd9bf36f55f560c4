// What the results of a run are known by: cleave run --print-key says it beforehand, the manifest afterwards.
#include <gtest/gtest.h>

#include <regex>

#include "harness/base/names.h"
#include "harness/files/build_info.h"
#include "partition/registry.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

std::string key_of(Arguments arguments) {
  arguments.push_back("--print-key");
  const ProgramResult result = run_cleave(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.out;
}

Arguments small_run(const std::string& out) {
  return {"run",      "--scene", "rock_pile", "--bodies", "3",     "--steps", "2",
          "--solver", "schur",   "--threads", "2",        "--out", out};
}

TEST(RunKey, IsWhatTheManifestHoldsAndRunsNothing) {
  const TemporaryDirectory directory;
  const std::string out = directory / "run";
  const std::string key = key_of(small_run(out));
  EXPECT_FALSE(std::filesystem::exists(out));
  Arguments nowhere = small_run(out);
  nowhere.resize(nowhere.size() - 2);  // nothing is written, so nothing has to be said of where
  EXPECT_EQ(key_of(nowhere), key);
  ASSERT_EQ(run_cleave(small_run(out)).exit_code, 0);
  const ProgramResult same = run_program(
      "/usr/bin/python3", {"-c",
                           "import json, sys; k, m = json.loads(sys.argv[1]), json.load(open(sys.argv[2])); "
                           "parts = {**m, **m['options'], **m['build'], **m['machine']}; "
                           "print({name: parts[name] for name in k} == k, sorted(k))",
                           key, directory / "run/manifest.json"});
  EXPECT_EQ(
      same.out,
      "True ['build_type', 'compiler', 'cores', 'cpu_model', 'flags', 'git_dirty', 'git_hash', 'run_id', "
      "'threads']\n")
      << same.err << key;
}

TEST(RunKey, AllStandsForTheNamesItExpandsTo) {
  Arguments all = small_run("x"), named = all, fewer = all;
  std::vector<std::string> names;
  for (const PartitionerEntry& entry : partitioners())
    if (reason_to_leave_out(entry, {}).empty() && !entry.traits.needs_groups) names.push_back(entry.name);
  all.insert(all.end(), {"--partitioner", "all", "--refiner", "all"});
  const std::string refiners_named = joined(names_of(refiners()), ",");
  named.insert(named.end(), {"--partitioner", joined(names, ","), "--refiner", refiners_named});
  fewer.insert(fewer.end(), {"--partitioner", joined(names, ","), "--refiner", "none,kl"});
  EXPECT_EQ(key_of(all), key_of(named));
  EXPECT_NE(key_of(all), key_of(fewer));
}

TEST(RunKey, BadOptionsAreRefusedAsInARun) {
  EXPECT_EQ(run_cleave({"run", "--scene", "rock_pile", "--mu", "-1", "--print-key"}).exit_code, 1);
}

TEST(Version, NamesVersionCommitStateAndCompiler) {
  const ProgramResult result = run_cleave({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  const std::regex form(
      R"(cleave \d+\.\d+\.\d+ \(commit ([0-9a-f]{40}|unknown), (clean|dirty|unknown)\) (GCC|Clang) .+\n)");
  EXPECT_TRUE(std::regex_match(result.out, form)) << result.out;
  EXPECT_EQ(version_text({"1.2.3", "abc", "true", "GCC 12", "", "", ""}),
            "cleave 1.2.3 (commit abc, dirty) GCC 12");
  EXPECT_EQ(version_text({"1.2.3", "abc", "false", "GCC 12", "", "", ""}),
            "cleave 1.2.3 (commit abc, clean) GCC 12");
}

}  // namespace
}  // namespace cleave

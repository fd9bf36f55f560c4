// cleave run: checks every option, then simulates and measures.
#include <cstdio>
#include <memory>

#include "harness/commands/command.h"
#include "harness/commands/run_command_line.h"
#include "harness/commands/simulate.h"
#include "harness/experiment/model_watch.h"
#include "harness/experiment/option_values.h"
#include "harness/experiment/options.h"
#include "harness/files/build_info.h"
#include "harness/files/json_writer.h"
#include "harness/files/manifest.h"

namespace cleave {
namespace {

// What a manifest of this run would be known by: the experiment, its threads, the build and the machine.
std::string key_text(const RunOptions& options) {
  const BuildInfo build = build_info();
  const MachineInfo machine = machine_info();
  JsonWriter json;
  json.begin_object();
  json.field("run_id", run_id(options));
  json.field("threads", options.threads);
  json.field("git_hash", build.git_hash);
  json.field("git_dirty", build.git_dirty);
  json.field("compiler", build.compiler);
  json.field("flags", build.flags);
  json.field("build_type", build.build_type);
  json.field("cpu_model", machine.cpu_model);
  json.field("cores", machine.cores);
  json.end_object();
  return json.text();
}

int run(std::map<std::string, std::string> given, bool print_key, const std::vector<std::string>& argv) {
  if (print_key) given.emplace("out", "-");  // nothing is written
  const RepeatedOptions all = with_config(given, "run", &CommandSet::run);
  const RunOptions options = parse_run_options(all.given, all.stored);
  if (print_key) {
    std::printf("%s", key_text(options).c_str());
    return kExitOk;
  }
  std::vector<std::string> files = {kStepsFile};
  if (options.record_motion) files.push_back(kMotionFile);
  if (options.explain_model) files.push_back(kFindingsFile);
  return simulate("run", argv, options, files);
}

}  // namespace

std::function<int()> declare_run(CLI::App& app, const std::vector<std::string>& argv) {
  const auto given = std::make_shared<std::map<std::string, std::string>>();
  const auto print_key = std::make_shared<bool>(false);
  declare_run_options(app, *given, &CommandSet::run);
  app.add_flag("--print-key", *print_key, "run nothing; print what its results would be known by");
  return [given, print_key, argv] { return run(*given, *print_key, argv); };
}

}  // namespace cleave

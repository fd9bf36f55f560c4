// cleave run: checks every option, then simulates and measures.
#include <memory>

#include "harness/commands/command.h"
#include "harness/commands/run_command_line.h"
#include "harness/commands/simulate.h"
#include "harness/options.h"
#include "harness/output_directory.h"

namespace cleave {
namespace {

int run(const std::map<std::string, std::string>& given, const std::vector<std::string>& argv) {
  const RunOptions options = parse_run_options(given);
  std::vector<std::string> files = {"steps.csv"};
  if (options.record_motion) files.push_back("motion.h5");
  check_output_directory(options.out, options.force, files);
  return simulate("run", argv, options);
}

}  // namespace

std::function<int()> declare_run(CLI::App& app, const std::vector<std::string>& argv) {
  const auto given = std::make_shared<std::map<std::string, std::string>>();
  declare_run_options(app, *given);
  declare_scene_options(app, *given);
  return [given, argv] { return run(*given, argv); };
}

}  // namespace cleave

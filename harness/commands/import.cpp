// cleave import: a problem of another program as a problem file.
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/base/printable_text.h"
#include "harness/base/refusals.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/command.h"
#include "harness/files/fclib_file.h"
#include "harness/files/fclib_problem.h"
#include "harness/files/problem_file.h"
#include "harness/files/problem_file_defaults.h"

namespace cleave {
namespace {

struct ImportOptions {
  std::string file, format, out, mass_blocks, dt;
  bool force = false;
};

const std::vector<std::string> kFormats = {"fclib"}, kMassBlocks = {"3", "6"};

// What the file says of itself is not overruled.
std::optional<int> unknowns_of_body(const ImportOptions& options, const FclibGlobal& global) {
  if (options.mass_blocks.empty()) return {};
  if (global.bodies)
    throw std::invalid_argument("--mass-blocks: " + options.file +
                                " says by cleave_bodies that they are 6x6; leave it out");
  return parse_integer("--mass-blocks", options.mass_blocks, {3, 6});
}

double step_of(const ImportOptions& options, const FclibGlobal& global) {
  if (global.h_s && !options.dt.empty())
    throw std::invalid_argument("--dt: " + options.file + " says by cleave_h_s that it is " +
                                number_text(*global.h_s) + "; leave it out");
  if (global.h_s) return *global.h_s;
  if (!options.dt.empty()) return parse_number("--dt", options.dt, {0, Range{}.max, true});
  say(options.file +
      ": says nothing of its step; h_s is 1, so that impulses are forces (--dt names another)");
  return 1;
}

ProblemFile read_fclib(const ImportOptions& options) {
  const FclibGlobal global = read_fclib_file(options.file);
  ProblemFile file;
  const std::optional<int> unknowns = unknowns_of_body(options, global);
  const double h_s = step_of(options, global);
  file.problem = in_context(options.file, [&] { return problem_of_fclib(global, unknowns); });
  file.problem.h_s = h_s;
  if (!file.problem.contact_set.empty()) file.friction_model = "coulomb";
  fill_left_out(file);
  return file;
}

int import_problem(const ImportOptions& options) {
  if (options.file.empty()) throw std::invalid_argument("FILE: a file to import is required");
  if (options.format.empty())
    throw std::invalid_argument("--format: is required; choices: " + joined(kFormats));
  check_name("--format", options.format, kFormats);
  if (!options.mass_blocks.empty()) check_name("--mass-blocks", options.mass_blocks, kMassBlocks);
  check_out_file(options.out, options.force);
  check_not_read(options.out, std::vector<std::filesystem::path>{options.file});
  const ProblemFile file = read_fclib(options);
  write_problem_file(options.out, file);
  say(options.out + ": " + std::to_string(file.problem.body_count()) + " bodies, " +
      std::to_string(file.problem.row_count()) + " rows");
  return kExitOk;
}

}  // namespace

std::function<int()> declare_import(CLI::App& app, const std::vector<std::string>&) {
  const auto options = std::make_shared<ImportOptions>();
  app.add_option("file", options->file, "file of the other program")->type_name("FILE");
  app.add_option("--format", options->format, "fclib: FCLIB 3.1, HDF5, the global form")->type_name("NAME");
  app.add_option("--mass-blocks", options->mass_blocks,
                 "unknowns of a body, 6 or 3; where not given 6, and 3 where contacts have one tangent")
      ->type_name("N");
  app.add_option("--dt", options->dt, "step, s, of a file that does not say it")->type_name("SECONDS");
  app.add_option("--out", options->out, "problem file to write")->type_name("PATH");
  app.add_flag("--force", options->force, "overwrite the file");
  return [options] { return import_problem(*options); };
}

}  // namespace cleave

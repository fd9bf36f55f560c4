// Reads manifest.json back, so that it can be given to the command that wrote it.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "harness/base/option_value.h"
#include "harness/files/build_info.h"

namespace cleave {

// The options that the manifest holds, by name, as a command line would give them: numbers in their one form
// of writing, truth values "true" or "false", a list one item a line. What is null or empty was not given and
// is left out. Throws std::invalid_argument with one line naming the file and what is wrong: not there, no
// JSON, another schema, another command than `command`, an option of no such form.
std::map<std::string, std::string> read_manifest_options(const std::filesystem::path& path,
                                                         const std::string& command);

// All of it that says what the rows of steps.csv have to be.
struct StoredManifest {
  std::string state, command, run_id;
  std::string git_hash, cpu_model, utc_start;  // empty: of a program that did not say
  BuildInfo build;                             // the same
  std::string steps_schema;                    // empty: of a program that did not say
  std::vector<OptionValue> options;  // name, kind and text, in their order; what is null has an empty text
  std::vector<NamedAlgorithm> algorithms;
  std::map<std::string, double> result;  // NaN where null
  std::vector<std::string> columns;
  std::vector<std::string> files;  // empty: of a program that did not say

  // Empty where there is no such option.
  std::string option(const std::string& name) const;
};

// Throws std::invalid_argument with one line naming the file and what is wrong: not there, no JSON, another
// schema, a member that is missing or of another form.
StoredManifest read_manifest(const std::filesystem::path& path);

}  // namespace cleave

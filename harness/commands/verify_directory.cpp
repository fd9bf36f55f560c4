#include "harness/commands/verify_directory.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "harness/base/refusals.h"
#include "harness/commands/expected_rows.h"
#include "harness/commands/verify_campaign.h"
#include "harness/commands/verify_problem_file.h"
#include "harness/commands/verify_rows.h"
#include "harness/files/checksums.h"
#include "harness/files/directory_lock.h"
#include "harness/files/manifest.h"
#include "harness/files/manifest_reader.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

bool is_problem_file(const fs::path& name) { return name.extension() == ".h5" && name != kMotionFile; }

// The manifest, where it can be read. One beside checksums is of a program that says files and schema.
std::optional<StoredManifest> check_manifest(const fs::path& directory, bool has_checksums, CheckList& list) {
  std::optional<StoredManifest> manifest;
  const std::string error = wrong_in([&] {
    manifest = read_manifest(directory / kManifestFile);
    std::string missing;
    if (has_checksums && manifest->files.empty()) missing += "; it has no files";
    if (has_checksums && manifest->steps_schema.empty()) missing += "; it has no steps_schema";
    return missing;
  });
  list.add(error.empty(), (directory / kManifestFile).string(), "readable" + error);
  return manifest;
}

void check_state(const fs::path& directory, const StoredManifest& manifest, CheckList& list) {
  std::string why = manifest.state == "complete" ? "" : "; incomplete: allowed is complete";
  if (manifest.state == "running") {
    const bool is_locked = !wrong_in([&] { check_not_locked(directory); }).empty();
    why = is_locked ? "; incomplete: it is still running" : "; incomplete: it was killed";
  }
  list.add(why.empty(), (directory / kManifestFile).string(), "state " + manifest.state + why);
}

void check_listed_files(const fs::path& directory, const std::map<std::string, std::string>& sums,
                        CheckList& list) {
  for (const auto& [name, sum] : sums) {
    const fs::path path = directory / name;
    std::error_code error;
    const std::string found = fs::is_regular_file(path, error) ? sha256_of(path) : "no such file";
    list.add(found == sum, path.string(),
             "sha256 " + found + (found == sum ? "" : "; " + std::string(kChecksumsFile) + " says " + sum));
  }
}

void check_other_files(const fs::path& directory, const std::map<std::string, std::string>& sums,
                       const std::vector<std::string>& besides, CheckList& list) {
  std::string others;
  for (const std::string& name : names_in(directory))
    if (!sums.contains(name) && name != kChecksumsFile && std::ranges::count(besides, name) == 0)
      others += "; " + name + " is not of this run";
  list.add(others.empty(), (directory / kChecksumsFile).string(),
           "names every file of the directory" + others);
}

// Nothing where the file is missing or no list of checksums.
std::optional<std::map<std::string, std::string>> check_list_of_files(
    const fs::path& directory, const std::vector<std::string>& required, CheckList& list) {
  std::optional<std::map<std::string, std::string>> sums;
  const std::string error = wrong_in([&] {
    sums = read_checksums(directory);
    std::string missing;
    for (const std::string& name : required)
      if (!sums->contains(name)) missing += "; " + name + " is not in it";
    return missing;
  });
  list.add(error.empty(), (directory / kChecksumsFile).string(), "readable" + error);
  return sums;
}

void check_run_id(const fs::path& directory, const StoredManifest& manifest, CheckList& list) {
  const std::string found = run_id_of(manifest);
  list.add(found == manifest.run_id, (directory / kManifestFile).string(),
           "run_id " + manifest.run_id + (found == manifest.run_id ? "" : "; its options give " + found));
}

const std::vector<std::string> kFilesOfRun = {kManifestFile, kStepsFile};

void check_problem_files(const fs::path& directory, CheckList& list) {
  for (const std::string& name : names_in(directory))
    if (is_problem_file(name))
      check_problem_file(directory / name, read_problem_file(directory / name), list);
}

}  // namespace

std::vector<std::string> names_in(const fs::path& directory) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory))
    names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

bool check_files(const fs::path& directory, const std::vector<std::string>& required,
                 const std::vector<std::string>& besides, CheckList& list) {
  const int before = list.failures();
  const auto sums = check_list_of_files(directory, required, list);
  if (sums) {
    check_listed_files(directory, *sums, list);
    check_other_files(directory, *sums, besides, list);
  }
  if (list.failures() == before) return true;
  CheckList::note(directory.string(),
                  "its files are not those that were written; what they say was not looked at");
  return false;
}

void verify_directory(const fs::path& directory, CheckList& list) {
  if (is_campaign(directory)) return verify_campaign(directory, list);
  const std::vector<std::string> names = names_in(directory);
  const auto holds = [&](const char* name) { return std::ranges::count(names, name) > 0; };
  const bool is_run = holds(kStepsFile) || holds(kManifestFile) || holds(kChecksumsFile);
  if (!is_run && std::ranges::none_of(names, is_problem_file))
    throw std::invalid_argument(directory.string() + ": holds neither problem files (.h5) nor steps.csv");
  if (!is_run) return check_problem_files(directory, list);

  // Checksums before all else: a damaged manifest cannot say that there were none.
  if (holds(kChecksumsFile) && !check_files(directory, kFilesOfRun, {}, list)) return;
  const auto manifest = check_manifest(directory, holds(kChecksumsFile), list);
  if (!manifest) return;
  check_state(directory, *manifest, list);
  const bool says_files = !manifest->files.empty();
  if (says_files && manifest->state == "complete" && !holds(kChecksumsFile) &&
      !check_files(directory, kFilesOfRun, {}, list))
    return;
  if (!says_files)
    CheckList::note(
        directory.string(),
        "of a program without checksums: bytes of the files, files too many and the run id were not checked");
  if (says_files) check_run_id(directory, *manifest, list);
  check_problem_files(directory, list);
  check_steps_table(directory, *manifest, list);
}

}  // namespace cleave

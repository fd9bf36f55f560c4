#include "harness/commands/vtu_series.h"

#include <list>
#include <stdexcept>
#include <tuple>

#include "harness/base/printable_text.h"
#include "harness/base/refusals.h"
#include "harness/base/stop_signals.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/command.h"
#include "harness/files/problem_file.h"
#include "harness/files/vtu_file.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

fs::path picture_name(const fs::path& out, std::size_t number) {
  return out.parent_path() / (out.stem().string() + "_" + std::to_string(number) + ".vtu");
}

// Whole under its name once it is published.
void add_file(const fs::path& path, const std::string& text, std::list<GrowingFile>& aside) {
  GrowingFile& file = aside.emplace_back(path);
  file.write(text);
  file.finish();
}

// Of one scene and later than the one before.
void check_follows(const std::string& path, const ProblemFile& file, const std::string& before,
                   const ProblemFile& last) {
  const auto scene = [](const ProblemFile& f) { return std::tie(f.scene, f.seed, f.problem.h_s); };
  const bool is_same = scene(file) == scene(last) && file.problem.body_count() == last.problem.body_count();
  if (is_same && file.step > last.step) return;
  throw std::invalid_argument("FILE: " + path + " is no later step of the simulation of " + before +
                              ", which a series asks for");
}

// Those that an earlier, longer series left.
void remove_rest(const fs::path& out, std::size_t count) {
  while (fs::remove(picture_name(out, count))) ++count;
}

}  // namespace

int write_vtu_series(const std::vector<std::string>& files, const fs::path& out, bool force) {
  for (std::size_t k = 0; k < files.size(); ++k) check_out_file(picture_name(out, k), force);
  stop_on_signals();
  std::list<GrowingFile> aside;
  std::vector<VtuAtTime> pictures;
  ProblemFile last;
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (stop_requested()) return kExitInterrupted;
    ProblemFile file = read_problem_file_aloud(files[k]);
    if (k > 0) check_follows(files[k], file, files[k - 1], last);
    const fs::path picture = picture_name(out, k);
    add_file(picture, in_context(files[k], [&] { return vtu_text(file); }), aside);
    pictures.push_back({file.step * file.problem.h_s, picture.filename().string()});
    last = std::move(file);
  }
  add_file(out, pvd_text(pictures), aside);
  for (GrowingFile& file : aside) file.publish();
  if (force) remove_rest(out, files.size());
  say(out.string() + ": " + std::to_string(pictures.size()) + " steps");
  return kExitOk;
}

}  // namespace cleave

#include "partition/part_file.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <stdexcept>

#include "harness/base/hash.h"
#include "harness/base/numbers.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& file, const std::string& text) {
  throw std::invalid_argument(file + ": " + text);
}

void add_ids(std::span<const int> part_of_body, Fnv1a64& hash) {
  for (const int part : part_of_body) hash.add(std::to_string(part) + "\n");
}

std::vector<int> read_ids(const std::string& path) {
  std::error_code error;
  if (!fs::exists(path, error)) fail(path, "no such file");
  std::ifstream file(path, std::ios::binary);
  if (!fs::is_regular_file(path, error) || !file) fail(path, "is not a readable file");
  std::vector<int> ids;
  for (std::string line; std::getline(file, line);) {
    int id = 0;
    if (!read_whole(line, id) || id < 0)
      fail(path,
           "line " + std::to_string(ids.size() + 1) + " is '" + line + "', allowed: a part id, 0 or more");
    ids.push_back(id);
  }
  return ids;
}

// Ids are 0 to k - 1 and each is used.
int checked_part_count(const std::string& path, const std::vector<int>& ids) {
  std::vector<int> used = ids;
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  const int parts = static_cast<int>(used.size());
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (ids[i] >= parts)
      fail(path, "line " + std::to_string(i + 1) + " is '" + std::to_string(ids[i]) + "', allowed: 0 to " +
                     std::to_string(parts - 1) + ", as there are " + std::to_string(parts) +
                     " different ids and no part may be empty");
  return parts;
}

// A file name around the number of its step.
struct StepName {
  std::string before, after;
  int digits = 0;  // at least so many, filled up with zeros

  std::string number(int step) const {
    char text[16];
    std::snprintf(text, sizeof text, "%0*d", digits, step);
    return text;
  }
  // The step whose file has this name.
  std::optional<int> step_of(const std::string& name) const {
    if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
      return std::nullopt;
    const std::string text = name.substr(before.size(), name.size() - before.size() - after.size());
    int step = 0;
    if (!read_whole(text, step) || step < 0 || number(step) != text) return std::nullopt;
    return step;
  }
};

// None: one file for all steps.
std::optional<StepName> step_name(const std::string& pattern) {
  static const std::regex placeholder(R"(\{step(?::0([1-9]))?\})");
  if (pattern.find_first_of("{}") == std::string::npos) return std::nullopt;
  const std::string name = fs::path(pattern).filename();
  std::smatch match;
  const bool found = std::regex_search(name, match, placeholder);
  const auto braces = std::ranges::count_if(pattern, [](char c) { return c == '{' || c == '}'; });
  if (!found || braces != 2)
    fail(pattern, "braces are for the step, allowed: {step} or {step:06}, once and in the file's name");
  return StepName{match.prefix(), match.suffix(), match[1].matched ? std::stoi(match[1]) : 1};
}

std::map<int, PartFile> read_steps(const std::string& pattern, const StepName& name) {
  const fs::path parent = fs::path(pattern).parent_path();
  std::error_code error;
  std::map<int, PartFile> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(parent.empty() ? "." : parent, error))
    if (const std::optional<int> step = name.step_of(entry.path().filename()))
      files.emplace(*step, read_part_file(entry.path()));
  if (files.empty()) fail(pattern, "no file is called so, with a step in place of the braces");
  return files;
}

}  // namespace

std::string part_ids_fingerprint(std::span<const int> part_of_body) {
  Fnv1a64 hash;
  add_ids(part_of_body, hash);
  return hex(hash.value());
}

PartFile read_part_file(const std::string& path) {
  PartFile file{path, {read_ids(path), 0}};
  file.partition.part_count = checked_part_count(path, file.partition.part_of_body);
  return file;
}

PartFiles::PartFiles(const std::string& pattern) : pattern_(pattern) {
  if (const std::optional<StepName> name = step_name(pattern)) {
    by_step_ = read_steps(pattern, *name);
  } else {
    for_all_ = read_part_file(pattern);
  }
}

std::string PartFiles::fingerprint() const {
  if (for_all_) return part_ids_fingerprint(for_all_->partition.part_of_body);
  Fnv1a64 hash;
  for (const auto& [step, file] : by_step_) {
    hash.add("step " + std::to_string(step) + "\n");
    add_ids(file.partition.part_of_body, hash);
  }
  return "steps-" + hex(hash.value());
}

const PartFile* PartFiles::find(std::optional<int> step) const {
  if (for_all_) return &*for_all_;
  const auto found = step ? by_step_.find(*step) : by_step_.end();
  return found == by_step_.end() ? nullptr : &found->second;
}

}  // namespace cleave

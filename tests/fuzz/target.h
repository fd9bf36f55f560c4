// What a fuzzer runs and the corpus test repeats: functions of bytes. See README.md.
#pragma once

#include <functional>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cleave::fuzz {

// A property that does not hold. Whatever leaves a target is a finding: this, an exception that its reader
// does not promise, or the end of the process.
struct Finding : std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool holds, const std::string& what) {
  if (!holds) throw Finding(what);
}

// Whether `read` ends as readers say that they do with what they do not take; the line then goes to `reason`.
inline bool refuses(const std::function<void()>& read, std::string* reason = nullptr) {
  const auto note = [reason](const std::exception& error) {
    require(*error.what() != '\0', "refused without a reason");
    if (reason != nullptr) *reason = error.what();
    return true;
  };
  try {
    read();
    return false;
  } catch (const std::invalid_argument& error) {
    return note(error);
  } catch (const std::runtime_error& error) {
    return note(error);
  }
}

using Random = std::mt19937;

struct Target {
  const char* name;  // also of its corpus folder
  void (*run)(std::string_view bytes);
  // Changes bytes that stand for something; null: the fuzzer's own changes do.
  std::string (*mutate)(const std::string& bytes, Random& random) = nullptr;
};

std::span<const Target> targets();

// The rows of targets().
void read_csv(std::string_view bytes);
void read_manifest_bytes(std::string_view bytes);
void read_options(std::string_view bytes);
std::string mutate_options(const std::string& bytes, Random& random);
void read_scene(std::string_view bytes);
void read_problem(std::string_view recipe);

}  // namespace cleave::fuzz

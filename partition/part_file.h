// Partitions in files, as METIS writes them (.part): one part id a line, one line a body, ids 0 to k - 1.
//
// A pattern names one file for all steps or, with {step} in the file's name, one file a step:
// parts_{step}.txt is parts_7.txt at step 7, parts_{step:06}.txt is parts_000007.txt.
//
// Fingerprints are FNV-1a-64 over the ids, each in decimal and ended by a line feed; these are the bytes that
// METIS writes, so that the fingerprint of a file of METIS is that of its bytes, and it can be computed again
// from the part ids alone.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "partition/partition.h"

namespace cleave {

// 16 hexadecimal digits.
std::string part_ids_fingerprint(std::span<const int> part_of_body);

struct PartFile {
  std::string path;
  Partition partition;
};

// Throws std::invalid_argument with one line that names the file, the line, its text and what is allowed: not
// readable, a line that is no part id, ids that leave a part empty.
PartFile read_part_file(const std::string& path);

class PartFiles {
 public:
  // Reads everything that the pattern names. Throws as read_part_file, and for a pattern that is none or
  // names nothing.
  explicit PartFiles(const std::string& pattern);

  // Of one file for all: part_ids_fingerprint. Of one file a step: "steps-" and 16 hexadecimal digits over
  // "step N\n" and the ids of every file in the order of steps; one step alone does not give it again.
  std::string fingerprint() const;

  // The file of a step, or nullptr. Of one file for all the step does not matter.
  const PartFile* find(std::optional<int> step) const;

  // Calls visitor(const PartFile&) for every file, in the order of steps.
  template <class Visitor>
  void visit(Visitor&& visitor) const {
    if (for_all_) visitor(*for_all_);
    for (const auto& [step, file] : by_step_) visitor(file);
  }

  const std::string& pattern() const { return pattern_; }

 private:
  std::string pattern_;
  std::optional<PartFile> for_all_;
  std::map<int, PartFile> by_step_;
};

}  // namespace cleave

// What a problem file says of itself, so that a changed bit is noticed: three hashes over all that is read
// from it, and a mark that they must be there.
#pragma once

#include <string>

#include "harness/files/problem_file.h"

namespace cleave {

// As attributes of the file, 16 hexadecimal digits each; empty where it has none.
struct StoredHashes {
  std::string written_by;   // kWrittenByCleave: a file without all three was damaged
  std::string problem;      // problem_hash of solver/problem_hash.h
  std::string description;  // of the rest: scene, step, seed, friction model, poses, groups, shapes, ...
  std::string solutions;    // of all solutions and partitions with their labels
  bool operator==(const StoredHashes&) const = default;
};

inline const std::string kWrittenByCleave = "cleave";

template <class Hashes, class Visitor>
void visit_hashes(Hashes& hashes, Visitor&& visit) {
  visit("written_by", hashes.written_by);
  visit("problem_hash", hashes.problem);
  visit("description_hash", hashes.description);
  visit("solutions_hash", hashes.solutions);
}

// Those that cleave writes into this file.
StoredHashes hashes_of(const ProblemFile& file);

// A parameter as it reads back from its attribute: equal values are equal texts.
StoredParameter as_stored(const StoredParameter& parameter);

// Empty where the file bears out what it says, or says nothing; else what is wrong, without the file's name.
std::string find_hash_error(const ProblemFile& file, const StoredHashes& stored);

}  // namespace cleave

// The three fingerprints of a row of steps.csv: 64-bit FNV-1a (Fowler, Noll, Vo) over little-endian data.
//
// Equal hashes on two machines or thread counts mean equal bytes, so one column settles whether two runs
// agree.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "solver/step_problem.h"

namespace cleave {

class Fnv1a64 {
 public:
  void add(std::span<const double> values);
  void add(std::span<const int> values);
  void add(std::span<const RowKind> values);
  void add(std::string_view text);
  std::uint64_t value() const { return value_; }

 private:
  void add_bytes(const void* data, std::size_t size);
  std::uint64_t value_ = 0xcbf29ce484222325u;  // the offset basis of FNV-1a-64
};

// h_s, then all arrays in the order in which StepProblem declares them, without lengths.
std::uint64_t problem_hash(const StepProblem& problem);

// The impulses (m), then the part ids (n; none for a solver that ignores parts).
std::uint64_t solution_hash(std::span<const double> impulse, std::span<const int> part_of_body);

// 16 hexadecimal digits.
std::string hex(std::uint64_t value);

}  // namespace cleave

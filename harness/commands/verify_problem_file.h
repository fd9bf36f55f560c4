// What `cleave verify` finds out from one problem file alone.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/commands/check_list.h"
#include "harness/files/problem_file.h"

namespace cleave {

// The judge's numbers agree: equal up to the last digits, or both no numbers.
bool same_residual(double stored_m_per_s, double found_m_per_s);

// Index of the first id outside [0, n), or -1.
int find_bad_part_id(const std::vector<int>& part_of_body);

// Of the file: its friction model. Of every solution: its label, its residual judged anew against the stored
// one, its velocity against v0 + M^-1 J^T impulse. Of every partition: its label, its part ids, and the same
// parts when the stored partitioner and refiner split the problem again with the stored options.
void check_problem_file(const std::filesystem::path& path, const ProblemFile& file, CheckList& list);

}  // namespace cleave

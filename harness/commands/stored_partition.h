// Between the partition of a combination and what a problem file keeps of it.
#pragma once

#include <vector>

#include "harness/base/algorithm.h"
#include "harness/experiment/splitter.h"
#include "harness/files/problem_file.h"

namespace cleave {

// With every parameter that shaped it, and where it is not fresh, its origin.
StoredPartition stored_partition(const SplitSetup& setup, std::vector<int> part_of_body,
                                 std::vector<int> parent_of_part, PartitionOrigin origin);

// Throws std::invalid_argument for a word that is none.
PartitionOrigin read_origin(const StoredPartition& partition);

// What a partitioner chose to make the parts; empty where it chose nothing.
std::string read_choice(const StoredPartition& partition);

// Whether bodies were numbered by a file, without which nobody can split them again.
bool has_order_of_file(const StoredPartition& partition);

// Throws std::invalid_argument with one line: a body order that was a file's, an algorithm that is none of
// ours, a parameter that is missing, of another type or outside its range.
SplitSetup read_split_setup(const StoredPartition& partition);

// Its refiner alone; the same errors.
Algorithm read_stored_refiner(const StoredPartition& partition);

}  // namespace cleave

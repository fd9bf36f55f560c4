// What `cleave verify` finds out about steps.csv.
#pragma once

#include <filesystem>

#include "harness/commands/verify_checks.h"

namespace cleave {

// Every row that says ok lies within the judge's limit by its own numbers. Every row whose problem file is in
// the directory, or where the row says it is, agrees with what is computed anew from that file: sizes,
// islands and fingerprint of the problem, and where the file holds the row's solution, the judge's residuals,
// the counts of the partition, the interface of schur-rows and the fingerprint of the solution.
void check_steps_table(const std::filesystem::path& directory, CheckList& list);

}  // namespace cleave

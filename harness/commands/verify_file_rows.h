// Rows of steps.csv against the problem files they speak of.
#pragma once

#include <filesystem>

#include "harness/commands/check_list.h"
#include "harness/commands/expected_rows.h"
#include "harness/commands/verify_table.h"

namespace cleave {

// Every row whose problem lies in a file, beside steps.csv or where the row says: sizes, islands and
// fingerprint of the problem, and where the file holds the row's solution, the judge's numbers, the counts of
// the partition and of the one it was refined from, measures of the cell, the interface of schur-rows and the
// fingerprint of the solution. Of a replay that wrote solutions, a row without its solution is wrong; of one
// with --friction, a row speaks of the problem with that model.
void check_file_rows(const std::filesystem::path& directory, const StepsTable& table,
                     const StoredManifest& manifest, CheckList& list);

}  // namespace cleave

// What the rows of steps.csv say of each other, and the manifest of all of them.
#pragma once

#include <string>

#include "harness/commands/check_list.h"
#include "harness/commands/expected_rows.h"
#include "harness/commands/verify_table.h"

namespace cleave {

// What all rows of a problem share, and what those share that grew or refined the same parts.
void check_rows_of_problems(const StepsTable& table, const ExpectedRows& expected, const std::string& subject,
                            CheckList& list);

// The counts in the manifest are those of the rows.
void check_totals(const StepsTable& table, const ExpectedRows& expected, const StoredManifest& manifest,
                  const std::string& subject, CheckList& list);

}  // namespace cleave

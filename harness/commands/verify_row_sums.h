// What the cells of one row of steps.csv say of each other: needs no other file.
#pragma once

#include <string>

#include "harness/commands/check_list.h"
#include "harness/commands/verify_table.h"

namespace cleave {

// Every cell reads as what its column holds; without that no other check of the rows is made. Returns whether
// so.
bool check_cells(const StepsTable& table, const std::string& subject, CheckList& list);

// Sums, orders and what a status implies, row by row.
void check_rows_alone(const StepsTable& table, const std::string& subject, CheckList& list);

// By the row's own numbers: its residual is within the limit of exact.
bool residual_is_exact(const StepsTable& table, std::size_t row);

// The model's last solve had every row of the problem.
bool solved_all_rows(const StepsTable& table, std::size_t row);

}  // namespace cleave

// Options that change the list of algorithms which others name.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "harness/experiment/options.h"

namespace cleave {

// --strategy and --kernel: one or both halves of every solver name.
void override_solvers(const std::map<std::string, std::string>& given, RunOptions& options);

// --objective: every refiner by the one that has it, and every partitioner that has a twin of that objective
// by its twin. After leave_out_unable.
void override_objective(RunOptions& options);

// Takes out of options.partitioners those that stand for `all` and that `why` gives a reason for ("which
// ..."); the reason goes to the notes.
void leave_out_of_all(const std::function<std::string(const Algorithm& partitioner)>& why,
                      RunOptions& options);

// What `all` stands for can do what is asked of it; what is named beside it is refused elsewhere if it
// cannot.
void leave_out_unable(const std::map<std::string, std::string>& given, RunOptions& options);

}  // namespace cleave

// The options of a run as texts, for its manifest and its id.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/base/option_value.h"
#include "harness/experiment/options.h"

namespace cleave {

// Every option with its value as text: the table's, the parameters of algorithms, the scene's; what the
// manifest holds.
std::vector<OptionValue> option_values(const RunOptions& options);

// Every algorithm that the run was asked for, in the order of its rows.
std::vector<NamedAlgorithm> named_algorithms(const RunOptions& options);

// Fingerprint of all options but those that change no row: 16 hexadecimal digits.
std::string run_id(std::span<const OptionValue> values);
inline std::string run_id(const RunOptions& options) { return run_id(option_values(options)); }

}  // namespace cleave

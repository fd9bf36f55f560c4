// A run that was: the options its manifest holds, beside those given now.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "harness/experiment/options.h"

namespace cleave {

struct RepeatedOptions {
  std::map<std::string, std::string> given;
  std::set<std::string> stored;  // names in `given` that nobody gave now
};

// Joins them so that the command parses them as if all were given; with none given now the run is the same.
// `given` wins, and with it go the stored options that it replaces:
//     --erp, --cfm              --stiffness, --damping (their erp and cfm stay)
//     --stiffness, --damping    --erp, --cfm
//     --solver                  --strategy, --kernel
//     --partitioner, --refiner  --objective
//     --session                 --repeats
//     --scene of another name   the options of the stored scene
// Stored defaults that cannot be given beside others (--erp with --stiffness, --advance in --mode separate)
// are left out, and --out and --force with them. own: options that the command alone declares. Throws
// std::invalid_argument for a stored option that no command has, and for an algorithm that was read from a
// file and is known by its content, unless its option is given.
RepeatedOptions repeated_options(const std::map<std::string, std::string>& stored,
                                 const std::map<std::string, std::string>& given, bool CommandSet::*command,
                                 const std::vector<std::string>& own);

// The options that may name files.
inline constexpr std::array kOptionsOfFiles = {"scene",  "partitioner", "refiner",
                                               "solver", "body-order",  "calibration"};

// The options of a run that a file decided of which they tell the content alone, by a fingerprint: whoever
// repeats the run has to name it again.
std::vector<std::string> options_of_files(const std::map<std::string, std::string>& stored);

}  // namespace cleave

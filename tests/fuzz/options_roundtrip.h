#pragma once

#include <map>
#include <string>

#include "harness/experiment/options.h"

namespace cleave::fuzz {

// Refused as documented, or options that a manifest repeats: given back, they are the same run.
void check_options(bool CommandSet::*command, const std::map<std::string, std::string>& stored,
                   const std::map<std::string, std::string>& given);

}  // namespace cleave::fuzz

// What `cleave verify` finds out about a campaign: its indexes, its cells, its logs.
#pragma once

#include <filesystem>

#include "harness/commands/check_list.h"

namespace cleave {

// By what lies there: an index, or shares of one.
bool is_campaign(const std::filesystem::path& directory);

// Every index is as it was written and has the cells of its spec; every cell has ended, its directory
// verifies, or is what a failed process left, and the index says of it what it says itself; there is nothing
// else.
void verify_campaign(const std::filesystem::path& directory, CheckList& list);

}  // namespace cleave

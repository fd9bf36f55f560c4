// What the commands share that leave an output directory: they end on the first interrupt, say how it went
// and turn that into an exit code.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/experiment/options.h"
#include "harness/experiment/run_summary.h"
#include "harness/files/manifest.h"

namespace cleave {

// True once the program was interrupted (SIGINT, SIGTERM) inside do_manifested_work.
const std::atomic<bool>& stop_requested();

// Does the work between the two writings of the directory's manifest.json. The first signal is for the work
// to see in stop_requested(); a second one ends the program at once. Prints the summary on stderr and returns
// the exit code.
int do_manifested_work(const std::filesystem::path& directory, const WorkDescription& description,
                       const std::function<RunSummary()>& work);

// What a command's manifest begins with. values: all of its options.
WorkDescription describe_work(const std::string& command, const std::vector<std::string>& argv,
                              const RunOptions& options, const std::vector<OptionValue>& values);

// Says what keywords such as `all` left out.
void print_left_out(const RunOptions& options);

}  // namespace cleave

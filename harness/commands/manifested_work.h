// What the commands share that leave an output directory: they end on the first interrupt, say how it went
// and turn that into an exit code.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/experiment/options.h"
#include "harness/experiment/run_summary.h"
#include "harness/files/manifest.h"

namespace cleave {

// Creates the directory, holds its lock (files/directory_lock), takes away what --force overwrites, and does
// the work between the two writings of manifest.json; `checksums` comes last. The first signal to stop
// (stop_signals.h) is for the work to see; a second one ends the program at once. Prints the summary on
// stderr and returns the exit code. Everything must have been checked that can be refused.
int do_manifested_work(const RunOptions& options, const WorkDescription& description,
                       const std::function<RunSummary()>& work);

// What a command's manifest begins with. values: all of its options. files: those it writes into the
// directory beside the manifest and the checksums.
WorkDescription describe_work(const std::string& command, const std::vector<std::string>& argv,
                              const RunOptions& options, const std::vector<OptionValue>& values,
                              const std::vector<std::string>& files);

}  // namespace cleave

// What the commands share that leave an output directory: they end on the first interrupt, say how it went
// and turn that into an exit code.
#pragma once

#include <atomic>
#include <functional>

#include "harness/manifest.h"
#include "harness/run_summary.h"

namespace cleave {

// True once the program was interrupted (SIGINT, SIGTERM) inside do_manifested_work.
const std::atomic<bool>& stop_requested();

// Does the work between the two writings of the manifest. The first signal is for the work to see in
// stop_requested(); a second one ends the program at once. Prints the summary on stderr and returns the exit
// code.
int do_manifested_work(Manifest& manifest, const std::function<RunSummary()>& work);

}  // namespace cleave

// Runs the cells of a campaign, each as a process of its own.
#pragma once

#include "harness/campaign/campaign.h"

namespace cleave {

struct SweepSummary {
  int kept = 0;       // cells that had ended before
  int elsewhere = 0;  // cells that another process was running
  bool interrupted = false;
};

// Runs what is pending, nothing for a merge, into options.out and keeps the index. Everything must have been
// checked that can be refused. The first signal to stop (stop_signals.h) is passed on to the cells, which
// end; a second one ends the program at once. Throws std::runtime_error for what cannot be written, having
// ended the cells that ran.
SweepSummary run_campaign(const SweepOptions& options, const std::string& spec_text, Campaign& campaign);

// Cores that this process may use, by number.
std::vector<int> usable_cores();

}  // namespace cleave

// What handing out tasks costs on this machine, measured on empty ones with the program's own threads.
#pragma once

#include "solver/stage_times.h"

namespace cleave {

// With a team of two threads, which is made and dismissed: medians, in about 10 ms. Where the two do not get
// a core each it is tried again, for some tenths of a second at most, and the last try counts: a stage then
// costs as much as the machine made it wait. All NaN where the system grants no second thread: nothing is
// known of more workers then. How much more threads contend for queues is not in it.
DispatchCost measure_dispatch_cost();

// Of this process: measured when it is first asked for.
const DispatchCost& dispatch_cost();

}  // namespace cleave

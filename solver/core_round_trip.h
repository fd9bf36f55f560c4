// How far apart the cores of a solve's threads are: where they share no cache, every line that two threads
// write in turn takes several times longer, and small solves on several threads about twice as long. A
// virtual machine may be moved from cores that share one to cores that do not and back, within seconds.
#pragma once

#include <chrono>

namespace cleave {

// Time in ns of a number from one thread of the team of so many threads to another and back: the least of a
// few batches, which take about 0.1 ms. NaN on one thread, and where two threads have not met and done their
// trips within the patience: a solve does not wait for a core that others keep busy.
double core_round_trip_ns(int threads, std::chrono::nanoseconds patience = std::chrono::microseconds(500));

}  // namespace cleave

// Counts calls of the global operator new (all forms, all threads) while an AllocationCount lives, and their
// bytes. The replacement of operator new is part of the test program that links allocation_counter.cpp;
// malloc inside C libraries is not seen.
#pragma once

namespace cleave {

class AllocationCount {
 public:
  AllocationCount();
  ~AllocationCount();
  AllocationCount(const AllocationCount&) = delete;
  AllocationCount& operator=(const AllocationCount&) = delete;

  long count() const;       // since this object was made
  long peak_bytes() const;  // most that were allocated and not yet freed again, since then
};

}  // namespace cleave

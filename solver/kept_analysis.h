// A kernel's analysis, kept from one solve to the next.
//
// It serves again where bodies and parts are the same and the rows join the same bodies, or pairs that the
// analysed pattern has a place for. What the kernel looks at of the parts is held here until it is given
// others.
#pragma once

#include <vector>

#include "solver/kernels/kernel.h"
#include "solver/prepared_step.h"

namespace cleave {

class KeptAnalysis {
 public:
  // may_keep: false, it is made anew. Throws MemoryRefused where the kernel asks for too much.
  void analyze(Kernel& kernel, const PreparedStep& step, const Parts& parts, bool may_keep,
               ParallelTasks& tasks);
  void forget() { is_made_ = false; }

 private:
  bool serves(Kernel& kernel, const PreparedStep& step, const Parts& parts, ParallelTasks& tasks);
  Parts parts() const { return Parts(part_of_body_, parent_of_part_); }

  bool is_made_ = false;
  int bodies_ = 0;
  std::vector<int> row_body_, part_of_body_, parent_of_part_;
};

}  // namespace cleave

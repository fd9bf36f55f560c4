// The modelled time of a partition (cost_model.h), kept up while single bodies move.
//
// For schur-rows only the two parts that a body leaves and joins are counted anew, and the interface follows
// from the number of cut rows. A move under schur-bodies may change the vertex cover, and with it everything,
// so all is counted anew.
#pragma once

#include <vector>

#include "partition/cost_model.h"

namespace cleave {

class PartitionCost {
 public:
  // The partition is changed by nobody else.
  PartitionCost(const BodyGraph& graph, const KernelCost& cost, const Partition& start);

  // Of the present parts, exactly as if they had been counted from scratch.
  double ms() const { return ms_; }
  // Moves a body to another part if that takes less time, and says whether it did. No part may be emptied.
  bool move_if_cheaper(int body, int part);

 private:
  void move(int body, int part);
  // After a move between these parts. False, and nothing changed, where the time has not fallen.
  bool count_parts(int from, int to);
  bool count_all();
  bool is_cheaper();

  const KernelCost cost_;
  CostCounter counter_;
  Partition partition_;
  std::vector<std::vector<int>> bodies_;  // by part, ascending
  CostFeatures features_;
  double ms_;
};

}  // namespace cleave

// Chooses by degree, for the seed of a part and for every body that joins it: the least (mindp, mix) or the
// greatest (maxdp); ties go to the lowest body index.
//
// degree(i) = number of distinct bodies adjacent to i (DegreeUnit::bodies), or of the joints and contact
// points with them (DegreeUnit::constraints). DegreeScope::whole counts all adjacent bodies,
// DegreeScope::left only those in G0; the bodies of the open part are no longer in G0.
#pragma once

#include <vector>

#include "partition/grow.h"
#include "partition/parameters.h"

namespace cleave {

struct Degree {
  DegreeUnit unit;
  DegreeScope scope;
};

// The parameters degree and degree-scope.
Degree read_degree(const Settings& settings);

class DegreeChooser : public Chooser {
 public:
  enum class Order { least, greatest };

  DegreeChooser(const BodyGraph& graph, Order order, Degree degree);

  int seed(const Growth& growth) override;
  int next(const Growth& growth) override;
  void joined(const Growth& growth, int body) override;

 private:
  int pop_true(const Growth& growth, BodyHeap& heap) const;

  const int sign_;         // key = sign * degree, so that the lowest key is wanted
  const EdgeWeight unit_;  // the edge weight that adds up to the degree
  const DegreeScope scope_;
  std::vector<int> key_;          // (n)
  std::vector<int> adjacent_to_;  // (n): the last part the body was found adjacent to, -1 for none
  BodyHeap left_;                 // G0
  BodyHeap adjacent_;             // G0 adjacent to the open part
};

}  // namespace cleave

// A partitioner splits the bodies of a step into parts of at most max_bodies.
//
// All five of the paper (Liu & Andrews 2022, section 3.1) grow parts with one loop (grow.h) and differ in the
// body they choose next. Ties: lowest body index. To add one: a new file and a row in registry.cpp.
#pragma once

#include "partition/body_graph.h"
#include "partition/partition.h"

namespace cleave {

// What a body's degree counts (--degree): distinct adjacent bodies, or joints + contact points.
enum class DegreeUnit { bodies, constraints };
// Where it is counted: in the whole graph, or among the bodies that are not yet in a part (the part being
// grown is one).
enum class DegreeScope { whole, left };

struct PartitionOptions {
  int max_bodies = 25;   // n_max: most bodies of a part while growing, >= 1
  double tau_mr = 10.0;  // mr: joins bodies with mass ratio strictly below this, > 1
  double tau_mix = 0.5;  // mix: least degree decides while size < tau_mix * max_bodies, in [0, 1]
  EdgeWeight edge_weight = EdgeWeight::rows;  // mix: weight of an edge into the part
  DegreeUnit degree = DegreeUnit::bodies;     // mindp, maxdp, mix
  DegreeScope degree_scope = DegreeScope::left;  // measured to cut fewer rows with mindp and mix, see README
  bool as_printed = false;  // the paper to the letter: constraints as maxdp's degree and mix's edge weight
};

class Partitioner {
 public:
  virtual ~Partitioner() = default;

  // Checks the options (std::invalid_argument naming the field, its value and the allowed range), runs, and
  // asserts that every body is in exactly one part, parts are contiguous, none is empty and none exceeds
  // max_bodies.
  Partition run(const BodyGraph& graph, const PartitionOptions& options) const;

 private:
  virtual Partition do_run(const BodyGraph& graph, const PartitionOptions& options) const = 0;
};

}  // namespace cleave

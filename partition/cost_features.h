// What a partition makes a kernel do in one solve, counted from the body graph and the part ids alone.
//
//   monolithic     one factor of all bodies
//   schur-bodies   one factor, the bodies of a vertex cover of the cut last: what follows them is the
//                  interface
//   schur-nested   one factor, such a cover at every node of the tree of parts (cut_cover.h), children first
//   schur-rows     a factor for every part; the interface is dense and has the cut rows whose weight is not
//                  zero (Liu & Andrews 2022, section 2). How many these are the partition does not say: a
//                  share of them
//
// Flops are multiplications and additions, as the solvers count theirs. For schur-rows, with s_p sides of
// interface rows in the subtree of column p of a part, b_p blocks below it and c rows of the interface,
//
//     factor_flops = sum_p sum_{k=1..6} (6 b_p + k)^2            the factor L of the part
//     form_flops   = sum_p (36 + 72 b_p) s_p + 6 s_p^2           Y = L^-1 J^T, then half of Y^T Y
//     entries      = sum_p 36 (1 + b_p) + 6 s_p                  numbers that a substitution reads
//     interface    = c (c + 1) (2 c + 1) / 6 flops, c (c + 1) / 2 entries
#pragma once

#include <span>
#include <vector>

#include "partition/body_graph.h"
#include "partition/elimination.h"
#include "partition/partition.h"

namespace cleave {

enum class CostKernel { schur_rows, schur_bodies, schur_nested, monolithic };
// Their names, in that order; those of the solver's kernels.
std::span<const char* const> cost_kernel_names();

struct PartCost {
  int bodies = 0;
  int rows = 0;      // inside, those with static geometry among them
  int cut_rows = 0;  // that touch the part
  double factor_flops = 0, form_flops = 0;
  double blocks = 0;  // of the factor
  double entries = 0;
};

struct CostFeatures {
  CostKernel kernel = CostKernel::schur_rows;
  std::vector<PartCost> parts;  // of monolithic one
  int bodies = 0, edges = 0;    // of the graph
  double mass_spread = 0;       // standard deviation of ln(mass), of its bodies
  int rows = 0;                 // of the step
  int fixed_rows = 0;           // of these with static geometry
  int cut_rows = 0;             // 0 for monolithic
  int cover_bodies = 0;         // of greedy covers of the cut; the kernel's own may be smaller; 0 for others
  double interface_unknowns = 0;  // expected size of the interface: rows, or six a body
  double interface_flops = 0, interface_entries = 0;
  double interface_blocks = 0;  // of a factor in body space
};

// Counts, and counts again after single bodies have moved (schur-rows only).
class CostCounter {
 public:
  // active_share: of the cut rows, those in the interface of schur-rows; in [0, 1].
  CostCounter(const BodyGraph& graph, CostKernel kernel, double active_share);

  // From scratch. Parts of one level are a tree of one to schur-nested; other kernels look at no tree.
  CostFeatures count(const Partition& partition);

  // schur-rows: one part anew; bodies: its own.
  PartCost count_part(std::span<const int> bodies, std::span<const int> part_of_body);
  // schur-rows: what follows from cut_rows.
  void set_interface(int cut_rows, CostFeatures& features) const;

 private:
  void count_whole(const Partition& partition, CostFeatures& features);
  void count_parts(const Partition& partition, CostFeatures& features);

  const BodyGraph& graph_;
  const CostKernel kernel_;
  const double active_share_, mass_spread_;
  int fixed_rows_ = 0;
  Eliminator eliminator_;
  std::vector<double> sides_;  // scratch: by column
};

}  // namespace cleave

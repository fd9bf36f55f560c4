// none: leaves the partition as it was grown (the paper's combinations without refinement).
#include <memory>

#include "partition/refiner.h"

namespace cleave {
namespace {

class None final : public Refiner {
  RefineSummary do_run(const BodyGraph& graph, const RefineOptions& options,
                       Partition& partition) const override {
    const long cut = cut_weight(graph, partition.part_of_body, options.edge_weight);
    return {0, cut, cut};
  }
};

}  // namespace

std::unique_ptr<Refiner> make_none() { return std::make_unique<None>(); }

}  // namespace cleave

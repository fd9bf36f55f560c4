// none: leaves the partition as it was grown (the paper's combinations without refinement).
#include <memory>

#include "partition/refiner.h"

namespace cleave {
namespace {

class None final : public Refiner {
 public:
  None() : Refiner(EdgeWeight::rows) {}

 private:
  RefineSummary do_run(const BodyGraph& graph, int, Partition& partition) const override {
    const long cut = cut_weight(graph, partition.part_of_body, unit());
    return {0, cut, cut};
  }
};

}  // namespace

std::unique_ptr<Refiner> make_none(const Settings&) { return std::make_unique<None>(); }

}  // namespace cleave

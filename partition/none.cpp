// none: leaves the partition as it was grown (the paper's combinations without refinement).
#include <memory>

#include "partition/refiner.h"

namespace cleave {
namespace {

class None final : public Refiner {
 public:
  None() : Refiner(EdgeWeight::rows) {}

 private:
  void do_run(const BodyGraph&, int, Partition&, RefineSummary&) const override {}
};

}  // namespace

std::unique_ptr<Refiner> make_none(const Settings&) { return std::make_unique<None>(); }

}  // namespace cleave

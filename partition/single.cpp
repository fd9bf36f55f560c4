// single: one part with all bodies, as a control: what a solver of parts costs where there is nothing to
// share.
#include <memory>

#include "harness/base/parameter.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

class Single final : public Partitioner {
  Partition do_run(const BodyGraph& graph) const override {
    return {std::vector<int>(graph.body_count(), 0), graph.body_count() > 0 ? 1 : 0};
  }
};

}  // namespace

std::unique_ptr<Partitioner> make_single(const Settings&) { return std::make_unique<Single>(); }

}  // namespace cleave

// mindp: every part grows from the body of least degree in G0 by the body of least degree adjacent to it (Liu
// & Andrews 2022, section 3.1). Thinly connected bodies go first, so that parts start at the rim of a heap.
#include <memory>

#include "partition/degree_chooser.h"

namespace cleave {
namespace {

class MinDegree final : public Partitioner {
  Partition do_run(const BodyGraph& graph, const PartitionOptions& options) const override {
    DegreeChooser chooser(graph, DegreeChooser::Order::least, options.degree, options.degree_scope);
    return grow(graph, options.max_bodies, chooser);
  }
};

}  // namespace

std::unique_ptr<Partitioner> make_mindp() { return std::make_unique<MinDegree>(); }

}  // namespace cleave

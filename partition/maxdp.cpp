// maxdp: every part grows from the body of greatest degree in G0 by the body of greatest degree adjacent to
// it (Liu & Andrews 2022, section 3.1). The paper speaks of the body "with more connected constraints";
// as_printed takes it at its word and counts constraints as degree.
#include <memory>

#include "partition/degree_chooser.h"

namespace cleave {
namespace {

class MaxDegree final : public Partitioner {
  Partition do_run(const BodyGraph& graph, const PartitionOptions& options) const override {
    const DegreeUnit unit = options.as_printed ? DegreeUnit::constraints : options.degree;
    DegreeChooser chooser(graph, DegreeChooser::Order::greatest, unit, options.degree_scope);
    return grow(graph, options.max_bodies, chooser);
  }
};

}  // namespace

std::unique_ptr<Partitioner> make_maxdp() { return std::make_unique<MaxDegree>(); }

}  // namespace cleave

// maxdp: every part grows from the body of greatest degree in G0 by the body of greatest degree adjacent to
// it (Liu & Andrews 2022, section 3.1). The paper speaks of the body "with more connected constraints";
// as_printed takes it at its word and counts constraints as degree.
#include <memory>

#include "partition/degree_chooser.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

class MaxDegree final : public Partitioner {
 public:
  explicit MaxDegree(const Settings& settings)
      : max_bodies_(settings.integer("max-bodies")), degree_(read_degree(settings)) {
    if (settings.flag("as-printed")) degree_.unit = DegreeUnit::constraints;
  }

 private:
  Partition do_run(const BodyGraph& graph) const override {
    DegreeChooser chooser(graph, DegreeChooser::Order::greatest, degree_);
    return grow(graph, max_bodies_, chooser);
  }

  int max_bodies_;
  Degree degree_;
};

}  // namespace

std::unique_ptr<Partitioner> make_maxdp(const Settings& settings) {
  return std::make_unique<MaxDegree>(settings);
}

}  // namespace cleave

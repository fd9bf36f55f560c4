// mindp: every part grows from the body of least degree in G0 by the body of least degree adjacent to it (Liu
// & Andrews 2022, section 3.1). Thinly connected bodies go first, so that parts start at the rim of a heap.
#include <memory>

#include "partition/degree_chooser.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

class MinDegree final : public Partitioner {
 public:
  explicit MinDegree(const Settings& settings)
      : max_bodies_(settings.integer("max-bodies")), degree_(read_degree(settings)) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    DegreeChooser chooser(graph, DegreeChooser::Order::least, degree_);
    return grow(graph, max_bodies_, chooser);
  }

  int max_bodies_;
  Degree degree_;
};

}  // namespace

std::unique_ptr<Partitioner> make_mindp(const Settings& settings) {
  return std::make_unique<MinDegree>(settings);
}

}  // namespace cleave

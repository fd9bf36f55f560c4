// fm-hill: moves single bodies in passes that also take steps that raise the cut (Fiduccia & Mattheyses 1982,
// between many parts at a time as in Sanchis 1989).
//
// A pass is one climb (hill_climb.h, bound as in fm), in which every body may move once. Passes follow until
// one does not lower the cut, so the result is never worse than the start.
#include <memory>

#include "partition/hill_climb.h"
#include "partition/parameters.h"
#include "partition/refiner.h"

namespace cleave {
namespace {

class FmHill final : public Refiner {
 public:
  explicit FmHill(const Settings& settings)
      : Refiner(settings.word<EdgeWeight>(parameters::edge_weight())),
        max_growth_(settings.number("max-growth")),
        patience_(settings.integer("patience")) {}

 private:
  void do_run(const BodyGraph& graph, int max_bodies, Partition& partition,
              RefineSummary& summary) const override {
    MoveSearch search(graph, unit(), most_grown_bodies(max_bodies, max_growth_), MoveKind::all, partition);
    HillClimb climb(search, partition, patience_);
    while (const long fall = climb.run()) {
      summary.cut_after -= fall;
      summary.exchanges += static_cast<int>(climb.kept().size());
      search.restart();
    }
  }

  double max_growth_;
  int patience_;
};

}  // namespace

std::unique_ptr<Refiner> make_fm_hill(const Settings& settings) { return std::make_unique<FmHill>(settings); }

}  // namespace cleave

// fm-cost: moves single bodies while the modelled time of the solve falls (cost_model.h): the search of
// Fiduccia & Mattheyses 1982 with another objective.
//
// In a pass every body is looked at once, in the order of the search of fm: with the allowed move of greatest
// gain in the cut, ties to the lowest body, then to the lowest part (move_search.h, bound as in fm), whatever
// its sign. It is made where the modelled time falls, so that a move may cut more rows if the parts come out
// more equal or cheaper to factor. Passes follow until one makes no move; every move lowers the time, so this
// ends.
#include <memory>

#include "partition/calibration.h"
#include "partition/move_search.h"
#include "partition/parameters.h"
#include "partition/partition_cost.h"
#include "partition/refiner.h"

namespace cleave {
namespace {

class FmCost final : public Refiner {
 public:
  explicit FmCost(const Settings& settings)
      : Refiner(settings.word<EdgeWeight>(parameters::edge_weight())),
        max_growth_(settings.number("max-growth")),
        cost_(kernel_cost(settings)) {}

 private:
  void do_run(const BodyGraph& graph, int max_bodies, Partition& partition,
              RefineSummary& summary) const override {
    PartitionCost time(graph, cost_, partition);
    MoveSearch search(graph, unit(), most_grown_bodies(max_bodies, max_growth_), MoveKind::all, partition);
    while (pass(search, time, summary)) search.restart();
  }

  // Whether it made a move.
  static bool pass(MoveSearch& search, PartitionCost& time, RefineSummary& summary) {
    const int before = summary.exchanges;
    while (const std::optional<Exchange> move = search.find()) {
      search.lock(move->first);
      if (!time.move_if_cheaper(move->first, move->second)) continue;
      search.make(*move);
      ++summary.exchanges;
      summary.cut_after -= move->gain;
    }
    return summary.exchanges > before;
  }

  double max_growth_;
  KernelCost cost_;
};

}  // namespace

std::unique_ptr<Refiner> make_fm_cost(const Settings& settings) { return std::make_unique<FmCost>(settings); }

}  // namespace cleave

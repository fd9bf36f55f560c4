// fm: moves single bodies between parts (Liu & Andrews 2022, section 3.2, after Fiduccia & Mattheyses 1982).
//
// A move takes body i of part A into a part B adjacent to i; its gain is E_i - I_i. It is allowed when A
// keeps at least one body and B stays at or below
//
//     floor((1 + max-growth) max_bodies + 1e-9)      (as-printed: no bound).
//
// The allowed move of greatest gain is made, ties to the lowest body, then to the lowest B, until none has a
// positive gain. Every move lowers the cut, so this ends. A part above the bound to begin with may shrink but
// not grow.
#include <memory>

#include "partition/move_search.h"
#include "partition/refiner.h"

namespace cleave {
namespace {

class FiducciaMattheyses final : public Refiner {
 public:
  explicit FiducciaMattheyses(const Settings& settings)
      : Refiner(refining_unit(settings)),
        max_growth_(settings.number("max-growth")),
        bounded_(!settings.flag("as-printed")) {}

 private:
  void do_run(const BodyGraph& graph, int max_bodies, Partition& partition,
              RefineSummary& summary) const override {
    const int most = bounded_ ? most_grown_bodies(max_bodies, max_growth_) : graph.body_count();
    MoveSearch search(graph, unit(), most, MoveKind::improving, partition);
    while (const std::optional<Exchange> move = search.find()) {
      search.make(*move);
      ++summary.exchanges;
      summary.cut_after -= move->gain;
    }
  }

  double max_growth_;
  bool bounded_;
};

}  // namespace

std::unique_ptr<Refiner> make_fiduccia_mattheyses(const Settings& settings) {
  return std::make_unique<FiducciaMattheyses>(settings);
}

}  // namespace cleave

// fm-hill: moves single bodies in passes that also take steps that raise the cut (Fiduccia & Mattheyses 1982, between many
// parts at a time as in Sanchis 1989).
//
// In a pass every body may move once. The allowed move of greatest gain (move_search.h, bound as in fm) is made whatever
// its sign, and its body locked, until no move is left or the last `patience` moves have not led to a cut lower than all
// before. The pass is then taken back to its first moment of least cut. Passes follow until one does not lower the cut, so
// the result is never worse than the start.
#include <memory>

#include "partition/move_search.h"
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
  struct Made {
    int body, from;
  };

  RefineSummary do_run(const BodyGraph& graph, int max_bodies, Partition& partition) const override {
    const long cut_before = cut_weight(graph, partition.part_of_body, unit());
    RefineSummary summary{0, cut_before, cut_before};
    MoveSearch search(graph, unit(), most_grown_bodies(max_bodies, max_growth_), MoveKind::all, partition);
    while (pass(search, partition, summary)) search.restart();
    return summary;
  }

  // Whether it lowered the cut.
  bool pass(MoveSearch& search, Partition& partition, RefineSummary& summary) const {
    std::vector<Made> moves;
    std::size_t kept = 0;
    long cut = summary.cut_after;
    while (moves.size() - kept < static_cast<std::size_t>(patience_)) {
      const std::optional<Exchange> move = search.find();
      if (!move) break;
      moves.push_back({move->first, partition.part_of_body[move->first]});
      search.lock(move->first);
      search.make(*move);
      cut -= move->gain;
      if (cut >= summary.cut_after) continue;
      summary.cut_after = cut;
      kept = moves.size();
    }
    for (std::size_t k = moves.size(); k > kept; --k)
      partition.part_of_body[moves[k - 1].body] = moves[k - 1].from;
    summary.exchanges += static_cast<int>(kept);
    return kept > 0;
  }

  double max_growth_;
  int patience_;
};

}  // namespace

std::unique_ptr<Refiner> make_fm_hill(const Settings& settings) { return std::make_unique<FmHill>(settings); }

}  // namespace cleave

// semantic: parts after the groups of bodies that a scene names, as those who model a mechanism split it by
// what it is made of: chassis, boom and cable of a crane (Peiret, Andrews, Kovecses, Kry and Teichmann, Schur
// complement-based substructuring of stiff multibody systems with contact, ACM Transactions on Graphics
// 38(5), 2019).
//
// split whole: every group is a part, of whatever size. split chunks: a group of g bodies, in the order of
// their indices, is cut into k = ceil(g / max-bodies) runs; run p = 0 .. k - 1 holds bodies floor(g p / k) to
// floor(g (p + 1) / k) - 1 of it. Bodies in no group are one more group. Edges are not looked at: parts need
// not be contiguous.
#include <map>
#include <memory>
#include <vector>

#include "harness/base/parameter.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

class Semantic final : public Partitioner {
 public:
  explicit Semantic(const Settings& settings)
      : max_bodies_(settings.integer("max-bodies")), whole_(settings.text("split") == "whole") {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    const int n = graph.body_count();
    if (n == 0) return {};
    if (!graph.has_groups())
      throw CannotSplit("semantic: the scene names no groups of bodies, which it splits by");
    std::map<int, std::vector<int>> bodies_of_group;
    for (int body = 0; body < n; ++body) bodies_of_group[graph.group(body)].push_back(body);
    std::vector<int> label_of_body(n);
    int labels = 0;
    for (const auto& [group, bodies] : bodies_of_group) {
      const int size = static_cast<int>(bodies.size());
      const int runs = whole_ ? 1 : wanted_parts(size, max_bodies_);
      for (int p = 0; p < runs; ++p, ++labels)
        for (int k = start(size, p, runs); k < start(size, p + 1, runs); ++k)
          label_of_body[bodies[k]] = labels;
    }
    return numbered_by_lowest_body(label_of_body);
  }

  static int start(int size, int p, int runs) { return static_cast<int>(static_cast<long>(size) * p / runs); }

  int max_bodies_;
  bool whole_;
};

}  // namespace

std::unique_ptr<Partitioner> make_semantic(const Settings& settings) {
  return std::make_unique<Semantic>(settings);
}

}  // namespace cleave

#include "scenarios/ladder_free.h"

#include "scenarios/shapes.h"

namespace cleave {
namespace {

constexpr double kSpacing_m = 3;

class LadderFree : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings& settings, std::uint64_t) override {
    SceneBuilder builder(world, space);
    const int boxes = settings.integer("boxes");
    for (int i = 0; i < boxes; ++i)
      builder.add_box({{i * kSpacing_m, 0, 0}, orientation_along({1, 2, 3})}, 1, {1, 0.8, 0.6});
    return builder.take();
  }
};

}  // namespace

std::vector<Parameter> ladder_free_parameters() {
  return {{"boxes", Parameter::Kind::integer, "1", {1, 1000}, {}, "", "number of boxes"}};
}

std::unique_ptr<Scene> make_ladder_free() { return std::make_unique<LadderFree>(); }

}  // namespace cleave

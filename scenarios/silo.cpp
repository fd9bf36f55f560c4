#include "scenarios/silo.h"

#include <algorithm>
#include <cmath>

#include "scenarios/rock_pile.h"
#include "scenarios/scene_random.h"
#include "scenarios/shapes.h"

namespace cleave {
namespace {

constexpr double kWideCell_m = 0.7;  // of the layers with fewer boxes
constexpr double kHeight_m = 0.65;
constexpr double kHeightSpread_m = 1e-3;  // to either side
constexpr double kLeastFill = 0.92;       // of a cell's width, along either edge of the box
constexpr double kMostFill = 0.96;
constexpr double kMostTurn_rad = 0.03;
constexpr double kOverlap_m = 1e-7;  // so that contacts exist from the first step on, whatever the rounding

// As many boxes a side as make the pile as high as it is wide: a pair of layers has c^2 + (c + 1)^2 boxes.
int boxes_a_side(int bodies) {
  return std::max(1, static_cast<int>(std::lround(std::cbrt(bodies * kHeight_m / kWideCell_m) - 0.5)));
}

// A layer of side x side cells over the whole pit.
struct Layer {
  int side;
  double cell_m;
  std::vector<double> top_m;  // (side, side) of the box in each cell

  Layer(int boxes, double width_m)
      : side(boxes), cell_m(width_m / boxes), top_m(static_cast<std::size_t>(boxes) * boxes, 0.0) {}
  double& top(int column, int row) { return top_m[static_cast<std::size_t>(row) * side + column]; }

  // The highest top below cell (column, row) of a layer of `others` cells a side.
  double support_m(int column, int row, int others) {
    double highest = 0;
    for (int y = row * side / others; y * others < (row + 1) * side; ++y)
      for (int x = column * side / others; x * others < (column + 1) * side; ++x)
        highest = std::max(highest, top(x, y));
    return highest;
  }
};

// How far the turned box may stand off the middle of its cell along x or y.
double play_m(double cell_m, double along_m, double across_m, double turn_rad) {
  return (cell_m - along_m * std::cos(turn_rad) - across_m * std::abs(std::sin(turn_rad))) / 2;
}

class Silo : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings& settings, std::uint64_t seed) override {
    SceneBuilder builder(world, space);
    SceneRandom random(seed);
    const std::vector<double> masses_kg = settings.numbers("mass");
    const int side = boxes_a_side(settings.integer("bodies"));
    const double width_m = side * kWideCell_m;
    builder.add_square_pit(width_m / 2);
    Layer below(side + 1, width_m), layer(side, width_m);
    for (int left = settings.integer("bodies"), cell = 0; left > 0; --left) {
      const double mass_kg = masses_kg[random.index(masses_kg.size())];
      add_box(builder, below, cell % layer.side, cell / layer.side, mass_kg, random, layer);
      if (++cell < layer.side * layer.side) continue;
      cell = 0;
      std::swap(below, layer);
    }
    return builder.take();
  }

 private:
  static void add_box(SceneBuilder& builder, Layer& below, int column, int row, double mass_kg,
                      SceneRandom& random, Layer& layer) {
    const double cell_m = layer.cell_m;
    const double x_m = cell_m * random.uniform(kLeastFill, kMostFill);
    const double y_m = cell_m * random.uniform(kLeastFill, kMostFill);
    const double z_m = kHeight_m + random.uniform(-kHeightSpread_m, kHeightSpread_m);
    const double turn_rad = random.uniform(-kMostTurn_rad, kMostTurn_rad);
    const double play_x_m = play_m(cell_m, x_m, y_m, turn_rad), play_y_m = play_m(cell_m, y_m, x_m, turn_rad);
    const double bottom_m = below.support_m(column, row, layer.side) - kOverlap_m;
    const double low_m = -layer.side * cell_m / 2;
    Pose pose;
    pose.position_m = {low_m + (column + 0.5) * cell_m + random.uniform(-play_x_m, play_x_m),
                       low_m + (row + 0.5) * cell_m + random.uniform(-play_y_m, play_y_m),
                       bottom_m + z_m / 2};
    pose.orientation = {std::cos(turn_rad / 2), 0, 0, std::sin(turn_rad / 2)};
    builder.add_box(pose, mass_kg, {x_m, y_m, z_m});
    layer.top(column, row) = bottom_m + z_m;
  }
};

}  // namespace

std::vector<Parameter> silo_parameters() { return {pile_bodies("200"), pile_mass("100")}; }

std::unique_ptr<Scene> make_silo() { return std::make_unique<Silo>(); }

}  // namespace cleave

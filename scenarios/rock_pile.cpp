#include "scenarios/rock_pile.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "scenarios/scene_random.h"
#include "scenarios/shapes.h"

namespace cleave {
namespace {

using Vector = std::array<double, 3>;

constexpr double kShortestEdge_m = 0.5;
constexpr double kLongestEdge_m = 0.8;
constexpr double kJitter_m = 0.05;
constexpr double kLargestTaper = 0.3;

// What a rock is made from. Every shape fits into the box with these edges, except the sphere, whose diameter
// is the mean edge.
struct Rock {
  Pose pose;
  double mass_kg;
  Vector edges_m;
};

// Hulls must stay where they are as long as the world lives.
using Hulls = std::deque<ConvexHull>;

void add_box_rock(SceneBuilder& builder, const Rock& rock, SceneRandom&, Hulls&) {
  builder.add_box(rock.pose, rock.mass_kg, rock.edges_m);
}

void add_sphere_rock(SceneBuilder& builder, const Rock& rock, SceneRandom&, Hulls&) {
  builder.add_sphere(rock.pose, rock.mass_kg, (rock.edges_m[0] + rock.edges_m[1] + rock.edges_m[2]) / 6);
}

// Four spheres in alternate corners of the box, large enough to overlap about its centre.
void add_clump_rock(SceneBuilder& builder, const Rock& rock, SceneRandom& random, Hulls&) {
  const double shortest = std::min({rock.edges_m[0], rock.edges_m[1], rock.edges_m[2]});
  std::array<ClumpSphere, 4> spheres;
  for (int i = 0; i < 4; ++i) {
    const double radius = shortest * random.uniform(0.32, 0.4);
    const bool negative[3] = {(i & 1) != 0, (i & 2) != 0, (i == 1 || i == 2)};
    for (int k = 0; k < 3; ++k)
      spheres[i].centre_m[k] = (negative[k] ? -1 : 1) * (rock.edges_m[k] / 2 - radius);
    spheres[i].radius_m = radius;
  }
  builder.add_clump(rock.pose, rock.mass_kg, spheres);
}

void add_convex_rock(SceneBuilder& builder, const Rock& rock, SceneRandom& random, Hulls& hulls) {
  const Vector taper{random.uniform(0, kLargestTaper), random.uniform(0, kLargestTaper),
                     random.uniform(0, kLargestTaper)};
  builder.add_convex(rock.pose, rock.mass_kg, hulls.emplace_back(make_tapered_box(rock.edges_m, taper)));
}

struct RockShape {
  const char* name;
  double bounding_radius_m;  // about the origin of the pose
  void (*add)(SceneBuilder&, const Rock&, SceneRandom&, Hulls&);
};

constexpr double kHalfDiagonal_m = kLongestEdge_m * 0.8660254037844387;  // sqrt(3) / 2
constexpr RockShape kRockShapes[] = {
    {"box", kHalfDiagonal_m, add_box_rock},
    {"sphere", kLongestEdge_m / 2, add_sphere_rock},
    // The farthest a clump reaches is 0.511 m, at edges 0.8, 0.8, 0.5 m with the smallest spheres.
    {"clump", 0.52, add_clump_rock},
    {"convex", kHalfDiagonal_m, add_convex_rock},
};

const RockShape& rock_shape(const std::string& name) {
  return *std::find_if(std::begin(kRockShapes), std::end(kRockShapes),
                       [&](const RockShape& shape) { return shape.name == name; });
}

// Rocks along a side of the grid. Eight layers of the grid come to rest about three deep.
int grid_columns(int bodies, int depth) {
  return static_cast<int>(std::ceil(std::sqrt(3.0 * bodies / (8.0 * depth))));
}

class RockPile : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings& settings, std::uint64_t seed) override {
    SceneBuilder builder(world, space);
    SceneRandom random(seed);
    const int bodies = settings.integer("bodies");
    const std::vector<double> masses_kg = settings.numbers("mass");
    const RockShape& shape = rock_shape(settings.text("rock-shape"));

    const int columns = grid_columns(bodies, settings.integer("depth"));
    const double cell_m = 2 * (shape.bounding_radius_m + kJitter_m);
    builder.add_square_pit(columns * cell_m / 2);
    for (int i = 0; i < bodies; ++i) {
      const int cell[3] = {i % columns, i / columns % columns, i / (columns * columns)};
      const double low[3] = {-columns * cell_m / 2, -columns * cell_m / 2, 0};
      Rock rock;
      for (int k = 0; k < 3; ++k)
        rock.pose.position_m[k] = low[k] + (cell[k] + 0.5) * cell_m + random.uniform(-kJitter_m, kJitter_m);
      rock.pose.orientation = random.rotation();
      for (double& edge_m : rock.edges_m) edge_m = random.uniform(kShortestEdge_m, kLongestEdge_m);
      rock.mass_kg = masses_kg[random.index(masses_kg.size())];
      shape.add(builder, rock, random, hulls_);
    }
    return builder.take();
  }

 private:
  Hulls hulls_;
};

}  // namespace

Parameter pile_bodies(const char* default_bodies) {
  return {"bodies",
          Parameter::Kind::integer,
          default_bodies,
          {1, kMostPileBodies},
          {},
          "",
          "number of rocks, of silo: of boxes"};
}

Parameter pile_mass(const char* default_mass_kg) {
  return {"mass",
          Parameter::Kind::numbers,
          default_mass_kg,
          {1e-6, 1e9},
          {},
          "",
          "kg; of several values each rock draws one"};
}

std::vector<Parameter> rock_pile_parameters(const char* default_bodies, const char* default_mass_kg) {
  using Kind = Parameter::Kind;
  std::vector<std::string> shapes;
  for (const RockShape& shape : kRockShapes) shapes.push_back(shape.name);
  return {pile_bodies(default_bodies),
          {"depth",
           Kind::integer,
           "3",
           {1, 50},
           {},
           "",
           "layers of rocks on each other, about, once they are at rest"},
          {"rock-shape",
           Kind::word,
           "box",
           {0, 0},
           shapes,
           "",
           "shape of every rock; clump is four spheres on one body"},
          pile_mass(default_mass_kg)};
}

std::unique_ptr<Scene> make_rock_pile() { return std::make_unique<RockPile>(); }

}  // namespace cleave

#include "scenarios/shapes.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "scenarios/scene_random.h"

namespace cleave {
namespace {

using Vector = std::array<double, 3>;

// Mass, first and second moments of a density by the midpoint rule on a cube of half width `reach`.
struct Moments {
  double mass = 0;
  Vector centre{};
  double inertia[3][3]{};  // about the centre of mass

  Moments(const std::function<double(const Vector&)>& density, double reach, int cells) {
    const double h = 2 * reach / cells;
    double second[3][3]{};
    for (int i = 0; i < cells * cells * cells; ++i) {
      const Vector x{-reach + h * (i % cells + 0.5), -reach + h * (i / cells % cells + 0.5),
                     -reach + h * (i / (cells * cells) + 0.5)};
      const double m = density(x) * h * h * h;
      mass += m;
      for (int a = 0; a < 3; ++a) {
        centre[a] += m * x[a];
        for (int b = 0; b < 3; ++b) second[a][b] += m * x[a] * x[b];
      }
    }
    for (double& c : centre) c /= mass;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) second[a][b] -= mass * centre[a] * centre[b];
    const double trace = second[0][0] + second[1][1] + second[2][2];
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) inertia[a][b] = (a == b ? trace : 0) - second[a][b];
  }
};

void expect_same(dMass mass, const Moments& wanted, double relative) {
  EXPECT_NEAR(mass.mass, wanted.mass, relative * wanted.mass);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mass.c[k], wanted.centre[k], relative * 0.5);
  dMassTranslate(&mass, -mass.c[0], -mass.c[1], -mass.c[2]);
  const double scale = wanted.inertia[0][0] + wanted.inertia[1][1] + wanted.inertia[2][2];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      EXPECT_NEAR(mass.I[4 * a + b], wanted.inertia[a][b], relative * scale) << a << b;
}

double hull_volume(const Vector& e, int cells, const ConvexHull& hull) {
  return Moments(
             [&](const Vector& x) {
               for (int f = 0; f < 6; ++f)
                 if (dCalcVectorDot3(hull.planes.data() + 4 * f, x.data()) > hull.planes[4 * f + 3])
                   return 0.0;
               return 1.0;
             },
             std::max({e[0], e[1], e[2]}) / 2, cells)
      .mass;
}

TEST(Shapes, ClumpMassIsThatOfItsSpheres) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SceneRandom random(seed);
    std::vector<ClumpSphere> spheres(3 + random.index(3));
    double cubes = 0;
    for (ClumpSphere& sphere : spheres) {
      for (double& c : sphere.centre_m) c = random.uniform(-0.3, 0.3);
      sphere.radius_m = random.uniform(0.1, 0.2);
      cubes += std::pow(sphere.radius_m, 3);
    }
    const double density = 7 / (cubes * 4 * std::numbers::pi / 3);
    const auto at = [&](const Vector& x) {
      double sum = 0;
      for (const ClumpSphere& s : spheres) {
        const double distance = std::hypot(x[0] - s.centre_m[0], x[1] - s.centre_m[1], x[2] - s.centre_m[2]);
        sum += distance < s.radius_m ? density : 0;
      }
      return sum;
    };
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_same(clump_mass(spheres, 7), Moments(at, 0.5, 100), 5e-3);
  }
}

TEST(Shapes, ClumpOfOneSphereIsASphere) {
  const ClumpSphere sphere{{0, 0, 0}, 0.4};
  const dMass mass = clump_mass({&sphere, 1}, 5);
  EXPECT_DOUBLE_EQ(mass.I[0], 0.4 * 5 * 0.16);
}

TEST(Shapes, HullMassAgreesWithTheVolumeInsideItsPlanes) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SceneRandom random(seed);
    const Vector edges{random.uniform(0.5, 0.8), random.uniform(0.5, 0.8), random.uniform(0.5, 0.8)};
    const Vector taper{random.uniform(0, 0.5), random.uniform(0, 0.5), random.uniform(0, 0.5)};
    const ConvexHull hull = make_tapered_box(edges, taper);
    const double density = 9 / hull_volume(edges, 100, hull);
    const auto at = [&](const Vector& x) {
      for (int f = 0; f < 6; ++f)
        if (dCalcVectorDot3(hull.planes.data() + 4 * f, x.data()) > hull.planes[4 * f + 3]) return 0.0;
      return density;
    };
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_same(hull_mass(hull, 9), Moments(at, 0.4, 100), 5e-3);
  }
}

TEST(Shapes, HullWithoutTaperIsABox) {
  const ConvexHull hull = make_tapered_box({0.5, 0.6, 0.8}, {0, 0, 0});
  const dMass mass = hull_mass(hull, 12);
  dMass box;
  dMassSetBoxTotal(&box, 12, 0.5, 0.6, 0.8);
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(mass.I[i], box.I[i], 1e-14);
}

TEST(Shapes, HullFacesAreFlatOutwardAndFillTheBox) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SceneRandom random(seed);
    const Vector edges{random.uniform(0.5, 0.8), random.uniform(0.5, 0.8), random.uniform(0.5, 0.8)};
    const ConvexHull hull =
        make_tapered_box(edges, {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)});
    for (int f = 0; f < 6; ++f) {
      std::set<unsigned int> on_face(ConvexHull::polygons + 5 * f + 1, ConvexHull::polygons + 5 * f + 5);
      for (unsigned int p = 0; p < 8; ++p) {
        const double outside =
            dCalcVectorDot3(hull.planes.data() + 4 * f, hull.points.data() + 3 * p) - hull.planes[4 * f + 3];
        if (on_face.count(p) != 0)
          EXPECT_NEAR(outside, 0, 1e-14) << "seed " << seed << " face " << f;
        else
          EXPECT_LT(outside, -0.05) << "seed " << seed << " face " << f;
      }
    }
    for (int k = 0; k < 3; ++k) {
      double low = 1, high = -1;
      for (int p = 0; p < 8; ++p) {
        low = std::min<double>(low, hull.points[3 * p + k]);
        high = std::max<double>(high, hull.points[3 * p + k]);
      }
      EXPECT_NEAR(low, -edges[k] / 2, 1e-15);
      EXPECT_NEAR(high, edges[k] / 2, 1e-15);
    }
  }
}

TEST(Shapes, OrientationTakesTheAxisIntoTheDirection) {
  SceneRandom random(3);
  std::vector<Vector> directions = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -2, 0}};
  for (int i = 0; i < 100; ++i)
    directions.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  for (const Vector& d : directions) {
    const std::array<double, 4> q = orientation_along(d);
    dMatrix3 rotation;
    dQtoR(q.data(), rotation);
    const double length = std::hypot(d[0], d[1], d[2]);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(rotation[4 * k + 2], d[k] / length, 1e-12);
  }
}

TEST(Shapes, RandomRotationsAreUnitAndUncentred) {
  SceneRandom random(11);
  double mean[4]{};
  for (int i = 0; i < 4000; ++i) {
    const std::array<double, 4> q = random.rotation();
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-12);
    for (int k = 0; k < 4; ++k) mean[k] += q[k] * q[k] / 4000;
  }
  for (const double m : mean) EXPECT_NEAR(m, 0.25, 0.02);
}

// The geometry must sit where the mass is: a clump hung at its centre of mass feels no torque.
TEST(Shapes, BodiesSitAtTheirCentreOfMass) {
  dInitODE2(0);
  const dWorldID world = dWorldCreate();
  const dSpaceID space = dSimpleSpaceCreate(nullptr);
  SceneBuilder builder(world, space);
  const ClumpSphere spheres[] = {{{0, 0, 0}, 0.2}, {{0.3, 0, 0}, 0.1}};
  const Pose pose{{1, 2, 3}, orientation_along({1, 0, 0})};
  const dBodyID clump = builder.add_clump(pose, 9, spheres);
  const SceneContent content = builder.take();
  // The small sphere has an eighth of the large one's mass: the centre lies at 0.3 / 9 along the local x
  // axis, which points down in the world.
  EXPECT_NEAR(dBodyGetPosition(clump)[0], 1, 1e-15);
  EXPECT_NEAR(dBodyGetPosition(clump)[2], 3 - 0.3 / 9, 1e-15);
  for (int i = 0; i < 2; ++i) {
    const dReal* x = dGeomGetPosition(content.geoms[i]);
    EXPECT_NEAR(x[0], 1, 1e-15);
    EXPECT_NEAR(x[1], 2, 1e-15);
    EXPECT_NEAR(x[2], 3 - spheres[i].centre_m[0], 1e-15);
  }
  dSpaceDestroy(space);
  dWorldDestroy(world);
}

}  // namespace
}  // namespace cleave

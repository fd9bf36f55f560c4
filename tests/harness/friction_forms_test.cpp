// Closed forms of friction through the program: when a block on a slope begins to slide, whatever the
// direction of the slope against the axes of the friction rows, and how a block that slides lifts off under
// the convex cone.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "tests/harness/run_program.h"

namespace cleave {
namespace {

using Vector = std::array<double, 3>;

std::string text_of(const Vector& v) {
  char text[120];
  std::snprintf(text, sizeof text, "[%.17g, %.17g, %.17g]", v[0], v[1], v[2]);
  return text;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

struct Slope {
  Vector normal;

  Slope(double incline, double heading)
      : normal{std::sin(incline) * std::cos(heading), std::sin(incline) * std::sin(heading),
               std::cos(incline)} {}

  // Of the downhill direction against the tangents of a contact, which ODE takes by its dPlaneSpace: the
  // first lies in the plane x = 0.
  double angle() const {
    const double a = std::hypot(normal[1], normal[2]);
    const Vector p = {0, -normal[2] / a, normal[1] / a};
    const Vector q = {a, -normal[0] * p[2], normal[0] * p[1]};
    const Vector downhill = {normal[0] * normal[2], normal[1] * normal[2], normal[2] * normal[2] - 1};
    const auto along = [&](const Vector& axis) {
      return downhill[0] * axis[0] + downhill[1] * axis[1] + downhill[2] * axis[2];
    };
    return std::atan2(along(q), along(p));
  }
};

// A flat block on a slope, which it touches.
std::string block_on(const Slope& slope, const std::string& more = "") {
  constexpr double kHalf = 0.05, kOverlap = 1e-4;
  Vector centre = slope.normal;
  for (double& x : centre) x *= kHalf - kOverlap;
  return "[[plane]]\nnormal = " + text_of(slope.normal) +
         "\noffset_m = 0\n[[body]]\nshape = \"box\"\nedges_m = [1, 1, 0.1]\nmass_kg = 10\nposition_m = " +
         text_of(centre) + "\nalong = " + text_of(slope.normal) + "\n" + more;
}

class FrictionForms : public ::testing::Test {
 protected:
  CsvTable run(const std::string& world, const std::string& friction, double mu) {
    std::ofstream(scratch_ / "world.toml") << world;
    const ProgramResult result =
        run_cleave({"run", "--scene", "file@path=" + (scratch_ / "world.toml").string(), "--steps", "60",
                    "--solver", "exact", "--repeats", "1", "--friction", friction, "--mu", std::to_string(mu),
                    "--out", scratch_ / "out", "--force"});
    EXPECT_EQ(result.exit_code, 0) << friction << ", mu " << mu << ": " << result.err;
    return read_csv(scratch_ / "out" / "steps.csv");
  }
  // Whether it has slid by more than a millimetre in a second; what sticks creeps by much less.
  bool slides(const Slope& slope, const std::string& friction, double mu) {
    const CsvTable rows = run(block_on(slope), friction, mu);
    const double first = std::stod(rows.at(10, "last_body_z_m")),
                 last = std::stod(rows.at(59, "last_body_z_m"));
    return first - last > 1e-3;
  }
  TemporaryDirectory scratch_;
};

// tan of the incline against mu for cone and Coulomb's law; against mu over the greater of |cos|, |sin| of
// the angle for the box.
TEST_F(FrictionForms, ABlockSlidesFromTheInclineOfItsModelOn) {
  constexpr double kIncline = 20;
  for (const double heading : {90.0, 75.0, 60.0, 45.0}) {
    const Slope slope(radians(kIncline), radians(heading));
    const double angle = slope.angle(), steep = std::tan(radians(kIncline));
    const double of_box = std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
    for (const auto& [friction, share] :
         {std::pair("box", of_box), std::pair("cone", 1.0), std::pair("coulomb", 1.0)}) {
      SCOPED_TRACE(std::string(friction) + ", heading " + std::to_string(heading));
      EXPECT_TRUE(slides(slope, friction, 0.97 * steep * share));
      EXPECT_FALSE(slides(slope, friction, 1.03 * steep * share));
    }
  }
}

// The convex cone parts what slides at mu times its speed: h mu v higher after every step, where v is the
// speed after it; the normal impulse is that of gravity and of the lift, and friction mu times it, so that v
// = (v0 - mu g h) / (1 + mu^2). Neither the box nor Coulomb's law lifts anything.
TEST_F(FrictionForms, ASlidingBlockLiftsOffUnderTheConeAlone) {
  const Slope flat(0, 0);
  constexpr double kSpeed = 2, kMu = 0.2, kStep = 1.0 / 60;
  const std::string world = block_on(flat, "velocity_m_per_s = [2, 0, 0]\n");
  const auto rise = [&](const std::string& friction) {
    const CsvTable rows = run(world, friction, kMu);
    return std::stod(rows.at(0, "last_body_z_m")) - (0.05 - 1e-4);
  };
  const double push_out = rise("coulomb");  // of the overlap at the start
  const double lift = kStep * kMu * (kSpeed - kMu * 9.81 * kStep) / (1 + kMu * kMu);
  EXPECT_NEAR(rise("cone") - push_out, lift, 0.01 * lift);
  EXPECT_NEAR(rise("box") - push_out, 0, 0.01 * lift);
}

}  // namespace
}  // namespace cleave

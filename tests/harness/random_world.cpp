#include "tests/harness/random_world.h"

#include <array>
#include <cmath>
#include <random>
#include <sstream>
#include <vector>

namespace cleave {
namespace {

using Point = std::array<double, 3>;

std::string vector_text(const Point& v) {
  std::ostringstream text;
  text << '[' << v[0] << ", " << v[1] << ", " << v[2] << ']';
  return text.str();
}

class RandomWorld {
 public:
  explicit RandomWorld(std::uint64_t seed) : engine_(seed) {}

  std::string text() {
    text_ << (one_in(2) ? "[ground]\n" : "[pit]\nhalf_width_m = 1.5\n");
    const int bodies = 6 + static_cast<int>(engine_() % 15);
    for (int body = 0; body < bodies; ++body) add_body(body);
    for (int body = 0; body < bodies; ++body)
      if (one_in(4)) add_joint(body, static_cast<int>(engine_() % (body + 1)));
    return text_.str();
  }

 private:
  double real(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  bool one_in(unsigned count) { return engine_() % count == 0; }
  Point point(double low, double high) { return {real(low, high), real(low, high), real(low, high)}; }

  void add_body(int body) {
    const Point at = {real(-1, 1), real(-1, 1), 0.4 + 0.15 * body};
    at_.push_back(at);
    text_ << "[[body]]\ngroup = \"b" << body << "\"\nmass_kg = " << std::pow(10.0, real(-1, 3))
          << "\nposition_m = " << vector_text(at) << "\norientation = \"random\"\n";
    switch (engine_() % 3) {
      case 0:
        text_ << "shape = \"sphere\"\nradius_m = " << real(0.05, 0.25) << '\n';
        break;
      case 1:
        text_ << "shape = \"box\"\nedges_m = " << vector_text(point(0.1, 0.5)) << '\n';
        break;
      default:
        text_ << "shape = \"capsule\"\nradius_m = " << real(0.05, 0.2) << "\nlength_m = " << real(0.1, 0.4)
              << '\n';
    }
    if (one_in(2)) text_ << "velocity_m_per_s = " << vector_text(point(-3, 3)) << '\n';
    if (one_in(2)) text_ << "angular_velocity_rad_per_s = " << vector_text(point(-5, 5)) << '\n';
  }

  // other: a lower body, or the body itself for the world.
  void add_joint(int body, int other) {
    constexpr std::array<const char*, 4> kKinds = {"ball", "hinge", "slider", "fixed"};
    const std::size_t kind = engine_() % kKinds.size();
    const std::string partner = other == body ? "world" : "b" + std::to_string(other);
    text_ << "[[joint]]\nkind = \"" << kKinds[kind] << "\"\nbodies = [\"b" << body << "\", \"" << partner
          << "\"]\n";
    if (kind < 2) {
      Point anchor;
      for (int k = 0; k < 3; ++k) anchor[k] = (at_[body][k] + at_[other][k]) / 2;
      text_ << "anchor_m = " << vector_text(anchor) << '\n';
    }
    if (kind == 1 || kind == 2) text_ << "axis = " << vector_text(point(0.1, 1)) << '\n';
  }

  std::mt19937_64 engine_;
  std::ostringstream text_;
  std::vector<Point> at_;
};

}  // namespace

std::string random_world(std::uint64_t seed) { return RandomWorld(seed).text(); }

}  // namespace cleave

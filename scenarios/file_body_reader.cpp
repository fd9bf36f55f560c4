#include "scenarios/file_body_reader.h"

#include <algorithm>
#include <cmath>

#include "scenarios/file_joint_reader.h"
#include "scenarios/file_values.h"

namespace cleave::scene_file {
namespace {

const Range kMass_kg{1e-6, 1e9};
const Range kVelocity_m_per_s{-1e6, 1e6};
const Range kAngularVelocity_rad_per_s{-1e6, 1e6};
const Range kTaper{0, 1};
const Range kCount{1, kMostBodies};

const std::vector<std::string> kBodyKeys = {
    "group",      "shape",     "radius_m",         "length_m",
    "edges_m",    "taper",     "spheres",          "mass_kg",
    "position_m", "grid",      "orientation",      "along",
    "through_m",  "joined_by", "velocity_m_per_s", "angular_velocity_rad_per_s",
    "gravity"};

std::vector<SphereOfClump> read_spheres(const Value& value) {
  std::vector<SphereOfClump> spheres;
  for (const Value& element : value.list("a list of tables with centre_m, radius_m")) {
    Table table = element.table({"centre_m", "radius_m"});
    spheres.push_back(
        {read_drawn_vector(table.at("centre_m"), kAnyLength_m), read_number(table.at("radius_m"), kSize_m)});
  }
  if (spheres.empty()) value.reject("an empty list makes no body; allowed: tables with centre_m, radius_m");
  return spheres;
}

void read_size(Table& table, Bodies& bodies) {
  for (const std::string& key : bodies.shape->keys) {
    const Value value = table.at(key);
    if (key == "radius_m") bodies.size.radius_m = read_number(value, kSize_m);
    if (key == "length_m") bodies.size.length_m = read_number(value, kSize_m);
    if (key == "edges_m") bodies.size.edges_m = read_drawn_vector(value, kSize_m);
    if (key == "taper") bodies.size.taper = read_drawn_vector(value, kTaper);
    if (key == "spheres") bodies.size.spheres = read_spheres(value);
  }
}

// Letters, digits, '-' and '_', as references to bodies need it; "world" is what is not a body.
std::string read_group(const Value& value) {
  const std::string allowed = "a name of letters, digits, '-' and '_' other than 'world'";
  const std::string name = value.text(allowed);
  const bool plain = std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
  if (name.empty() || !plain || name == "world") value.reject_value(allowed);
  return name;
}

std::array<double, 4> read_quaternion(const Value& value) {
  const std::string allowed = "'random' or a list of four numbers w, x, y, z in [-1, 1]";
  if (value.is_text()) value.reject_value(allowed);
  std::array<double, 4> quaternion{};
  double square = 0;
  const std::vector<Value> parts = value.list(4, allowed);
  for (int k = 0; k < 4; ++k) {
    quaternion[k] = parts[k].number({-1, 1});
    square += quaternion[k] * quaternion[k];
  }
  if (std::abs(square - 1) > 1e-6)
    value.reject("has length " + number_text(std::sqrt(square)) + "; the length of an orientation is 1");
  return quaternion;
}

void read_orientation(Table& table, Bodies& bodies) {
  const auto along = table.find("along");
  const auto orientation = table.find("orientation");
  if (along && orientation) along->reject("cannot be given beside orientation");
  if (along) bodies.orientation = orientation_along(read_direction(*along));
  if (!orientation) return;
  bodies.random_orientation = orientation->is_text() && orientation->text("") == "random";
  if (!bodies.random_orientation) bodies.orientation = read_quaternion(*orientation);
}

Grid read_grid(const Value& value) {
  Table table = value.table({"count", "spacing_m"});
  Grid grid;
  const std::vector<Value> counts =
      table.at("count").list(3, "a list of three whole numbers in " + kCount.text());
  for (int k = 0; k < 3; ++k) grid.count[k] = counts[k].integer(kCount);
  grid.spacing_m = read_vector(table.at("spacing_m"), kAnyLength_m);
  // The product of two fits: each is at most kMostBodies.
  const bool too_many = grid.count[0] * grid.count[1] > kMostBodies ||
                        grid.count[0] * grid.count[1] > kMostBodies / grid.count[2];
  if (too_many) value.reject("has more than " + std::to_string(kMostBodies) + " cells");
  return grid;
}

std::vector<Vector> read_points(const Value& value) {
  const std::string allowed = "a list of at least two points";
  std::vector<Vector> points;
  for (const Value& element : value.list(allowed)) {
    points.push_back(read_vector(element, kAnyLength_m));
    if (points.size() > 1 && points.back() == points[points.size() - 2])
      element.reject("is the point before it; a body reaches from point to point");
  }
  if (points.size() < 2) value.reject("a list of " + std::to_string(points.size()) + " is not " + allowed);
  return points;
}

// Where the bodies are: from point to point, or at a position or in a grid about it.
void read_places(Table& table, Bodies& bodies) {
  if (const auto points = table.find("through_m")) {
    bodies.through_m = read_points(*points);
    if (const auto link = table.find("joined_by")) bodies.joined_by = read_link(*link);
    return;
  }
  bodies.position_m = read_drawn_vector(table.at("position_m"), kAnyLength_m);
  if (const auto grid = table.find("grid")) bodies.grid = read_grid(*grid);
  read_orientation(table, bodies);
}

}  // namespace

Bodies read_bodies(const Value& value) {
  Table table = value.table(kBodyKeys);
  Bodies bodies;
  if (const auto group = table.find("group")) bodies.group = read_group(*group);
  bodies.shape = &read_kind(table.at("shape"), shape_kinds());
  read_size(table, bodies);
  bodies.mass_kg = read_number(table.at("mass_kg"), kMass_kg);
  read_places(table, bodies);
  if (const auto velocity = table.find("velocity_m_per_s"))
    bodies.velocity_m_per_s = read_drawn_vector(*velocity, kVelocity_m_per_s);
  if (const auto spin = table.find("angular_velocity_rad_per_s"))
    bodies.angular_velocity_rad_per_s = read_drawn_vector(*spin, kAngularVelocity_rad_per_s);
  if (const auto gravity = table.find("gravity")) bodies.gravity = gravity->flag();
  table.expect_all_read(std::string("with shape '") + bodies.shape->name + "' and " +
                        (bodies.through_m.empty() ? "position_m" : "through_m"));
  return bodies;
}

}  // namespace cleave::scene_file

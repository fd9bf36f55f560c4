#include "scenarios/file_reader.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>

#include "harness/base/file_text.h"
#include "harness/base/hash.h"
#include "scenarios/file_body_reader.h"
#include "scenarios/file_joint_reader.h"
#include "scenarios/file_values.h"

namespace cleave::scene_file {
namespace {

const Range kLayer_m{0, 1e-2};

// The tables of an array of tables; none where there is no such key.
std::vector<Value> tables(Table& file, const std::string& key) {
  const auto value = file.find(key);
  return value ? value->list("a list of tables: [[" + key + "]]") : std::vector<Value>{};
}

Plane read_plane(const Value& value) {
  Table table = value.table({"normal", "offset_m"});
  Plane plane;
  plane.normal = read_direction(table.at("normal"));
  const double length = std::sqrt(plane.normal[0] * plane.normal[0] + plane.normal[1] * plane.normal[1] +
                                  plane.normal[2] * plane.normal[2]);
  for (double& part : plane.normal) part /= length;
  if (const auto offset = table.find("offset_m")) plane.offset_m = offset->number(kAnyLength_m);
  return plane;
}

void read_static(Table& file, Description& scene) {
  const auto ground = file.find("ground"), pit = file.find("pit");
  if (ground && pit) ground->reject("cannot be given beside pit, which has a floor");
  if (ground) {
    Table table = ground->table({"height_m"});
    Plane& plane = scene.planes.emplace_back();
    if (const auto height = table.find("height_m")) plane.offset_m = height->number(kAnyLength_m);
  }
  if (pit) scene.pit_half_width_m = pit->table({"half_width_m"}).at("half_width_m").number(kSize_m);
  for (const Value& value : tables(file, "plane")) scene.planes.push_back(read_plane(value));
  if (const auto layer = file.find("contact_layer_m")) scene.contact_layer_m = layer->number(kLayer_m);
}

void read_all_bodies(Table& file, Description& scene) {
  int count = 0;
  for (const Value& value : tables(file, "body")) {
    scene.bodies.push_back(read_bodies(value));
    count += scene.bodies.back().count();
    if (count > kMostBodies)
      value.reject("makes the scene's bodies " + std::to_string(count) + "; allowed: 1 to " +
                   std::to_string(kMostBodies));
  }
  if (count == 0) file.reject("body", "is required: a scene has at least one body");
}

std::string text_of(const std::string& path) {
  std::optional<std::string> text = file_text(path);
  if (!text || text->empty())
    throw std::invalid_argument("--scene file@path: '" + path +
                                "' cannot be read, or is empty; allowed: a scene file");
  return *std::move(text);
}

}  // namespace

Description parse(const std::string& text, const std::string& name) {
  const toml::table root = parsed_toml(text, name);
  Table file(root, "", name, {"body", "joint", "event", "plane", "ground", "pit", "contact_layer_m"});
  Description scene;
  read_static(file, scene);
  read_all_bodies(file, scene);
  const Groups groups(scene.bodies);
  for (const Value& value : tables(file, "joint")) scene.joints.push_back(read_joint(value, groups));
  for (const Value& value : tables(file, "event")) scene.events.push_back(read_event(value, groups));
  Fnv1a64 hash;
  hash.add(text);
  scene.content_id = hex(hash.value());
  return scene;
}

const Description& description_of(const std::string& path) {
  static std::mutex mutex;
  static std::map<std::string, Description> known;
  const std::lock_guard lock(mutex);
  const auto found = known.find(path);
  if (found != known.end()) return found->second;
  return known.emplace(path, parse(text_of(path), path)).first->second;
}

}  // namespace cleave::scene_file

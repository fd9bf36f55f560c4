#include "scenarios/file_scene.h"

#include <algorithm>
#include <optional>

#include "scenarios/file_builder.h"
#include "scenarios/file_reader.h"

namespace cleave {
namespace {

using scene_file::Description;
using scene_file::Event;
using scene_file::Vector;

const Description& description(const Settings& settings) {
  return scene_file::description_of(settings.text("path"));
}

// An event as it happens to one body.
struct Change {
  int step = 0, body = 0;
  std::optional<bool> gravity;
  std::optional<Vector> velocity_m_per_s, angular_velocity_rad_per_s;
};

std::optional<Vector> draw(const std::optional<scene_file::DrawnVector>& vector, SceneRandom& random) {
  return vector ? std::optional(scene_file::draw(*vector, random)) : std::nullopt;
}

// Every body an event names gets velocities of its own, drawn in the order of the file.
std::vector<Change> draw_changes(const std::vector<Event>& events, SceneRandom& random) {
  std::vector<Change> changes;
  for (const Event& event : events) {
    for (const int body : event.bodies) {
      Change& change = changes.emplace_back();
      change.step = event.step;
      change.body = body;
      change.gravity = event.gravity;
      change.velocity_m_per_s = draw(event.velocity_m_per_s, random);
      change.angular_velocity_rad_per_s = draw(event.angular_velocity_rad_per_s, random);
    }
  }
  return changes;
}

void apply(const Change& change, dBodyID body) {
  if (change.gravity) dBodySetGravityMode(body, *change.gravity);
  if (const auto& v = change.velocity_m_per_s) dBodySetLinearVel(body, (*v)[0], (*v)[1], (*v)[2]);
  if (const auto& w = change.angular_velocity_rad_per_s) dBodySetAngularVel(body, (*w)[0], (*w)[1], (*w)[2]);
}

class FileScene : public Scene {
 public:
  SceneContent build(dWorldID world, dSpaceID space, const Settings& settings, std::uint64_t seed) override {
    const Description& scene = description(settings);
    SceneRandom random(seed);
    SceneContent content = scene_file::build(scene, world, space, random, hulls_);
    changes_ = draw_changes(scene.events, random);
    return content;
  }

  void before_step(int step, const SceneContent& content) override {
    for (const Change& change : changes_)
      if (change.step == step) apply(change, content.bodies[change.body]);
  }

 private:
  scene_file::Hulls hulls_;
  std::vector<Change> changes_;
};

}  // namespace

std::vector<Parameter> file_scene_parameters() {
  return {
      {.name = "path", .kind = Parameter::Kind::path, .help = "scene file; see scenarios/FILE_SCENES.md"}};
}

bool file_scene_names_groups(const Settings& settings) {
  return std::ranges::any_of(description(settings).bodies,
                             [](const scene_file::Bodies& bodies) { return !bodies.group.empty(); });
}

std::unique_ptr<Scene> make_file_scene() { return std::make_unique<FileScene>(); }

std::string file_scene_content_id(const Settings& settings) { return description(settings).content_id; }

}  // namespace cleave

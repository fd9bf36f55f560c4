// Scene files, up to the bodies they put into a world.
#include <numeric>

#include "harness/world/ode_world.h"
#include "scenarios/file_builder.h"
#include "scenarios/file_reader.h"
#include "tests/fuzz/target.h"

namespace cleave::fuzz {
namespace {

using scene_file::Description;

constexpr int kMostBuilt = 64;  // more of them are no other code

int body_count(const Description& scene) {
  int count = 0;
  for (const scene_file::Bodies& bodies : scene.bodies) count += bodies.count();
  return count;
}

class OneScene : public Scene {
 public:
  inline static const Description* description = nullptr;
  SceneContent build(dWorldID world, dSpaceID space, const Settings&, std::uint64_t seed) override {
    SceneRandom random(seed);
    return scene_file::build(*description, world, space, random, hulls_);
  }

 private:
  scene_file::Hulls hulls_;
};

// Whatever the file says within its ranges, its bodies have finite states and are found to touch or not.
void check_world(const Description& scene) {
  OneScene::description = &scene;
  SceneEntry entry{{.name = "fuzz", .help = "", .reference = ""},
                   [] { return std::unique_ptr<Scene>(new OneScene); }};
  OdeWorld world(entry, {}, 1, 9.81);
  require(world.body_count() == body_count(scene), "a body of the file is not in the world");
  world.collide(8, nullptr);
}

}  // namespace

void read_scene(std::string_view bytes) {
  Description scene;
  if (refuses([&] { scene = scene_file::parse(std::string(bytes), "scene.toml"); })) return;
  const int count = body_count(scene);
  require(count >= 1, "a scene without bodies");
  for (const scene_file::Joint& joint : scene.joints)
    require(joint.body_a >= 0 && joint.body_a < count && joint.body_b >= -1 && joint.body_b < count,
            "a joint of nobody");
  for (const scene_file::Event& event : scene.events)
    for (const int body : event.bodies) require(body >= 0 && body < count, "an event of nobody");
  if (count <= kMostBuilt) refuses([&] { check_world(scene); });
}

}  // namespace cleave::fuzz

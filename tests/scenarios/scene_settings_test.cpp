#include <gtest/gtest.h>

#include "scenario_text.h"
#include "scene_world.h"
#include "shipped_scenes.h"

namespace cleave {
namespace {

// The text of the error, or nothing where the settings are accepted.
std::string error_of(const SceneEntry& scene, const std::map<std::string, std::string>& given) {
  try {
    make_scene_settings(scene, given);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::string error_of(const std::string& scene, const std::string& option, const std::string& value) {
  return error_of(scene_named(scene), {{option, value}});
}

TEST(SceneSettings, TextsNameOptionValueAndRange) {
  EXPECT_EQ(error_of("rock_pile", "bodies", "0"), "--bodies: 0 is not in [1, 200000]");
  EXPECT_EQ(error_of("rock_pile", "bodies", "200001"), "--bodies: 200001 is not in [1, 200000]");
  EXPECT_EQ(error_of("rock_pile", "bodies", "99999999999999999999"),
            "--bodies: 99999999999999999999 is not in [1, 200000]");
  EXPECT_EQ(error_of("rock_pile", "bodies", "2.5"), "--bodies: '2.5' is not a whole number in [1, 200000]");
  EXPECT_EQ(error_of("rock_pile", "rock-shape", "cone"),
            "--rock-shape: 'cone' is unknown (did you mean 'convex'?); choices: box, sphere, clump, convex");
  EXPECT_EQ(
      error_of("rock_pile", "links", "3"),
      "--links: scene 'rock_pile' has no such option (it has: --bodies, --depth, --rock-shape, --mass)");
  EXPECT_EQ(error_of("chain_drop", "bob-mass", "nan"), "--bob-mass: nan is not in [1e-06, 1e+09]");
  EXPECT_EQ(error_of("rock_pile", "mass", "10,-1"), "--mass: -1 is not in [1e-06, 1e+09]");
  EXPECT_EQ(error_of("rock_pile", "mass", "10,,1"), "--mass: '' is not a number in [1e-06, 1e+09]");
}

TEST(SceneSettings, DefaultsOfEverySceneAreComplete) {
  for (const ShippedScene& scene : shipped_scenes()) {
    const Settings settings = make_scene_settings(*scene.entry, scene.given);
    EXPECT_EQ(settings.values().size(), scene.entry->parameters.size()) << scene.name;
    for (const Parameter& parameter : scene.entry->parameters) {
      const auto given = scene.given.find(parameter.name);
      EXPECT_EQ(settings.text(parameter.name), given != scene.given.end()
                                                   ? given->second
                                                   : checked_value(parameter, "", parameter.default_value))
          << scene.name << " --" << parameter.name;
    }
  }
}

TEST(SceneSettings, AParameterWithoutDefaultMustBeGiven) {
  EXPECT_EQ(error_of(scene_named("file"), {}), "--scene: file needs path: write file@path=FILE");
}

TEST(SceneSettings, GivenValuesAreRead) {
  const Settings settings =
      make_scene_settings(scene_named("rock_pile"), {{"bodies", "7"}, {"mass", "1,2.5,1e3"}});
  EXPECT_EQ(settings.integer("bodies"), 7);
  EXPECT_EQ(settings.numbers("mass"), (std::vector<double>{1, 2.5, 1000}));
  EXPECT_EQ(settings.text("rock-shape"), "box");
  EXPECT_EQ(make_scene_settings(scene_named("chain_drop"), {{"bob-mass", "0.25"}}).number("bob-mass"), 0.25);
}

TEST(SceneSettings, EveryParameterRefusesBadValues) {
  for (const SceneEntry& scene : scenes()) {
    for (const Parameter& parameter : scene.parameters) {
      for (const std::string& value : bad_values(parameter)) {
        const std::string error = error_of(scene, {{parameter.name, value}});
        const std::string start = std::string("--") + parameter.name + ": ";
        EXPECT_EQ(error.substr(0, start.size()), start) << scene.name << " '" << value << "'";
        EXPECT_EQ(error.find('\n'), error.npos) << error;
      }
    }
  }
}

TEST(SceneSettings, EveryParameterTakesTheEndsOfItsRange) {
  for (const SceneEntry& scene : scenes())
    for (const Parameter& parameter : scene.parameters)
      for (const std::string& value : extreme_values(parameter))
        EXPECT_EQ(error_of(scene, {{parameter.name, value}}), "") << scene.name;
}

}  // namespace
}  // namespace cleave

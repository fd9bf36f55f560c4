// Whatever is wrong in a scene file is one line that names file, line, key, value and what is allowed.
#include <gtest/gtest.h>

#include <filesystem>

#include "scenarios/file_reader.h"
#include "scene_world.h"
#include "shipped_scenes.h"
#include "written_scene.h"

namespace cleave {
namespace {

// The text of the error, or nothing where the file is accepted.
std::string error_of(const std::string& text) {
  try {
    scene_file::parse(text, "s.toml");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

struct Mistake {
  std::string text, error;
};

// A body on lines 1 to 6, with the given text instead of what stands there.
std::string body(const std::string& from = "", const std::string& to = "") {
  std::string text =
      "[[body]]\ngroup = 'rock'\nshape = 'box'\nedges_m = [1, 1, 1]\nmass_kg = 5\nposition_m = [0, 0, 2]\n";
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return text;
}

void expect_errors(const std::vector<Mistake>& mistakes) {
  for (const auto& [text, error] : mistakes) EXPECT_EQ(error_of(text), error) << text;
}

const std::string kBodyKeys =
    "group, shape, radius_m, length_m, edges_m, taper, spheres, mass_kg, position_m, grid, orientation, "
    "along, "
    "through_m, joined_by, velocity_m_per_s, angular_velocity_rad_per_s, gravity";

TEST(FileErrors, TheBodyItselfIsFine) { EXPECT_EQ(error_of(body()), ""); }

TEST(FileErrors, KeysAndKinds) {
  expect_errors({
      {body("mass_kg", "mas_kg"),
       "s.toml:5: body[0].mas_kg: 'mas_kg' is unknown (did you mean 'mass_kg'?); choices: " + kBodyKeys},
      {"grond = {}\n" + body(),
       "s.toml:1: grond: 'grond' is unknown (did you mean 'ground'?); choices: body, joint, event, plane, "
       "ground, "
       "pit, contact_layer_m"},
      {body("'box'", "'bix'"),
       "s.toml:3: body[0].shape: 'bix' is unknown (did you mean 'box'?); choices: sphere, box, capsule, "
       "cylinder, "
       "clump, convex"},
      {body("'box'", "7"),
       "s.toml:3: body[0].shape: 7 is not one of sphere, box, capsule, cylinder, clump, convex"},
      {body("shape = 'box'", ""), "s.toml:1: body[0].shape: is required"},
      {body("mass_kg = 5", ""), "s.toml:1: body[0].mass_kg: is required"},
      {body("position_m = [0, 0, 2]", ""), "s.toml:1: body[0].position_m: is required"},
      {body("edges_m", "radius_m"), "s.toml:1: body[0].edges_m: is required"},
      {body() + "radius_m = 1\n",
       "s.toml:7: body[0].radius_m: has no meaning with shape 'box' and position_m"},
      {body("position_m = [0, 0, 2]", "through_m = [[0, 0, 0], [1, 0, 0]]\ngrid = {}"),
       "s.toml:7: body[0].grid: has no meaning with shape 'box' and through_m"},
      {"", "s.toml:1: body: is required: a scene has at least one body"},
      {"body = 3", "s.toml:1: body: 3 is not a list of tables: [[body]]"},
      {"body = [3]", "s.toml:1: body[0]: 3 is not a table with " + kBodyKeys},
      {"[ground]\n[pit]\nhalf_width_m = 3\n" + body(),
       "s.toml:1: ground: cannot be given beside pit, which has a floor"},
      {"pit = {}\n" + body(), "s.toml:1: pit.half_width_m: is required"},
  });
}

TEST(FileErrors, NumbersAndRanges) {
  expect_errors({
      {body("= 5", "= -1"), "s.toml:5: body[0].mass_kg: -1 is not in [1e-06, 1e+09]"},
      {body("= 5", "= nan"), "s.toml:5: body[0].mass_kg: nan is not in [1e-06, 1e+09]"},
      {body("= 5", "= 'heavy'"), "s.toml:5: body[0].mass_kg: 'heavy' is not a number in [1e-06, 1e+09]"},
      {body("= 5", "= true"), "s.toml:5: body[0].mass_kg: true is not a number in [1e-06, 1e+09]"},
      {body("= 5", "= [5]"), "s.toml:5: body[0].mass_kg: a list is not a number in [1e-06, 1e+09]"},
      {body("= 5", "= 2026-01-01"),
       "s.toml:5: body[0].mass_kg: a date or time is not a number in [1e-06, 1e+09]"},
      {body("= 5", "= { from = 3, to = 2 }"), "s.toml:5: body[0].mass_kg.to: 2 is not at or above from = 3"},
      {body("= 5", "= { from = 0, to = 2 }"), "s.toml:5: body[0].mass_kg.from: 0 is not in [1e-06, 1e+09]"},
      {body("= 5", "= { from = 3 }"), "s.toml:5: body[0].mass_kg.to: is required"},
      {body("= 5", "= { one_of = [3, 0] }"),
       "s.toml:5: body[0].mass_kg.one_of[1]: 0 is not in [1e-06, 1e+09]"},
      {body("= 5", "= { one_of = [] }"),
       "s.toml:5: body[0].mass_kg.one_of: an empty list is not a list of numbers in [1e-06, 1e+09]"},
      {body("= 5", "= { one_of = [3], to = 4 }"),
       "s.toml:5: body[0].mass_kg.to: has no meaning beside one_of"},
      {body("= 5", "= { form = 3, to = 4 }"),
       "s.toml:5: body[0].mass_kg.form: 'form' is unknown (did you mean 'from'?); choices: from, to, one_of"},
      {body("[1, 1, 1]", "[1, 1]"),
       "s.toml:4: body[0].edges_m: a list of 2 is not a list of three numbers in [1e-06, 1e+06]"},
      {body("[1, 1, 1]", "1"),
       "s.toml:4: body[0].edges_m: 1 is not a list of three numbers in [1e-06, 1e+06]"},
      {body("[1, 1, 1]", "[1,\n  1,\n  -1]"), "s.toml:6: body[0].edges_m[2]: -1 is not in [1e-06, 1e+06]"},
      {body("[0, 0, 2]", "[0, 'x', 2]"),
       "s.toml:6: body[0].position_m[1]: 'x' is not a number in [-1e+06, 1e+06]"},
      {body("2]", "9223372036854775807]"),
       "s.toml:6: body[0].position_m[2]: 9223372036854775807 is not in [-1e+06, 1e+06]"},
      {"contact_layer_m = 1\n" + body(), "s.toml:1: contact_layer_m: 1 is not in [0, 0.01]"},
      {"[ground]\nheight_m = {}\n" + body(),
       "s.toml:2: ground.height_m: a table is not a number in [-1e+06, 1e+06]"},
      {"[[plane]]\nnormal = [0, 0, 0]\n" + body(),
       "s.toml:2: plane[0].normal: has no length; a direction is a list of three numbers, at least one of "
       "them "
       "not 0"},
  });
}

// Found by a fuzzer: an assertion of the library ended the program, and some characters have no defined
// answer there.
TEST(FileErrors, WhatTheParserDoesNotExpect) {
  const std::string rule = ": not TOML: a character beyond ASCII that is in no comment and no string";
  expect_errors({
      {"a = [1,}", "s.toml: not TOML: the parser gives up on it"},
      {"[ground]\n\u0450", "s.toml:2" + rule},
      {"'a' \uFCFF", "s.toml:1" + rule},
      {"\"\"\"a\n\"\"\"\"\u00E4", "s.toml:2" + rule},
      {"\"\\\"\" = \u00E4", "s.toml:1" + rule},
      {"a = 0'''b\uFCFF", "s.toml:1" + rule},
      {"a = 0\"b \u00E4\"", "s.toml:1" + rule},
      {"\uFEFF# \u0450 \uFCFF\n" + body(), ""},
      {body("'rock'", "\"\u00E4\""),
       "s.toml:2: body[0].group: '\u00E4' is not a name of letters, digits, '-' and '_' other than 'world'"},
  });
}

TEST(FileErrors, PlacesAndGrids) {
  expect_errors({
      {body() + "grid = { count = [2, 2, 2.5], spacing_m = [1, 1, 1] }",
       "s.toml:7: body[0].grid.count[2]: 2.5 is not a whole number in [1, 20000]"},
      {body() + "grid = { count = [2, 0, 2], spacing_m = [1, 1, 1] }",
       "s.toml:7: body[0].grid.count[1]: 0 is not in [1, 20000]"},
      {body() + "grid = { count = [20000, 20000, 20000], spacing_m = [1, 1, 1] }",
       "s.toml:7: body[0].grid: has more than 20000 cells"},
      {body() + "grid = { count = [2, 2, 2] }", "s.toml:7: body[0].grid.spacing_m: is required"},
      {body() + "grid = { count = [20000, 1, 1], spacing_m = [2, 0, 0] }\n" + body(),
       "s.toml:8: body[1]: makes the scene's bodies 20001; allowed: 1 to 20000"},
      {body() + "orientation = [1, 1, 0, 0]",
       "s.toml:7: body[0].orientation: has length 1.4142135623730951; the length of an orientation is 1"},
      {body() + "orientation = [1, 0, 0]",
       "s.toml:7: body[0].orientation: a list of 3 is not 'random' or a list of four numbers w, x, y, z in "
       "[-1, 1]"},
      {body() + "orientation = 'rando'",
       "s.toml:7: body[0].orientation: 'rando' is not 'random' or a list of four numbers w, x, y, z in [-1, "
       "1]"},
      {body() + "orientation = 'random'\nalong = [1, 0, 0]",
       "s.toml:8: body[0].along: cannot be given beside orientation"},
      {body() + "along = [0, 0, 0]",
       "s.toml:7: body[0].along: has no length; a direction is a list of three numbers, at least one of them "
       "not 0"},
      {body("position_m = [0, 0, 2]", "through_m = [[0, 0, 0]]"),
       "s.toml:6: body[0].through_m: a list of 1 is not a list of at least two points"},
      {body("position_m = [0, 0, 2]", "through_m = [[0, 0, 0],\n[0, 0, 0]]"),
       "s.toml:7: body[0].through_m[1]: is the point before it; a body reaches from point to point"},
      {body() + "joined_by = { kind = 'ball' }",
       "s.toml:7: body[0].joined_by: has no meaning with shape 'box' and position_m"},
      {body() + "gravity = 1", "s.toml:7: body[0].gravity: 1 is not true or false"},
      {body("'rock'", "'world'"),
       "s.toml:2: body[0].group: 'world' is not a name of letters, digits, '-' and '_' other than 'world'"},
      {body("'rock'", "'a[1]'"),
       "s.toml:2: body[0].group: 'a[1]' is not a name of letters, digits, '-' and '_' other than 'world'"},
      {body("'box'\nedges_m = [1, 1, 1]", "'clump'\nspheres = []"),
       "s.toml:4: body[0].spheres: an empty list makes no body; allowed: tables with centre_m, radius_m"},
      {body("'box'\nedges_m = [1, 1, 1]", "'clump'\nspheres = [{ centre_m = [0, 0, 0], radius_m = 0 }]"),
       "s.toml:4: body[0].spheres[0].radius_m: 0 is not in [1e-06, 1e+06]"},
      {body("'box'", "'convex'") + "taper = [0, 0, 2]", "s.toml:7: body[0].taper[2]: 2 is not in [0, 1]"},
  });
}

// Two bodies on lines 1 to 7 and a joint from line 8 on.
std::string joint(const std::string& lines) {
  return body() + "grid = { count = [2, 1, 1], spacing_m = [2, 0, 0] }\n[[joint]]\n" + lines;
}

TEST(FileErrors, Joints) {
  const std::string two = "bodies = ['rock[0]', 'rock[1]']\n";
  expect_errors({
      {joint(two + "kind = 'fixed'"), ""},
      {joint(two + "kind = 'hinged'"),
       "s.toml:10: joint[0].kind: 'hinged' is unknown (did you mean 'hinge'?); choices: ball, hinge, slider, "
       "fixed"},
      {joint(two + "kind = 'ball'"), "s.toml:8: joint[0].anchor_m: is required"},
      {joint(two + "kind = 'hinge'\nanchor_m = [0, 0, 0]"), "s.toml:8: joint[0].axis: is required"},
      {joint(two + "kind = 'fixed'\nanchor_m = [0, 0, 0]"),
       "s.toml:11: joint[0].anchor_m: has no meaning for a joint of kind 'fixed'"},
      {joint("bodies = ['rok[0]', 'world']\nkind = 'fixed'"),
       "s.toml:9: joint[0].bodies[0]: group 'rok' is unknown (did you mean 'rock'?); choices: rock"},
      {joint("bodies = ['rock[2]', 'world']\nkind = 'fixed'"),
       "s.toml:9: joint[0].bodies[0]: 'rock[2]' is not one of 'rock[0]' to 'rock[1]'"},
      {joint("bodies = ['rock', 'world']\nkind = 'fixed'"),
       "s.toml:9: joint[0].bodies[0]: 'rock' is not one body but 2; give one by its number, as in 'rock[0]'"},
      {joint("bodies = ['rock[0]', 'rock[0]']\nkind = 'fixed'"),
       "s.toml:9: joint[0].bodies[1]: 'rock[0]' is not another body than the first"},
      {joint("bodies = ['world', 'rock[0]']\nkind = 'fixed'"),
       "s.toml:9: joint[0].bodies[0]: group 'world' is unknown; choices: rock"},
      {joint("bodies = ['rock[0]']\nkind = 'fixed'"),
       "s.toml:9: joint[0].bodies: a list of 1 is not a list of two bodies, the second of which may be "
       "'world'"},
      {joint("bodies = [0, 1]\nkind = 'fixed'"),
       "s.toml:9: joint[0].bodies[0]: 0 is not a group ('link') or one body of it ('link[3]')"},
      {body("position_m = [0, 0, 2]",
            "through_m = [[0, 0, 0], [1, 0, 0]]\njoined_by = { kind = 'ball', axis = [0, 0, 1] }"),
       "s.toml:7: body[0].joined_by.axis: has no meaning for a joint of kind 'ball'"},
  });
  for (const char* reference : {"rock[", "rock[]", "rock[1", "rock[-1]", "rock[1]]", "rock[x]", "rock[1][0]"})
    EXPECT_EQ(error_of(joint("kind = 'fixed'\nbodies = ['" + std::string(reference) + "', 'world']")),
              "s.toml:10: joint[0].bodies[0]: '" + std::string(reference) +
                  "' is not a group ('link') or one body of it ('link[3]')");
}

TEST(FileErrors, Events) {
  const std::string event = body() + "[[event]]\n";
  expect_errors({
      {event + "step = 60\nbodies = 'rock'",
       "s.toml:7: event[0]: changes nothing; give gravity, velocity_m_per_s or angular_velocity_rad_per_s"},
      {event + "step = -1\nbodies = 'rock'\ngravity = true",
       "s.toml:8: event[0].step: -1 is not in [0, 1e+09]"},
      {event + "step = 1.5\nbodies = 'rock'\ngravity = true",
       "s.toml:8: event[0].step: 1.5 is not a whole number in [0, 1e+09]"},
      {event + "bodies = 'rock'\ngravity = true", "s.toml:7: event[0].step: is required"},
      {event + "step = 1\nbodies = 'ball'\ngravity = true",
       "s.toml:9: event[0].bodies: group 'ball' is unknown; choices: rock"},
      {event + "step = 1\nbodies = 'rock'\nvelocity = [0, 0, 0]",
       "s.toml:10: event[0].velocity: 'velocity' is unknown (did you mean 'velocity_m_per_s'?); choices: "
       "step, bodies, "
       "gravity, velocity_m_per_s, angular_velocity_rad_per_s"},
  });
}

TEST(FileErrors, TextThatIsNotToml) {
  for (const std::string text : {"[[body]\n", "shape = \n", "mass_kg = 1\nmass_kg = 2\n", "a = 'x\n",
                                 "\xff\xfe", "x = 1e", "[body]\n[body]\n"}) {
    const std::string error = error_of(text);
    EXPECT_TRUE(error.starts_with("s.toml:")) << error;
    EXPECT_NE(error.find(": not TOML: "), error.npos) << error;
    EXPECT_EQ(error.find('\n'), error.npos) << error;
  }
  EXPECT_TRUE(error_of(body() + "mass_kg = 6\n").starts_with("s.toml:7: not TOML: "))
      << error_of(body() + "mass_kg = 6\n");
}

TEST(FileErrors, AFileThatCannotBeRead) {
  const auto error_of_path = [](const std::string& path) -> std::string {
    try {
      make_scene_settings(scene_named("file"), {{"path", path}});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(error_of_path("no/such.toml"),
            "--scene file@path: 'no/such.toml' cannot be read, or is empty; allowed: a scene file");
  EXPECT_EQ(error_of_path("/"), "--scene file@path: '/' cannot be read, or is empty; allowed: a scene file");
}

// A file that was refused is read anew: nothing is kept of it.
TEST(FileErrors, AMendedFileIsAccepted) {
  const WrittenScene file("nonsense");
  EXPECT_THROW(make_scene_settings(scene_named("file"), file.given()), std::invalid_argument);
  file.write(body());
  EXPECT_NO_THROW(make_scene_settings(scene_named("file"), file.given()));
}

// Whatever is cut off or changed in a file, reading it ends in a description or in one line.
TEST(FileErrors, DamagedFilesAreReadOrRefusedInOneLine) {
  int refused = 0;
  for (const std::string name : {"chain_drop", "log_tower", "pile"}) {
    std::ifstream file(shipped_file(name), std::ios::binary);
    const std::string whole(std::istreambuf_iterator<char>(file), {});
    ASSERT_FALSE(whole.empty());
    SceneRandom random(5);
    for (int trial = 0; trial < 100; ++trial) {
      std::string text = whole.substr(0, trial % 2 == 0 ? whole.size() : random.index(whole.size()));
      if (!text.empty()) text[random.index(text.size())] = static_cast<char>(random.index(256));
      const std::string error = error_of(text);
      EXPECT_EQ(error.find('\n'), error.npos) << error;
      EXPECT_TRUE(error.empty() || error.starts_with("s.toml:")) << error;
      refused += error.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 150);
}

}  // namespace
}  // namespace cleave

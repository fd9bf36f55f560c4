// The page about scene files says what the reader reads.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "scene_world.h"
#include "shipped_scenes.h"
#include "written_scene.h"

namespace cleave {
namespace {

std::vector<std::string> page_lines() {
  std::ifstream file(std::string(CLEAVE_SOURCE_DIR) + "/scenarios/FILE_SCENES.md");
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

// The indented lines under a heading.
std::string example(const std::string& heading) {
  std::string text;
  bool here = false;
  for (const std::string& line : page_lines()) {
    if (line.starts_with("## ")) here = line == heading;
    if (here && line.starts_with("    ")) text += line.substr(4) + "\n";
  }
  return text;
}

TEST(FormatPage, WorkedExampleRunsAndDoesWhatItSays) {
  const std::string text = example("## A worked example");
  ASSERT_FALSE(text.empty());
  SceneWorld world(scene_named("file"), WrittenScene(text).given());
  const SceneContent& content = world.content();
  ASSERT_EQ(content.bodies.size(), 22u);
  const dBodyID ball = content.bodies.back();
  for (int step = 0; step < 60; ++step) world.step(step, 30);
  EXPECT_NEAR(dBodyGetPosition(ball)[2], 3, 1e-12);
  EXPECT_NEAR(dBodyGetPosition(content.bodies[19])[2], 1.4, 0.02);
  for (int step = 60; step < 180; ++step) world.step(step, 30);
  EXPECT_LT(dBodyGetPosition(ball)[2], 3);
  double farthest_m = 0;
  for (int i = 0; i < 20; ++i)
    farthest_m = std::max<double>(farthest_m, dBodyGetPosition(content.bodies[i])[0]);
  EXPECT_GT(farthest_m, 1);
}

// The keys of all tables, as the reader lists them where one is unknown, stand in the page.
TEST(FormatPage, NamesEveryKey) {
  std::ostringstream page;
  for (const std::string& line : page_lines()) page << line << '\n';
  int keys = 0;
  for (const std::string table : {"[[body]]", "[[joint]]", "[[event]]", "[[plane]]", "[ground]", "[pit]"}) {
    const std::string body =
        "[[body]]\ngroup = 'a'\nshape = 'sphere'\nradius_m = 1\nmass_kg = 1\nposition_m = [0, 0, 0]\n";
    const WrittenScene file(body + table + "\nunheard-of = 1\n");
    try {
      make_scene_settings(scene_named("file"), file.given());
      FAIL() << table;
    } catch (const std::invalid_argument& error) {
      const std::string line = error.what(), start = "choices: ";
      ASSERT_NE(line.find(start), line.npos) << line;
      std::istringstream choices(line.substr(line.find(start) + start.size()));
      for (std::string key; std::getline(choices >> std::ws, key, ','); ++keys)
        EXPECT_NE(page.str().find("`" + key + "`"), std::string::npos) << table << ' ' << key;
    }
  }
  EXPECT_GT(keys, 25);
}

}  // namespace
}  // namespace cleave

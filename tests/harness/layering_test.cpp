// Which room may include what (tests/rooms.txt): partitioners and solvers are plain data in, plain data out,
// and stay so.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace cleave {
namespace {

namespace fs = std::filesystem;

struct Include {
  fs::path file;     // relative to the source tree
  std::string name;  // between the quotes or brackets
  bool local;        // in quotes
};

std::vector<Include> includes_of_file(const fs::path& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> found;
  std::ifstream text(file);
  for (std::string line; std::getline(text, line);) {
    std::smatch match;
    if (std::regex_search(line, match, pattern))
      found.push_back({fs::relative(file, CLEAVE_SOURCE_DIR), match[2], match[1] == "\""});
  }
  return found;
}

struct Room {
  std::string folder;
  std::vector<std::string> may_include;  // rooms above it, and itself
  std::vector<std::string> libraries;
};

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

// How the headers of a library that tests/rooms.txt names begin.
const std::map<std::string, std::string> kHeaders = {
    {"ode", "ode/"}, {"toml", "toml++"}, {"json", "nlohmann/"}};

// tests/rooms.txt, in its order.
std::vector<Room> read_rooms() {
  std::vector<Room> rooms;
  std::ifstream file(fs::path(CLEAVE_SOURCE_DIR) / "tests/rooms.txt");
  for (std::string line; std::getline(file, line);) {
    const std::vector<std::string> words = words_of(line);
    if (words.empty() || words[0] == "#") continue;
    Room room{words[0], {words[0]}, {}};
    for (std::size_t i = 1; i < words.size(); ++i) {
      if (words[i] == "-") continue;
      (kHeaders.contains(words[i]) ? room.libraries : room.may_include).push_back(words[i]);
    }
    rooms.push_back(room);
  }
  return rooms;
}

// The innermost room of a path relative to the source tree, or nullptr.
const Room* room_of(const std::vector<Room>& rooms, const std::string& path) {
  const Room* found = nullptr;
  for (const Room& room : rooms)
    if (path.starts_with(room.folder + "/") &&
        (found == nullptr || room.folder.size() > found->folder.size()))
      found = &room;
  return found;
}

std::vector<fs::path> sources() {
  std::vector<fs::path> files;
  for (const char* folder : {"harness", "partition", "scenarios", "solver"})
    for (const fs::directory_entry& entry :
         fs::recursive_directory_iterator(fs::path(CLEAVE_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
        files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

// The standard library's own headers have neither a dot nor a slash in their name.
bool is_standard(const Include& include) {
  return !include.local && include.name.find_first_of("./") == std::string::npos;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::ranges::find(words, word) != words.end();
}

TEST(Layering, ArrowsBetweenRoomsGoDownwards) {
  const std::vector<Room> rooms = read_rooms();
  ASSERT_GE(rooms.size(), 9u);
  std::vector<std::string> above;
  for (const Room& room : rooms) {
    for (const std::string& other : room.may_include)
      EXPECT_TRUE(other == room.folder || contains(above, other))
          << room.folder << " may not look up to " << other;
    above.push_back(room.folder);
  }
}

TEST(Layering, EveryIncludeIsAllowedByTheListOfRooms) {
  const std::vector<Room> rooms = read_rooms();
  int arrows = 0;
  for (const fs::path& file : sources()) {
    const std::string path = fs::relative(file, CLEAVE_SOURCE_DIR).string();
    const Room* room = room_of(rooms, path);
    ASSERT_NE(room, nullptr) << path << " is in no room";
    for (const Include& include : includes_of_file(file)) {
      if (!include.local) {
        for (const auto& [library, header] : kHeaders)
          EXPECT_TRUE(!include.name.starts_with(header) || contains(room->libraries, library))
              << path << " includes " << include.name;
        continue;
      }
      if (include.name == "cleave_build_info.h") continue;  // made by the build
      const Room* other = room_of(rooms, include.name);
      ASSERT_NE(other, nullptr) << path << " includes " << include.name << ", which is in no room";
      EXPECT_TRUE(contains(room->may_include, other->folder)) << path << " includes " << include.name;
      ++arrows;
    }
  }
  EXPECT_GT(arrows, 400);
}

// Neither directly nor through anything that is included.
TEST(Layering, FilesPartitionersAndSolversCompileWithoutOde) {
  const std::string listing = fs::temp_directory_path() / ("cleave_deps_" + std::to_string(::getpid()));
  const std::string command = std::string("ninja -C ") + CLEAVE_BINARY_DIR + " -t deps > " + listing;
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  const std::vector<Room> rooms = read_rooms();
  std::ifstream file(listing);
  const std::string root = "    " CLEAVE_SOURCE_DIR "/";
  bool of_library = false;
  std::string source;
  int sources = 0;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(" ")) {
      // "CMakeFiles/cleave_files.dir/harness/files/manifest.cpp.o: #deps 300, ...", then what it reads, a
      // line each: the source, or the sources of a unit, and headers after the first that includes them
      of_library = line.starts_with("CMakeFiles/cleave");
      source.clear();
    } else if (of_library && line.starts_with(root) && line.ends_with(".cpp")) {
      source = line.substr(root.size());
      const Room* room = room_of(rooms, source);
      const bool may = room == nullptr || room->folder == "scenarios" || room->folder == "harness/world" ||
                       room->folder == "harness/experiment" || room->folder == "harness/campaign" ||
                       room->folder == "harness/commands";
      if (may) source.clear();
      sources += !source.empty();
    } else if (!source.empty()) {
      EXPECT_EQ(line.find("/ode/"), std::string::npos) << source << " compiles against" << line;
    }
  }
  fs::remove(listing);
  EXPECT_GT(sources, 60);
}

TEST(Layering, PartitionKnowsTheStandardLibraryAlone) {
  for (const fs::path& file : sources()) {
    const std::string path = fs::relative(file, CLEAVE_SOURCE_DIR).string();
    if (!path.starts_with("partition/")) continue;
    // An adapter to a graph library is one file of its own, named after it.
    const std::string name = file.filename().string();
    const bool adapter = name.starts_with("metis") || name.starts_with("scotch");
    for (const Include& include : includes_of_file(file))
      EXPECT_TRUE(include.local || adapter || is_standard(include)) << path << " includes " << include.name;
  }
}

// The judge vouches for solvers, so it shares nothing with them but the problem.
TEST(Layering, JudgeKnowsTheProblemOnly) {
  const std::set<std::string> files = {"solver/residual.h",        "solver/residual.cpp",
                                       "solver/residual_bodies.h", "solver/residual_bodies.cpp",
                                       "solver/residual_rows.h",   "solver/residual_rows.cpp"};
  for (const std::string& file : files) {
    const std::vector<Include> all = includes_of_file(fs::path(CLEAVE_SOURCE_DIR) / file);
    ASSERT_FALSE(all.empty()) << file;
    for (const Include& include : all) {
      const bool allowed = files.contains(include.name) || include.name == "solver/step_problem.h";
      EXPECT_TRUE(!include.local || allowed) << file << " includes " << include.name;
    }
  }
}

// The checker itself: it must see what it forbids.
TEST(Layering, ReaderSeesBothFormsOfInclude) {
  const fs::path file =
      fs::temp_directory_path() / ("cleave_layering_" + std::to_string(::getpid()) + ".cpp");
  std::ofstream(file) << "#include <ode/ode.h>\n  #  include \"partition/grow.h\"\n// #include "
                         "<metis.h>\n#include <vector>\n";
  const std::vector<Include> found = includes_of_file(file);
  fs::remove(file);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].name, "ode/ode.h");
  EXPECT_FALSE(is_standard(found[0]));
  EXPECT_TRUE(found[1].local);
  EXPECT_TRUE(is_standard(found[2]));
}

}  // namespace
}  // namespace cleave

// Files that appear whole or not at all.
#include "harness/files/whole_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace cleave {
namespace {

namespace fs = std::filesystem;

fs::path empty_folder(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / ("cleave_whole_file_" + name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string message_of(const fs::path& path, std::string_view bytes) {
  try {
    write_whole_file(path, bytes);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(WholeFile, HoldsTheBytesAndLeavesNothingAside) {
  const fs::path folder = empty_folder("bytes");
  write_whole_file(folder / "a", "old and longer");
  write_whole_file(folder / "a", std::string_view("n\0w", 3));
  EXPECT_EQ(text_of(folder / "a"), std::string("n\0w", 3));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST(WholeFile, NamesFileAndReasonWhereThereIsNoFolder) {
  const fs::path path = empty_folder("none") / "no" / "a";
  EXPECT_EQ(message_of(path, "x"), path.string() + ": cannot be written: No such file or directory");
}

TEST(WholeFile, KeepsTheOldFileWhenTheNewOneCannotTakeItsName) {
  const fs::path folder = empty_folder("kept");
  fs::create_directories(folder / "a" / "inside");
  EXPECT_EQ(message_of(folder / "a", "x"), (folder / "a").string() + ": cannot be written: Is a directory");
  EXPECT_TRUE(fs::exists(folder / "a" / "inside"));
  EXPECT_FALSE(fs::exists(part_name_of(folder / "a")));
}

TEST(WholeFile, OfSeveralNoneLeavesItsPartWhereOneCannotTakeItsName) {
  const fs::path folder = empty_folder("several");
  // Named twice, the file has gone to its place when it is to go there again.
  const NamedBytes files[] = {{folder / "a", "1"}, {folder / "a", "2"}, {folder / "b", "3"}};
  EXPECT_THROW(write_whole_files(files), std::runtime_error);
  EXPECT_EQ(text_of(folder / "a"), "2");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST(WholeFile, SaysThatTheDeviceIsFull) {
  const fs::path folder = empty_folder("full");
  fs::create_symlink("/dev/full", part_name_of(folder / "a"));
  EXPECT_EQ(message_of(folder / "a", "x"),
            (folder / "a").string() + ": cannot be written: No space left on device");
  EXPECT_TRUE(fs::is_empty(folder));
}

}  // namespace
}  // namespace cleave

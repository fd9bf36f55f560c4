// Scene files that tests write, each under a name of its own: a process reads a file once.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace cleave {

class WrittenScene {
 public:
  explicit WrittenScene(const std::string& text) {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("cleave_scene_" + std::to_string(::getpid()) + "_" + std::to_string(count++) + ".toml");
    write(text);
  }
  WrittenScene(const WrittenScene&) = delete;
  ~WrittenScene() { std::filesystem::remove(path_); }

  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }
  std::map<std::string, std::string> given() const { return {{"path", path_.string()}}; }

 private:
  std::filesystem::path path_;
};

}  // namespace cleave

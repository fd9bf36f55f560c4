// Reads what refers to bodies by their group: joints and events of a scene file.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenarios/file_description.h"
#include "scenarios/file_table.h"

namespace cleave::scene_file {

// Body indices, in creation order, by the name of the group.
class Groups {
 public:
  explicit Groups(const std::vector<Bodies>& bodies);
  // "link": all of a group; "link[3]": its fourth body.
  std::vector<int> bodies_of(const Value& reference) const;
  int body_of(const Value& reference) const;  // one body, or it throws

 private:
  std::map<std::string, std::vector<int>> bodies_;
};

Link read_link(const Value& value);
Joint read_joint(const Value& value, const Groups& groups);
Event read_event(const Value& value, const Groups& groups);

}  // namespace cleave::scene_file

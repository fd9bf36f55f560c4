#include "scenarios/file_joint_reader.h"

#include <charconv>

#include "scenarios/file_values.h"

namespace cleave::scene_file {
namespace {

const Range kStep{0, 1e9};
const Range kSpeed{-1e6, 1e6};  // m/s or rad/s along an axis
const std::string kReference = "a group ('link') or one body of it ('link[3]')";

// Anchor and axis, as far as the kind has them.
void read_geometry(Table& table, const JointKind& kind, Vector& anchor_m, Vector& axis) {
  for (const std::string& key : kind.keys) {
    if (key == "anchor_m") anchor_m = read_vector(table.at(key), kAnyLength_m);
    if (key == "axis") axis = read_direction(table.at(key));
  }
  table.expect_all_read(std::string("for a joint of kind '") + kind.name + "'");
}

}  // namespace

Groups::Groups(const std::vector<Bodies>& bodies) {
  int index = 0;
  for (const Bodies& some : bodies) {
    for (int i = 0; i < some.count(); ++i, ++index)
      if (!some.group.empty()) bodies_[some.group].push_back(index);
  }
}

std::vector<int> Groups::bodies_of(const Value& reference) const {
  const std::string text = reference.text(kReference);
  const std::size_t bracket = text.find('[');
  const std::string name = text.substr(0, bracket);
  const auto group = bodies_.find(name);
  if (group == bodies_.end()) {
    std::vector<std::string> names;
    for (const auto& [known, bodies] : bodies_) names.push_back(known);
    reference.reject("group " + unknown_name_text(name, names));
  }
  if (bracket == text.npos) return group->second;
  const char* const first = text.data() + bracket + 1;
  const char* const last = text.data() + text.size() - 1;  // of the closing bracket
  if (first > last) reference.reject_value(kReference);
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(first, last, index);
  if (error == std::errc::invalid_argument || end != last || *last != ']') reference.reject_value(kReference);
  if (error != std::errc{} || index >= group->second.size())
    reference.reject_value("one of '" + name + "[0]' to '" + name + "[" +
                           std::to_string(group->second.size() - 1) + "]'");
  return {group->second[index]};
}

int Groups::body_of(const Value& reference) const {
  const std::vector<int> bodies = bodies_of(reference);
  if (bodies.size() != 1)
    reference.reject_value("one body but " + std::to_string(bodies.size()) +
                           "; give one by its number, as in '" + reference.text("") + "[0]'");
  return bodies[0];
}

Link read_link(const Value& value) {
  Table table = value.table({"kind", "axis"});
  Link link{&read_kind(table.at("kind"), joint_kinds())};
  for (const std::string& key : link.kind->keys)
    if (key == "axis") link.axis = read_direction(table.at(key));
  table.expect_all_read(std::string("for a joint of kind '") + link.kind->name + "'");
  return link;
}

Joint read_joint(const Value& value, const Groups& groups) {
  Table table = value.table({"kind", "bodies", "anchor_m", "axis"});
  Joint joint;
  joint.kind = &read_kind(table.at("kind"), joint_kinds());
  const std::vector<Value> ends =
      table.at("bodies").list(2, "a list of two bodies, the second of which may be 'world'");
  joint.body_a = groups.body_of(ends[0]);
  const bool to_world = ends[1].is_text() && ends[1].text("") == "world";
  if (!to_world) joint.body_b = groups.body_of(ends[1]);
  if (joint.body_a == joint.body_b) ends[1].reject_value("another body than the first");
  read_geometry(table, *joint.kind, joint.anchor_m, joint.axis);
  return joint;
}

Event read_event(const Value& value, const Groups& groups) {
  Table table = value.table({"step", "bodies", "gravity", "velocity_m_per_s", "angular_velocity_rad_per_s"});
  Event event;
  event.step = table.at("step").integer(kStep);
  event.bodies = groups.bodies_of(table.at("bodies"));
  if (const auto gravity = table.find("gravity")) event.gravity = gravity->flag();
  if (const auto velocity = table.find("velocity_m_per_s"))
    event.velocity_m_per_s = read_drawn_vector(*velocity, kSpeed);
  if (const auto spin = table.find("angular_velocity_rad_per_s"))
    event.angular_velocity_rad_per_s = read_drawn_vector(*spin, kSpeed);
  if (!event.gravity && !event.velocity_m_per_s && !event.angular_velocity_rad_per_s)
    value.reject("changes nothing; give gravity, velocity_m_per_s or angular_velocity_rad_per_s");
  return event;
}

}  // namespace cleave::scene_file

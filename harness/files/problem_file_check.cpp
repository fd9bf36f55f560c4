#include "harness/files/problem_file_check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "harness/base/numbers.h"
#include "harness/base/printable_text.h"
#include "harness/files/problem_file_fields.h"
#include "solver/parts.h"

namespace cleave {
namespace {

std::string text_of(int value) { return std::to_string(value); }
std::string text_of(std::uint8_t value) { return std::to_string(value); }
std::string text_of(double value) { return number_text(value); }
std::string text_of(const std::string& value) { return '"' + printable(value) + '"'; }

// Keeps the first thing that is wrong.
class Requirements {
 public:
  template <class Value>
  void add(bool allowed, const std::string& name, const Value& value, const std::string& rule) {
    if (!allowed && error_.empty()) error_ = printable(name) + " = " + text_of(value) + ", allowed: " + rule;
  }
  template <class Value, class Predicate>
  void add_each(const std::string& name, const std::vector<Value>& values, Predicate allowed,
                const std::string& rule) {
    const auto wrong = std::ranges::find_if_not(values, allowed);
    if (wrong == values.end()) return;
    add(false, name + "[" + std::to_string(wrong - values.begin()) + "]", *wrong, rule);
  }
  void add_text(const std::string& name, const std::string& text) {
    add(is_printable_utf8(text), name, text, "printable UTF-8 text without control characters");
  }
  const std::string& error() const { return error_; }

 private:
  std::string error_;
};

bool is_finite(double value) { return std::isfinite(value); }
bool is_size(double value) { return std::isfinite(value) && value >= 0; }

void require_experiment(const ProblemFile& file, Requirements& require) {
  require.add_text("scene", file.scene);
  require.add_text("friction_model", file.friction_model);
  require.add(file.step >= 0, "step", file.step, ">= 0");
  require.add(is_size(file.erp), "erp", file.erp, "finite and >= 0");
  require.add(is_size(file.cfm), "cfm", file.cfm, "finite and >= 0");
  require.add_each("position", file.position, is_finite, "finite numbers");
  require.add_each("orientation", file.orientation, is_finite, "finite numbers");
}

void require_corners(const std::vector<int>& first, int corners, Requirements& require) {
  const std::string name = "shape/convex_first[";
  for (std::size_t i = 0; i < first.size(); ++i) {
    const int least = i == 0 ? 0 : first[i - 1];
    require.add(first[i] >= least && first[i] <= corners, name + std::to_string(i) + "]", first[i],
                std::to_string(least) + " to " + std::to_string(corners));
  }
  require.add(first.front() == 0, name + "0]", first.front(), "0");
  require.add(first.back() == corners, name + std::to_string(first.size() - 1) + "]", first.back(),
              std::to_string(corners) + ", the number of corners");
}

void require_shapes(const ProblemShapes& shapes, int bodies, Requirements& require) {
  const auto is_body = [bodies](int body) { return body >= -1 && body < bodies; };
  const auto is_type = [](std::uint8_t type) { return type <= static_cast<std::uint8_t>(GeomType::plane); };
  require.add_each("shape/geom_body", shapes.geom_body, is_body,
                   "-1 (static) to " + std::to_string(bodies - 1));
  require.add_each("shape/geom_type", shapes.geom_type, is_type,
                   "0 (box), 1 (sphere), 2 (capsule), 3 (cylinder), 4 (convex), 5 (plane)");
  require.add_each("shape/geom_size", shapes.geom_size, is_size, "finite and >= 0");
  require.add_each("shape/geom_position", shapes.geom_position, is_finite, "finite numbers");
  require.add_each("shape/geom_orientation", shapes.geom_orientation, is_finite, "finite numbers");
  require.add_each("shape/convex_points", shapes.convex_points, is_finite, "finite numbers");
  require_corners(shapes.convex_first, static_cast<int>(shapes.convex_points.size() / 3), require);
}

// Solutions are for `verify` to judge; here only what goes into lines of output.
void require_texts(const ProblemFile& file, Requirements& require) {
  const auto texts_in = [&require](const std::string& group) {
    return [&require, group](const char* name, const auto& value) {
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
        require.add_text(group + "/" + name, value);
    };
  };
  for (const auto& [label, solution] : file.solutions) {
    require.add_text("name in solution", label);
    visit_solution_attributes(solution, texts_in("solution/" + label));
  }
  for (const auto& [label, partition] : file.partitions) {
    require.add_text("name in partition", label);
    visit_partition_attributes(partition, texts_in("partition/" + label));
    for (const StoredParameter& parameter : partition.parameters) {
      require.add_text("name of an attribute of partition/" + label, parameter.name);
      require.add_text("partition/" + label + "/" + parameter.name, parameter.text);
    }
  }
}

// Of a tree; the ids of one level are for `verify`.
std::string find_parts_error(const ProblemFile& file) {
  for (const auto& [label, partition] : file.partitions) {
    const Parts parts(partition.part_of_body, partition.parent_of_part);
    const std::string error = PartsCheck().find_tree_error(parts, file.problem.body_count());
    if (!error.empty()) return "partition/" + printable(label) + "/" + error;
  }
  return {};
}

}  // namespace

std::string find_contents_error(const ProblemFile& file) {
  Requirements require;
  require_experiment(file, require);
  if (require.error().empty())
    if (std::string error = find_problem_error(file.problem); !error.empty()) return error;
  if (file.shapes) require_shapes(*file.shapes, file.problem.body_count(), require);
  require_texts(file, require);
  return require.error().empty() ? find_parts_error(file) : require.error();
}

}  // namespace cleave

// Tables and values of a scene file as they are read: whatever is wrong is one line that names file, line,
// key, value and what is allowed.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/base/numbers.h"

// Some damaged files break the library's assertions, which are errors of the file like any other.
namespace cleave::scene_file {
struct TomlAssertion {};
[[noreturn]] void throw_toml_assertion();
}  // namespace cleave::scene_file
#define TOML_ASSERT(condition) ((condition) ? void() : cleave::scene_file::throw_toml_assertion())
#include <toml++/toml.h>

namespace cleave::scene_file {

// Throws std::invalid_argument "pile.toml:7: body.mass_kg: text".
[[noreturn]] void reject_at(const std::string& file, const toml::source_region& source,
                            const std::string& key, const std::string& text);

// Throws the same of a text that is no TOML, with "not TOML" for the key.
toml::table parsed_toml(const std::string& text, const std::string& name);

class Table;

// One value and the key it stands under ("body.edges_m[2]"). What is asked for must be there, or it throws.
class Value {
 public:
  Value(const toml::node& node, std::string key, const std::string& file)
      : node_(&node), key_(std::move(key)), file_(&file) {}

  double number(const Range& range) const;
  int integer(const Range& range) const;
  bool flag() const;
  std::string text(const std::string& allowed) const;
  std::vector<Value> list(const std::string& allowed) const;
  std::vector<Value> list(std::size_t size, const std::string& allowed) const;
  Table table(const std::vector<std::string>& keys) const;
  bool is_table() const { return node_->is_table(); }
  bool is_text() const { return node_->is_string(); }

  [[noreturn]] void reject(const std::string& text) const;           // "key: text"
  [[noreturn]] void reject_value(const std::string& allowed) const;  // "key: 'value' is not allowed"

 private:
  const toml::node* node_;
  std::string key_;
  const std::string* file_;
};

class Table {
 public:
  // keys: all that a table of this name may have; any other is an error that names the nearest one.
  Table(const toml::table& table, std::string name, const std::string& file,
        const std::vector<std::string>& keys);

  Value at(const std::string& key);  // required
  std::optional<Value> find(const std::string& key);
  // Throws where a key is left that nobody asked for: "body.radius_m: has no meaning with shape 'box'".
  void expect_all_read(const std::string& circumstance) const;
  [[noreturn]] void reject(const std::string& key, const std::string& text) const;

 private:
  std::string path_of(const std::string& key) const { return name_.empty() ? key : name_ + '.' + key; }

  const toml::table* table_;
  std::string name_;
  const std::string* file_;
  std::set<std::string> read_;
};

}  // namespace cleave::scene_file

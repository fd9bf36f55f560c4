#include "scenarios/file_table.h"

#include <algorithm>
#include <stdexcept>

#include "harness/base/names.h"
#include "scenarios/file_characters.h"

namespace cleave::scene_file {
namespace {

std::string described(const toml::node& node) {
  if (const auto* text = node.as_string()) return "'" + text->get() + "'";
  if (const auto* number = node.as_floating_point()) return number_text(number->get());
  if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (node.is_array()) return "a list";
  return node.is_table() ? "a table" : "a date or time";
}

}  // namespace

void throw_toml_assertion() { throw TomlAssertion(); }

void reject_at(const std::string& file, const toml::source_region& source, const std::string& key,
               const std::string& text) {
  throw std::invalid_argument(file + ":" + std::to_string(source.begin.line) + ": " + key + ": " + text);
}

toml::table parsed_toml(const std::string& text, const std::string& name) {
  check_characters(text, name);
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    reject_at(name, error.source(), "not TOML", std::string(error.description()));
  } catch (const TomlAssertion&) {
    throw std::invalid_argument(name + ": not TOML: the parser gives up on it");
  }
}

void Value::reject(const std::string& text) const { reject_at(*file_, node_->source(), key_, text); }

void Value::reject_value(const std::string& allowed) const {
  reject(described(*node_) + " is not " + allowed);
}

double Value::number(const Range& range) const {
  if (!node_->is_number()) reject_value("a number in " + range.text());
  // The node's own conversion gives nothing for whole numbers beyond 2^53.
  const auto* integer = node_->as_integer();
  const double value =
      integer != nullptr ? static_cast<double>(integer->get()) : node_->as_floating_point()->get();
  if (!range.contains(value)) reject_value("in " + range.text());
  return value;
}

int Value::integer(const Range& range) const {
  const auto* integer = node_->as_integer();
  if (integer == nullptr) reject_value("a whole number in " + range.text());
  if (!range.contains(static_cast<double>(integer->get()))) reject_value("in " + range.text());
  return static_cast<int>(integer->get());
}

bool Value::flag() const {
  if (!node_->is_boolean()) reject_value("true or false");
  return node_->as_boolean()->get();
}

std::string Value::text(const std::string& allowed) const {
  if (!node_->is_string()) reject_value(allowed);
  return node_->as_string()->get();
}

std::vector<Value> Value::list(const std::string& allowed) const {
  if (!node_->is_array()) reject_value(allowed);
  std::vector<Value> values;
  for (const toml::node& element : *node_->as_array())
    values.emplace_back(element, key_ + '[' + std::to_string(values.size()) + ']', *file_);
  return values;
}

std::vector<Value> Value::list(std::size_t size, const std::string& allowed) const {
  std::vector<Value> values = list(allowed);
  if (values.size() != size) reject("a list of " + std::to_string(values.size()) + " is not " + allowed);
  return values;
}

Table Value::table(const std::vector<std::string>& keys) const {
  if (!node_->is_table()) reject_value("a table with " + joined(keys));
  return Table(*node_->as_table(), key_, *file_, keys);
}

Table::Table(const toml::table& table, std::string name, const std::string& file,
             const std::vector<std::string>& keys)
    : table_(&table), name_(std::move(name)), file_(&file) {
  for (const auto& [key, value] : table)
    if (std::ranges::find(keys, key.str()) == keys.end())
      reject_at(file, key.source(), path_of(std::string(key.str())), unknown_name_text(key.str(), keys));
}

std::optional<Value> Table::find(const std::string& key) {
  const toml::node* node = table_->get(key);
  if (node == nullptr) return std::nullopt;
  read_.insert(key);
  return Value(*node, path_of(key), *file_);
}

Value Table::at(const std::string& key) {
  const std::optional<Value> value = find(key);
  if (!value) reject(key, "is required");
  return *value;
}

void Table::expect_all_read(const std::string& circumstance) const {
  for (const auto& [key, value] : *table_)
    if (!read_.contains(std::string(key.str())))
      reject_at(*file_, key.source(), path_of(std::string(key.str())), "has no meaning " + circumstance);
}

void Table::reject(const std::string& key, const std::string& text) const {
  reject_at(*file_, table_->source(), path_of(key), text);
}

}  // namespace cleave::scene_file

#include "harness/campaign/spec.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/experiment/options.h"
#include "scenarios/file_table.h"
#include "scenarios/scene.h"

namespace cleave {
namespace {

using scene_file::reject_at;
using Options = std::map<std::string, std::string>;

constexpr const char* kValueForm = "a text, a number, true or false";

// One key of a grid and its values, in their order.
struct Dimension {
  std::string key;
  std::vector<std::string> values;
  toml::source_region source;
};

// Those of `run` that a cell may choose: where it goes is the campaign's business.
std::vector<std::string> option_names() {
  std::set<std::string> names;
  for (const OptionSpec& spec : run_option_specs())
    if (spec.commands.run && spec.name != "out" && spec.name != "force") names.insert(spec.name);
  for (const auto& row : common_parameters()) names.insert(row.parameter.name);
  for (const SceneEntry& scene : scenes())
    for (const Parameter& parameter : scene.parameters)
      if (parameter.kind != Parameter::Kind::path) names.insert(parameter.name);
  return {names.begin(), names.end()};
}

bool is_flag(const std::string& name) {
  if (const OptionSpec* spec = find_option(name)) return spec->kind == OptionKind::flag;
  return std::ranges::any_of(common_parameters(), [&](const auto& row) {
    return row.parameter.name == name && row.parameter.kind == Parameter::Kind::flag;
  });
}

class Reader {
 public:
  explicit Reader(std::string name) : name_(std::move(name)), keys_(option_names()) {}

  std::vector<CampaignCell> cells(const toml::table& file) {
    const std::vector<Dimension> grid = dimensions(file, {"include", "exclude"});
    std::vector<Options> found = product(grid, file);
    for (const toml::table* rule : rules(file, "exclude")) exclude(*rule, grid, found);
    for (const Options& options : found) add(options, grid, file);
    for (const toml::table* rule : rules(file, "include")) include(*rule, grid);
    if (cells_.empty()) throw std::invalid_argument(name_ + ": has no cell");
    return std::move(cells_);
  }

 private:
  std::string scalar(const toml::node& node, const std::string& key) const {
    if (const auto* text = node.as_string()) return text->get();
    if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
    if (const auto* number = node.as_floating_point()) return number_text(number->get());
    if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
    reject_at(name_, node.source(), key, std::string("is not ") + kValueForm);
  }

  // Numbers are made from the first, so that rounding does not pile up; the end counts with a part in 1e9 to spare.
  std::vector<std::string> range(const toml::table& node, const std::string& key) const {
    const std::string file = name_;
    scene_file::Table table(node, key, file, {"from", "to", "step", "factor"});
    const double from = table.at("from").number({}), to = table.at("to").number({});
    const auto step = table.find("step"), factor = table.find("factor");
    if (step.has_value() == factor.has_value()) reject_at(name_, node.source(), key, "needs either step or factor");
    if (factor && !(from > 0 && to > 0)) reject_at(name_, node.source(), key, "with factor, from and to are above 0");
    const double by = step ? step->number({0, INFINITY, true}) : factor->number({1, INFINITY, true});
    const double last = step ? (to - from) / by : std::log(to / from) / std::log(by);
    if (last < -1e-9) reject_at(name_, node.source(), key, "to is below from");
    if (last >= kMostCells) reject_at(name_, node.source(), key, "has more than " + std::to_string(kMostCells) + " values");
    std::vector<std::string> values;
    for (int k = 0; k <= static_cast<int>(last + 1e-9); ++k)
      values.push_back(rounded(step ? from + k * by : from * std::pow(by, k)));
    return values;
  }

  // 0.30000000000000004 is 0.3: twelve digits are more than anyone writes.
  static std::string rounded(double value) {
    std::ostringstream text;
    text.precision(12);
    text << value;
    return number_text(std::stod(text.str()));
  }

  std::vector<std::string> values(const toml::node& node, const std::string& key) const {
    if (node.is_table()) return range(*node.as_table(), key);
    if (!node.is_array()) return {scalar(node, key)};
    std::vector<std::string> texts;
    for (const toml::node& element : *node.as_array()) texts.push_back(scalar(element, key));
    if (texts.empty()) reject_at(name_, node.source(), key, "an empty list makes no cell");
    return texts;
  }

  // In the order of the file, which the library's table does not keep.
  std::vector<Dimension> dimensions(const toml::table& table, const std::vector<std::string>& others) const {
    std::vector<std::string> known = keys_;
    known.insert(known.end(), others.begin(), others.end());
    std::vector<Dimension> grid;
    for (const auto& [name, node] : table) {
      const std::string key(name.str());
      if (std::ranges::count(known, key) == 0) reject_at(name_, name.source(), key, unknown_name_text(key, known));
      if (std::ranges::count(others, key) == 0) grid.push_back({key, values(node, key), name.source()});
    }
    std::ranges::sort(grid, {}, [](const Dimension& d) {
      return std::tuple(d.source.begin.line, d.source.begin.column);
    });
    return grid;
  }

  std::vector<const toml::table*> rules(const toml::table& file, const std::string& key) const {
    std::vector<const toml::table*> found;
    const toml::node* node = file.get(key);
    if (node == nullptr) return found;
    if (!node->is_array_of_tables()) reject_at(name_, node->source(), key, "is not a list of tables: [[" + key + "]]");
    for (const toml::node& rule : *node->as_array()) found.push_back(rule.as_table());
    return found;
  }

  std::vector<Options> product(const std::vector<Dimension>& grid, const toml::table& table) const {
    if (grid.empty()) return {};
    std::vector<Options> all(1);
    for (const Dimension& dimension : grid) {
      if (all.size() * dimension.values.size() > kMostCells)
        reject_at(name_, table.source(), dimension.key, "makes more than " + std::to_string(kMostCells) + " cells");
      std::vector<Options> longer;
      for (const Options& options : all)
        for (const std::string& value : dimension.values) (longer.emplace_back(options))[dimension.key] = value;
      all = std::move(longer);
    }
    return all;
  }

  void exclude(const toml::table& rule, const std::vector<Dimension>& grid, std::vector<Options>& found) const {
    const std::vector<Dimension> unwanted = dimensions(rule, {});
    if (unwanted.empty()) reject_at(name_, rule.source(), "exclude", "has no key and would remove every cell");
    for (const Dimension& key : unwanted)
      if (std::ranges::count(grid, key.key, &Dimension::key) == 0)
        reject_at(name_, key.source, "exclude." + key.key, "is not a key of the cells");
    const std::size_t removed = std::erase_if(found, [&](const Options& options) {
      return std::ranges::all_of(
          unwanted, [&](const Dimension& key) { return std::ranges::count(key.values, options.at(key.key)) > 0; });
    });
    if (removed == 0) reject_at(name_, rule.source(), "exclude", "removes no cell");
  }

  void include(const toml::table& rule, const std::vector<Dimension>& grid) {
    std::vector<Dimension> own = dimensions(rule, {});
    if (own.empty()) reject_at(name_, rule.source(), "include", "has no key");
    for (const Dimension& key : grid)
      if (key.values.size() == 1 && std::ranges::count(own, key.key, &Dimension::key) == 0) own.push_back(key);
    for (const Options& options : product(own, rule)) add(options, own, rule);
  }

  void add(Options options, const std::vector<Dimension>& grid, const toml::table& table) {
    std::erase_if(options, [](const auto& option) { return option.second == "false" && is_flag(option.first); });
    try {
      const std::string id = run_id(parse_run_options(options));
      if (!ids_.insert(id).second)
        reject_at(name_, table.source(), "cell " + std::to_string(cells_.size() + 1), "is there already (run id " + id + ")");
      cells_.push_back({options, id});
    } catch (const std::invalid_argument& error) {
      const std::string text = error.what();
      for (const Dimension& key : grid)
        if (text.starts_with("--" + key.key + ":") || text.starts_with("--" + key.key + " "))
          reject_at(name_, key.source, key.key, text);
      if (text.starts_with(name_)) throw;
      reject_at(name_, table.source(), "cell " + std::to_string(cells_.size() + 1), text);
    }
  }

  std::string name_;
  std::vector<std::string> keys_;
  std::vector<CampaignCell> cells_;
  std::set<std::string> ids_;
};

}  // namespace

std::vector<std::string> CampaignCell::arguments() const {
  std::vector<std::string> words;
  for (const auto& [name, value] : options)
    words.push_back(is_flag(name) ? "--" + name : "--" + name + "=" + value);
  return words;
}

std::vector<CampaignCell> parse_campaign(const std::string& text, const std::string& name) {
  return Reader(name).cells(scene_file::parsed_toml(text, name));
}

std::vector<CampaignCell> read_campaign(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || std::filesystem::is_directory(path)) throw std::invalid_argument("SPEC: '" + path + "' cannot be read");
  text << file.rdbuf();
  return parse_campaign(text.str(), path);
}

}  // namespace cleave

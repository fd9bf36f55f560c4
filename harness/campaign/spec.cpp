#include "harness/campaign/spec.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "harness/base/file_text.h"
#include "harness/base/names.h"
#include "harness/campaign/cell_label.h"
#include "harness/campaign/spec_grid.h"
#include "harness/experiment/option_values.h"
#include "harness/experiment/options.h"
#include "scenarios/scene.h"

namespace cleave {
namespace {

using scene_file::reject_at;
using Options = std::map<std::string, std::string>;

constexpr int kMostRounds = 1000;
const std::vector<std::string> kRules = {"include", "exclude", "rounds", kLabelKey};

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
  const CommonParameter* common = find_common_parameter(name);
  return common != nullptr && common->parameter.kind == Parameter::Kind::flag;
}

// The options of a cell read as `run` reads them.
CampaignCell checked_cell(const Options& options) {
  CampaignCell cell;
  cell.options = options;
  Options given = options;
  given["out"] = "-";  // is required, and the campaign's
  const std::vector<OptionValue> values = option_values(parse_run_options(given));
  cell.run_id = run_id(values);
  for (const OptionValue& value : values)
    if (!value.in_run_id && value.name != "out" && value.name != "force")
      cell.beside_run_id[value.name] = value.text;
  return cell;
}

class Expansion {
 public:
  explicit Expansion(const std::string& file) : file_(file), known_(option_names()) {}

  std::vector<CampaignCell> cells(const toml::table& spec) {
    const Grid grid = read_grid(spec, file_, known_, kRules);
    for (const toml::node* rule : rules(spec, "include"))
      check_size(read_grid(*rule->as_table(), file_, known_, {kLabelKey}), *rule);
    check_size(grid, spec);
    const CellLabel label(spec, file_);
    const bool has_cells = find_dimension(grid, "scene") != nullptr;
    read_exclusions(spec, grid);
    if (has_cells) {
      std::vector<Options> found = product(grid);
      exclude(found);
      for (const Options& options : found) add(options, grid, spec, label);
    }
    for (const toml::node* rule : rules(spec, "include")) include(*rule->as_table(), grid, label);
    for (const Exclusion& exclusion : exclusions_)
      if (exclusion.removed == 0)
        reject_at(file_, exclusion.rule->source(), "exclude",
                  "removes no cell" + why_nothing_goes(exclusion));
    if (cells_.empty())
      throw std::invalid_argument(
          file_ + ": has no cell" +
          (has_cells ? "" : "; the key scene is required, here or in an [[include]]"));
    return in_rounds(spec);
  }

 private:
  std::vector<const toml::node*> rules(const toml::table& spec, const std::string& key) const {
    std::vector<const toml::node*> found;
    const toml::node* node = spec.get(key);
    if (node == nullptr) return found;
    if (!node->is_array_of_tables())
      reject_at(file_, node->source(), key, "is not a list of tables: [[" + key + "]]");
    for (const toml::node& rule : *node->as_array()) found.push_back(&rule);
    return found;
  }

  void check_size(const Grid& grid, const toml::node& node) const {
    if (product_size(grid) > kMostCells)
      reject_at(file_, grid.empty() ? node.source() : grid.back().source,
                grid.empty() ? "cells" : grid.back().key,
                "makes more than " + std::to_string(kMostCells) + " cells");
  }

  struct Exclusion {
    const toml::node* rule;
    Grid unwanted;
    std::size_t removed = 0;
  };

  void read_exclusions(const toml::table& spec, const Grid& grid) {
    for (const toml::node* rule : rules(spec, "exclude")) {
      const Grid unwanted = read_grid(*rule->as_table(), file_, known_);
      if (unwanted.empty())
        reject_at(file_, rule->source(), "exclude", "has no key and would remove every cell");
      for (const Dimension& dimension : unwanted)
        if (find_dimension(grid, dimension.key) == nullptr)
          reject_at(file_, dimension.source, dimension.key,
                    "is no key of the cells, so that nothing is excluded by it");
      exclusions_.push_back({rule, unwanted});
    }
  }

  // A key of which no value is one that cells have; empty: there is none.
  std::string why_nothing_goes(const Exclusion& exclusion) const {
    for (const Dimension& dimension : exclusion.unwanted) {
      const auto found = values_.find(dimension.key);
      if (found == values_.end()) continue;
      const std::vector<std::string> values(found->second.begin(), found->second.end());
      const auto occurs = [&](const std::string& value) { return std::ranges::count(values, value) > 0; };
      if (!dimension.values.empty() && std::ranges::none_of(dimension.values, occurs))
        return ": " + dimension.key + ": " + unknown_name_text(dimension.values.front(), values);
    }
    return {};
  }

  void exclude(std::vector<Options>& found) {
    for (const Exclusion& exclusion : exclusions_)
      for (const Dimension& dimension : exclusion.unwanted)
        for (const Options& options : found) values_[dimension.key].insert(options.at(dimension.key));
    for (Exclusion& exclusion : exclusions_)
      exclusion.removed += std::erase_if(found, [&](const Options& options) {
        return std::ranges::all_of(exclusion.unwanted, [&](const Dimension& dimension) {
          return std::ranges::count(dimension.values, options.at(dimension.key)) > 0;
        });
      });
  }

  void include(const toml::table& rule, const Grid& grid, const CellLabel& outer) {
    Grid own = read_grid(rule, file_, known_, {kLabelKey});
    const CellLabel label(rule, file_, &outer);
    if (own.empty()) reject_at(file_, rule.source(), "include", "has no key");
    const bool takes_lists = find_dimension(grid, "scene") == nullptr;
    for (const Dimension& dimension : grid)
      if ((takes_lists || dimension.values.size() == 1) && find_dimension(own, dimension.key) == nullptr)
        own.push_back(dimension);
    check_size(own, rule);
    const std::size_t before = cells_.size();
    std::vector<Options> found = product(own);
    if (takes_lists) exclude(found);
    for (const Options& options : found) add(options, own, rule, label);
    if (cells_.size() == before)
      reject_at(file_, rule.source(), "include", "adds no cell that is not there already");
  }

  // Series of cells may share some, which run once; but a dimension that makes the same cell twice is none.
  void add(Options options, const Grid& grid, const toml::table& table, const CellLabel& label) {
    const std::string text = label.of(options);
    std::erase_if(options,
                  [](const auto& option) { return option.second == "false" && is_flag(option.first); });
    const std::string place = "cell " + std::to_string(cells_.size() + 1);
    CampaignCell cell;
    try {
      cell = checked_cell(options);
    } catch (const std::invalid_argument& error) {
      reject_cell(error.what(), grid, table, place);
    }
    const auto [maker, is_new] = makers_.emplace(cell.name(), Maker{&table, cell.beside_run_id});
    if (!is_new && (maker->second.table == &table || maker->second.beside_run_id != cell.beside_run_id))
      reject_at(file_, table.source(), place,
                "is there already: another cell has the same run id " + cell.run_id + " and threads");
    if (!is_new) return;
    cell.label = text;
    if (!text.empty() && !labels_.insert(text).second) label.reject("two cells are called '" + text + "'");
    if (cells_.size() == kMostCells)
      reject_at(file_, table.source(), place,
                "is one more than the " + std::to_string(kMostCells) + " that are allowed");
    cells_.push_back(std::move(cell));
  }

  // At the key that the error of `run` names, where the spec has it.
  [[noreturn]] void reject_cell(const std::string& text, const Grid& grid, const toml::table& table,
                                const std::string& place) const {
    for (const Dimension& dimension : grid) {
      const std::string option = "--" + dimension.key + ": ";
      if (text.starts_with(option))
        reject_at(file_, dimension.source, dimension.key, text.substr(option.size()));
    }
    reject_at(file_, table.source(), place, text);
  }

  std::vector<CampaignCell> in_rounds(const toml::table& spec) const {
    int rounds = 1;
    if (const toml::node* node = spec.get("rounds"))
      rounds = scene_file::Value(*node, "rounds", file_).integer({1, kMostRounds});
    if (static_cast<double>(rounds) * static_cast<double>(cells_.size()) > kMostCells)
      reject_at(file_, spec.get("rounds")->source(), "rounds",
                "make more than " + std::to_string(kMostCells) + " cells");
    std::vector<CampaignCell> all;
    for (int round = 1; round <= rounds; ++round)
      for (const CampaignCell& cell : cells_) all.emplace_back(cell).round = round;
    return all;
  }

  struct Maker {
    const toml::table* table;
    std::map<std::string, std::string> beside_run_id;
  };

  const std::string& file_;
  std::vector<std::string> known_;
  std::map<std::string, std::set<std::string>>
      values_;  // by key of exclusions, of the cells that they looked at
  std::vector<Exclusion> exclusions_;
  std::vector<CampaignCell> cells_;
  std::map<std::string, Maker> makers_;  // by the name of the cell, who made it
  std::set<std::string> labels_;
};

}  // namespace

std::string CampaignCell::name() const {
  return run_id + "_t" + beside_run_id.at("threads") + "_r" + std::to_string(round);
}

std::vector<std::string> CampaignCell::arguments() const {
  std::vector<std::string> words;
  for (const auto& [name, value] : options)
    words.push_back(is_flag(name) ? "--" + name : "--" + name + "=" + value);
  return words;
}

std::vector<CampaignCell> parse_campaign(const std::string& text, const std::string& file) {
  return Expansion(file).cells(scene_file::parsed_toml(text, file));
}

std::string read_spec(const std::string& path) {
  std::optional<std::string> text = file_text(path);
  if (!text) throw std::invalid_argument("SPEC: '" + path + "' cannot be read");
  return *std::move(text);
}

}  // namespace cleave

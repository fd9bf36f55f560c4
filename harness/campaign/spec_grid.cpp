#include "harness/campaign/spec_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <tuple>

#include "harness/base/names.h"
#include "harness/base/numbers.h"

namespace cleave {
namespace {

using scene_file::reject_at;

constexpr int kMostValues = 100000;     // of a range
constexpr double kEndTolerance = 1e-9;  // in steps: 0.1 + 0.1 + 0.1 reaches 0.3
constexpr Range kAnyNumber{};
constexpr Range kStep{0, INFINITY, true}, kFactor{1, INFINITY, true};

// As the command line takes it: 100000, not 1e+05, which is no count.
std::string value_text(double value) {
  constexpr double kExact = 9007199254740992;  // 2^53
  const bool is_whole = value == std::floor(value) && std::abs(value) <= kExact;
  return is_whole ? std::to_string(static_cast<long long>(value)) : number_text(value);
}

// Twelve digits are more than anyone writes, and 0.30000000000000004 is 0.3 in them. Whole numbers are as
// they are.
double rounded(double value) {
  if (value == std::floor(value)) return value;
  char text[40];
  std::snprintf(text, sizeof text, "%.12g", value);
  return std::strtod(text, nullptr);
}

class Reader {
 public:
  explicit Reader(const std::string& file) : file_(file) {}

  std::vector<std::string> values(const toml::node& node, const std::string& key) const {
    if (node.is_table()) return range(*node.as_table(), key);
    if (!node.is_array()) return {scalar(node, key)};
    std::vector<std::string> texts;
    for (const toml::node& element : *node.as_array()) texts.push_back(scalar(element, key));
    if (texts.empty()) reject_at(file_, node.source(), key, "an empty list makes no cell");
    return texts;
  }

 private:
  std::string scalar(const toml::node& node, const std::string& key) const {
    if (const auto* text = node.as_string(); text != nullptr && !text->get().empty()) return text->get();
    if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
    if (const auto* number = node.as_floating_point()) return value_text(number->get());
    if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
    reject_at(
        file_, node.source(), key,
        "is not a text, a number, true or false, a list of these, or a range { from, to, step | factor }");
  }

  // Each from the first, so that rounding does not pile up.
  std::vector<std::string> range(const toml::table& node, const std::string& key) const {
    scene_file::Table table(node, key, file_, {"from", "to", "step", "factor"});
    const double from = table.at("from").number(kAnyNumber), to = table.at("to").number(kAnyNumber);
    const auto step = table.find("step"), factor = table.find("factor");
    const auto reject = [&](const std::string& text) { reject_at(file_, node.source(), key, text); };
    if (step.has_value() == factor.has_value()) reject("needs either step or factor");
    if (factor && !(from > 0 && to > 0)) reject("from and to must be above 0 with factor");
    const double by = step ? step->number(kStep) : factor->number(kFactor);
    const double last = (step ? (to - from) / by : std::log(to / from) / std::log(by)) + kEndTolerance;
    if (last < 0) reject("to is below from, which makes no cell");
    if (last >= kMostValues) reject("makes more than " + std::to_string(kMostValues) + " values");
    std::vector<std::string> values;
    for (int k = 0; k <= last; ++k)
      values.push_back(value_text(rounded(step ? from + k * by : from * std::pow(by, k))));
    return values;
  }

  const std::string& file_;
};

}  // namespace

const Dimension* find_dimension(const Grid& grid, const std::string& key) {
  const auto found = std::ranges::find(grid, key, &Dimension::key);
  return found == grid.end() ? nullptr : &*found;
}

Grid read_grid(const toml::table& table, const std::string& file, const std::vector<std::string>& known,
               const std::vector<std::string>& others) {
  const Reader reader(file);
  Grid grid;
  for (const auto& [name, node] : table) {
    const std::string key(name.str());
    if (std::ranges::count(others, key) > 0) continue;
    if (std::ranges::count(known, key) == 0) {
      std::vector<std::string> allowed = known;
      allowed.insert(allowed.end(), others.begin(), others.end());
      const std::string question = nearest_question(key, allowed);
      reject_at(file, name.source(), key,
                "is no option of cleave run that a cell may have" +
                    (question.empty() ? "; see cleave run --help" : question));
    }
    grid.push_back({key, reader.values(node, key), name.source()});
  }
  // The library's table is in the order of names.
  std::ranges::sort(grid, {}, [](const Dimension& dimension) {
    return std::tuple(dimension.source.begin.line, dimension.source.begin.column);
  });
  return grid;
}

double product_size(const Grid& grid) {
  double size = 1;
  for (const Dimension& dimension : grid) size *= static_cast<double>(dimension.values.size());
  return size;
}

std::vector<std::map<std::string, std::string>> product(const Grid& grid) {
  std::vector<std::map<std::string, std::string>> all(1);
  for (const Dimension& dimension : grid) {
    std::vector<std::map<std::string, std::string>> longer;
    longer.reserve(all.size() * dimension.values.size());
    for (const auto& options : all)
      for (const std::string& value : dimension.values) longer.emplace_back(options)[dimension.key] = value;
    all = std::move(longer);
  }
  return all;
}

}  // namespace cleave

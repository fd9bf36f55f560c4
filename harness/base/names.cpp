#include "harness/base/names.h"

#include <algorithm>
#include <stdexcept>

namespace cleave {

int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 1;
  // distance[i * columns + j]: between the first i characters of a and the first j of b.
  std::vector<int> distance((a.size() + 1) * columns);
  for (std::size_t i = 0; i <= a.size(); ++i) distance[i * columns] = static_cast<int>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) distance[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substitution = distance[(i - 1) * columns + j - 1] + (a[i - 1] != b[j - 1]);
      int best =
          std::min({distance[(i - 1) * columns + j] + 1, distance[i * columns + j - 1] + 1, substitution});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) best = std::min(best, distance[(i - 2) * columns + j - 2] + 1);
      distance[i * columns + j] = best;
    }
  }
  return distance.back();
}

std::string nearest_name(std::string_view word, std::span<const std::string> choices) {
  const auto distance_to = [word](const std::string& choice) { return edit_distance(word, choice); };
  const auto nearest = std::ranges::min_element(choices, {}, distance_to);
  if (nearest == choices.end()) return "";
  const int longer = static_cast<int>(std::max(word.size(), nearest->size()));
  if (2 * distance_to(*nearest) <= longer) return *nearest;
  // A cut-off name ("interior" for "interior-point:dense") is far in edits but plain to a reader.
  const auto begins = [word](const std::string& choice) { return !word.empty() && choice.starts_with(word); };
  const auto completed = std::ranges::find_if(choices, begins);
  return completed == choices.end() ? "" : *completed;
}

std::string nearest_question(std::string_view word, std::span<const std::string> choices) {
  const std::string nearest = nearest_name(word, choices);
  return nearest.empty() ? "" : " (did you mean '" + nearest + "'?)";
}

std::string unknown_name_text(std::string_view word, std::span<const std::string> choices) {
  std::string text = "'";
  text.append(word).append("' is unknown").append(nearest_question(word, choices));
  return text.append("; choices: ").append(joined(choices));
}

std::string joined(std::span<const std::string> words, std::string_view separator) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

void check_name(const std::string& option, const std::string& name, std::span<const std::string> choices) {
  if (std::ranges::find(choices, name) == choices.end())
    throw std::invalid_argument(option + ": " + unknown_name_text(name, choices));
}

}  // namespace cleave

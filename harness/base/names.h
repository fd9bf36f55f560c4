// Names of a table, and error texts for those that are in none: the nearest name and all choices, in one
// line.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cleave {

// Damerau-Levenshtein distance in its optimal-string-alignment form: the least number of insertions,
// deletions, substitutions and swaps of neighbouring characters, no substring being edited twice.
int edit_distance(std::string_view a, std::string_view b);

// The choice of least edit distance (the first on ties), or an empty string when even that one differs in
// more than half of the longer word and does not begin with the word.
std::string nearest_name(std::string_view word, std::span<const std::string> choices);

// " (did you mean 'mindp'?)", or nothing when nothing is near.
std::string nearest_question(std::string_view word, std::span<const std::string> choices);

// "'mindq' is unknown (did you mean 'mindp'?); choices: mindp, maxdp, ..."; no question when nothing is near.
std::string unknown_name_text(std::string_view word, std::span<const std::string> choices);

// The names of a registry table: rows with a member `name`.
template <class Row, std::size_t N>
std::vector<std::string> names_of(std::span<Row, N> table) {
  std::vector<std::string> names;
  for (const auto& row : table) names.emplace_back(row.name);
  return names;
}

// option: what an error begins with. Throws std::invalid_argument: "--solver: 'densse' is unknown (did you
// mean 'dense'?); choices: dense, ...".
void check_name(const std::string& option, const std::string& name, std::span<const std::string> choices);

// "a, b, c"
std::string joined(std::span<const std::string> words, std::string_view separator = ", ");

}  // namespace cleave

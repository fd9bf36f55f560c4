// The keys of one table of a campaign's spec with their values, and the product of them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "scenarios/file_table.h"

namespace cleave {

// One key and its values, in their order, as texts that the command line would take.
struct Dimension {
  std::string key;
  std::vector<std::string> values;
  toml::source_region source;  // of the key
};
using Grid = std::vector<Dimension>;

// The dimension of that key, nullptr where there is none.
const Dimension* find_dimension(const Grid& grid, const std::string& key);

// In the order of the file. known: keys that there may be. others: those of them that are no dimensions and
// are passed over. Throws std::invalid_argument "FILE:LINE: KEY: text" for an unknown key and for a value of
// another form.
Grid read_grid(const toml::table& table, const std::string& file, const std::vector<std::string>& known,
               const std::vector<std::string>& others = {});

// All combinations of the values, the last key varying fastest; one, empty, of no key.
std::vector<std::map<std::string, std::string>> product(const Grid& grid);

// How many those are; may be more than there is room for.
double product_size(const Grid& grid);

}  // namespace cleave

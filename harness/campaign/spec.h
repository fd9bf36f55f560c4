// A campaign as a TOML file: keys are option names of `cleave run`, and cells are the combinations of their values.
//
//     scene = "rock_pile"
//     bodies = [50, 100, 200]                    a list is a dimension
//     cfm = { from = 1e-8, to = 1e-5, factor = 10 }   so is a range, with both ends; step adds, factor multiplies
//     partitioner = "mindp,mix"                  a comma string is one value: these run in lockstep
//     [[exclude]]                                removes cells that have, of every key here, one of its values
//     bodies = 200
//     [[include]]                                adds the cells of a grid of its own, after the exclusion; keys of the
//     bodies = 400                               file with one value hold here too
//
// Cells stand in the order of the product, the key written last varying fastest.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace cleave {

struct CampaignCell {
  std::map<std::string, std::string> options;  // by name, as `run` takes them; flags that are false are left out
  std::string run_id;

  std::vector<std::string> arguments() const;  // of `cleave run`, without --out
};

inline constexpr int kMostCells = 1000000;

// Throws std::invalid_argument "spec.toml:7: bodys: ...": no TOML, an unknown key (and the nearest one), a value that `run`
// would refuse, a rule that removes nothing, two cells of one run id, no cell at all, more than kMostCells.
std::vector<CampaignCell> read_campaign(const std::string& path);
std::vector<CampaignCell> parse_campaign(const std::string& text, const std::string& name);

}  // namespace cleave

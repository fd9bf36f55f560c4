// A campaign as a TOML file: keys are option names of `cleave run`, and cells are the combinations of their
// values.
//
//     scene = "rock_pile"
//     bodies = [50, 100, 200]                         a list is a dimension
//     cfm = { from = 1e-8, to = 1e-5, factor = 10 }   a range, with both ends; step adds, factor multiplies
//     partitioner = "mindp,mix"                       a text with commas is one value: these run in lockstep
//     record-motion = true                            a flag is given or not
//     rounds = 3                                      all cells, three times over: no option of `run`
//     label = "rocks_{bodies}/cfm_{cfm}"              what cells are called, with values: no option of `run`
//     [[exclude]]                                     removes cells that have, of every key here, one of
//     bodies = 200                                    its values
//     [[include]]                                     adds the cells of a grid of its own, after every
//     bodies = 400                                    exclusion; keys of the file with one value hold here
//                                                     too, unless given anew
//
// A cell that an [[include]] makes and that is there already is the same cell, with the label that it has.
// The label of the file holds in every [[include]] without one; no two cells may have the same.
//
// Without `scene` the keys of the file make no cells by themselves and hold in every [[include]], lists too,
// and so do its exclusions. Cells stand in the order of the product, the key written last varying fastest,
// then those of every [[include]]; a round is all of them, so that what drifts meanwhile meets all cells
// alike.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace cleave {

struct CampaignCell {
  std::map<std::string, std::string>
      options;  // by name, as `run` takes them; flags that are false are left out
  std::map<std::string, std::string>
      beside_run_id;  // threads and others that change no row, as a manifest has them
  std::string run_id;
  int round = 1;
  std::string label;  // empty without one

  // Of the cell's output directory: "0123456789abcdef_t1_r1", run id, threads and round.
  std::string name() const;
  // Of `cleave run`, without --out.
  std::vector<std::string> arguments() const;
};

inline constexpr int kMostCells = 100000;

// Throws std::invalid_argument "spec.toml:7: bodys: ...": no TOML, an unknown key (and the nearest one), a
// value that `run` would refuse before it makes anything, a rule that removes or adds nothing, a dimension
// that makes a cell twice, no cell at all, more than kMostCells. file: what errors call the text.
std::vector<CampaignCell> parse_campaign(const std::string& text, const std::string& file);

// All bytes of the file. Throws the same where it cannot be read.
std::string read_spec(const std::string& path);

}  // namespace cleave

#include "harness/commands/command.h"

namespace cleave {

std::span<const Command> commands() {
  static constexpr Command table[] = {
      {"list", "name the scenes, partitioners, refiners, solvers, ... there are", declare_list},
      {"run", "simulate a scene and measure every combination on it", declare_run},
      {"record", "simulate a scene and write the problems of chosen steps to files", declare_record},
      {"replay", "solve recorded problems with every combination", declare_replay},
      {"sweep", "run a campaign of many runs from a TOML file, and go on with it where it was",
       declare_sweep},
      {"rerun", "repeat a run from its manifest and hold its rows against those it left", declare_rerun},
      {"export", "write the body graph or a matrix of a recorded problem for other programs", declare_export},
      {"import", "make a problem file of a problem that another program wrote", declare_import},
      {"collect", "put the rows of many output directories into one table", declare_collect},
      {"compare", "hold the times of two campaigns against each other, cell by cell", declare_compare},
      {"calibrate", "fit the cost model of partitions to this machine", declare_calibrate},
      {"verify", "check solutions, partitions and rows from the files alone", declare_verify},
  };
  return table;
}

}  // namespace cleave

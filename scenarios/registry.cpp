#include "scenarios/chain_drop.h"
#include "scenarios/log_tower.h"
#include "scenarios/rock_pile.h"
#include "scenarios/scene.h"

namespace cleave {

std::span<const SceneEntry> scenes() {
  static const SceneEntry table[] = {
      {"chain_drop", "a chain of capsules on ball joints dropped into a funnel, where it heaps up",
       "Liu and Andrews 2022, Chain Drop", chain_drop_parameters(), make_chain_drop},
      {"log_tower", "crossed layers of logs at rest, knocked down by a ball at step 60",
       "Liu and Andrews 2022, Log Tower", log_tower_parameters(), make_log_tower},
      {"rock_pile", "rocks of one mass dropped into a square pit", "Liu and Andrews 2022, Rock Pile",
       rock_pile_parameters("200", "100"), make_rock_pile},
      {"large_rock_pile", "three times as many rocks of mixed masses dropped into a square pit",
       "Liu and Andrews 2022, Large Rock Pile", rock_pile_parameters("600", "10,100,1000"), make_rock_pile},
  };
  return table;
}

}  // namespace cleave

#include "scenarios/chain_drop.h"
#include "scenarios/crane.h"
#include "scenarios/file_scene.h"
#include "scenarios/ladder_chain.h"
#include "scenarios/ladder_free.h"
#include "scenarios/ladder_loop.h"
#include "scenarios/ladder_stack.h"
#include "scenarios/log_tower.h"
#include "scenarios/mixed_site.h"
#include "scenarios/rock_pile.h"
#include "scenarios/scene.h"
#include "scenarios/silo.h"

namespace cleave {
namespace {

bool always(const Settings&) { return true; }

}  // namespace

std::span<const SceneEntry> scenes() {
  static const SceneEntry table[] = {
      {{"chain_drop", "a chain of capsules on ball joints dropped into a funnel, where it heaps up",
        "Liu and Andrews 2022, Chain Drop", chain_drop_parameters()},
       make_chain_drop},
      {{"log_tower", "crossed layers of logs at rest, knocked down by a ball at step 60",
        "Liu and Andrews 2022, Log Tower", log_tower_parameters()},
       make_log_tower},
      {{"rock_pile", "rocks of one mass dropped into a square pit", "Liu and Andrews 2022, Rock Pile",
        rock_pile_parameters("200", "100")},
       make_rock_pile},
      {{"large_rock_pile", "three times as many rocks of mixed masses dropped into a square pit",
        "Liu and Andrews 2022, Large Rock Pile", rock_pile_parameters("600", "10,100,1000")},
       make_rock_pile},
      {{"silo", "boxes laid close in a pit as wide as they are high, nearly at rest from the start",
        "scenarios/README.md", silo_parameters()},
       make_silo},
      {{"crane",
        "a crane on outriggers slews a heavy load on a cable of light links (--dt 0.001 --cfm 1e-10)",
        "Peiret et al. 2019; scenarios/README.md", crane_parameters()},
       make_crane,
       always},
      {{"mixed_site", "a crane lifts a rock out from under a pile (--dt 0.001 --cfm 1e-10)",
        "scenarios/README.md", mixed_site_parameters()},
       make_mixed_site,
       always},
      {{"ladder_stack", "equal boxes in a stack, their contacts reported as often as asked for",
        "scenarios/README.md", ladder_stack_parameters()},
       make_ladder_stack},
      {{"ladder_heavy_top", "a heavy box on a stack of light ones", "scenarios/README.md",
        ladder_heavy_top_parameters()},
       make_ladder_heavy_top},
      {{"ladder_alternating", "light and heavy boxes in turn in a stack", "scenarios/README.md",
        ladder_alternating_parameters()},
       make_ladder_alternating},
      {{"ladder_incline", "boxes that hold or slide on an inclined plane", "scenarios/README.md",
        ladder_incline_parameters()},
       make_ladder_incline},
      {{"ladder_chain", "a chain with a heavy bob, hanging from a fixed point", "scenarios/README.md",
        ladder_chain_parameters()},
       make_ladder_chain},
      {{"ladder_loop", "a ring of links on hinges that hold some directions twice", "scenarios/README.md",
        ladder_loop_parameters()},
       make_ladder_loop},
      {{"ladder_free", "falling boxes that touch nothing", "scenarios/README.md", ladder_free_parameters()},
       make_ladder_free},
      {{"file", "bodies, joints and events that a file describes", "scenarios/FILE_SCENES.md",
        file_scene_parameters(), file_scene_content_id},
       make_file_scene,
       file_scene_names_groups},
  };
  return table;
}

}  // namespace cleave

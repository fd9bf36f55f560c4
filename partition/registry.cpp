#include "partition/registry.h"

namespace cleave {

std::unique_ptr<Partitioner> make_mindp();
std::unique_ptr<Partitioner> make_maxdp();
std::unique_ptr<Partitioner> make_bfs();
std::unique_ptr<Partitioner> make_mass_ratio();
std::unique_ptr<Partitioner> make_mix();

std::unique_ptr<Refiner> make_none();
std::unique_ptr<Refiner> make_kernighan_lin();
std::unique_ptr<Refiner> make_fiduccia_mattheyses();

namespace {

constexpr const char* kGrowing = "Liu & Andrews 2022, section 3.1";
constexpr const char* kRefining = "Liu & Andrews 2022, section 3.2";

const PartitionerEntry kPartitioners[] = {
    {"mindp", "grow by the body of least degree", kGrowing, make_mindp},
    {"maxdp", "grow by the body of greatest degree", kGrowing, make_maxdp},
    {"bfs", "grow breadth first", kGrowing, make_bfs},
    {"mr", "grow by bodies whose mass ratio stays below tau_mr", kGrowing, make_mass_ratio},
    {"mix", "grow by least degree, then by greatest edge weight into the part",
     "Liu & Andrews 2022, Algorithm 1", make_mix},
};

const RefinerEntry kRefiners[] = {
    {"none", "no refinement", kRefining, make_none},
    {"kl", "swap bodies of two parts while the cut falls (Kernighan & Lin 1970)", kRefining,
     make_kernighan_lin},
    {"fm", "move single bodies while the cut falls (Fiduccia & Mattheyses 1982)", kRefining,
     make_fiduccia_mattheyses},
};

}  // namespace

std::span<const PartitionerEntry> partitioners() { return kPartitioners; }
std::span<const RefinerEntry> refiners() { return kRefiners; }

}  // namespace cleave

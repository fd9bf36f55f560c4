// The program cleave_peers: cleave, with other people's solvers among the solvers. They are linked here
// alone.
#include <stdexcept>

#include "harness/peers/peer_table.h"
#include "harness/program.h"
#if CLEAVE_SICONOS_COMMAND
#include "harness/peers/siconos_command.h"
#endif

namespace cleave {
namespace {

#if !CLEAVE_SICONOS_COMMAND
std::function<int()> declare_siconos_error(CLI::App& app, const std::vector<std::string>&) {
  app.allow_extras();
  return []() -> int {
    throw std::invalid_argument("is not in this build: install libsiconos-numerics-dev and build again");
  };
}
#endif

constexpr Command kMore[] = {
    {"siconos-error", "the error that Siconos finds in stored solutions", declare_siconos_error}};

}  // namespace
}  // namespace cleave

int main(int argc, char** argv) {
  cleave::add_solvers(cleave::peer_table());
  return cleave::run_program("cleave_peers", cleave::kMore, argc, argv);
}

#include "harness/peers/peer_table.h"

#include <array>
#include <utility>

#include "harness/peers/peer_solver.h"
#include "solver/parameters.h"

namespace cleave {
namespace {

using namespace parameters;

struct Library {
  bool is_there;
  const char* package;
};
// CMakeLists.txt says 0 or 1 for each.
constexpr Library kBullet{CLEAVE_BULLET == 1, "libbullet-dev"};
constexpr Library kDart{CLEAVE_DART == 1, "libdart-dev"};
constexpr Library kIpopt{CLEAVE_IPOPT == 1, "coinor-libipopt-dev"};
constexpr Library kSiconos{CLEAVE_SICONOS == 1, "libsiconos-numerics-dev"};

// Without its library a function is not there to be linked.
template <bool IsThere, PeerFunction Function>
constexpr PeerFunction if_there() {
  if constexpr (IsThere) {
    return Function;
  } else {
    return nullptr;
  }
}

using ParameterFunction = const Parameter& (*)();

struct PeerRow {
  const char* name;
  const char* help;
  const char* reference;
  std::array<ParameterFunction, 2> own;  // besides rows and time, which all have; nullptr: none
  ContactSet law;
  Library library;
  PeerFunction solve;
};

constexpr PeerRow kPeers[] = {
    {"bullet-dantzig",
     "Dantzig's method of Bullet, dense",
     "Baraff 1994",
     {},
     ContactSet::box,
     kBullet,
     if_there<kBullet.is_there, solve_bullet_dantzig>()},
    {"bullet-lemke",
     "Lemke's method of Bullet, dense; infinite bounds are 1e5",
     "Lloyd 2005",
     {peer_iterations},
     ContactSet::box,
     kBullet,
     if_there<kBullet.is_there, solve_bullet_lemke>()},
    {"bullet-pgs",
     "projected Gauss-Seidel of Bullet on the nonzeros of J M^-1 J^T + C",
     "Catto 2005",
     {sweeps},
     ContactSet::box,
     kBullet,
     if_there<kBullet.is_there, solve_bullet_pgs>()},
    {"dart-dantzig",
     "Dantzig's method of DART, dense",
     "Baraff 1994",
     {},
     ContactSet::box,
     kDart,
     if_there<kDart.is_there, solve_dart_dantzig>()},
    {"dart-pgs",
     "projected Gauss-Seidel of DART, dense",
     "Catto 2005",
     {sweeps},
     ContactSet::box,
     kDart,
     if_there<kDart.is_there, solve_dart_pgs>()},
    {"ipopt",
     "interior point of Ipopt on MUMPS, sparse, velocities and impulses",
     "Waechter and Biegler 2006",
     {peer_tolerance, peer_iterations},
     ContactSet::box,
     kIpopt,
     if_there<kIpopt.is_there, solve_ipopt>()},
    {"siconos-nsgs",
     "nonsmooth Gauss-Seidel of Siconos, contacts of Coulomb's law, joints without bounds",
     "Acary, Bremond and Huber 2018",
     {peer_tolerance, peer_iterations},
     ContactSet::coulomb,
     kSiconos,
     if_there<kSiconos.is_there, solve_siconos_nsgs>()},
    {"siconos-newton",
     "semi-smooth Newton of Siconos, contacts of Coulomb's law, joints without bounds",
     "Alart and Curnier 1991",
     {peer_tolerance, peer_iterations},
     ContactSet::coulomb,
     kSiconos,
     if_there<kSiconos.is_there, solve_siconos_newton>()},
};

template <std::size_t I>
std::unique_ptr<StepSolver> make_peer(const SolveOptions& options, const Settings& settings) {
  return std::make_unique<PeerSolver>(kPeers[I].name, kPeers[I].solve, kPeers[I].law, options, settings);
}

template <std::size_t I>
SolverRow row_of() {
  const PeerRow& peer = kPeers[I];
  std::vector<Parameter> parameters = {peer_max_rows(), peer_timeout()};
  for (const ParameterFunction parameter : peer.own)
    if (parameter != nullptr) parameters.push_back(parameter());
  SolverRow row{{peer.name, peer.help, peer.reference, parameters}, make_peer<I>};
  if (peer.library.is_there) return row;
  row.make = nullptr;
  row.unavailable = std::string("install ") + peer.library.package + " and build again";
  return row;
}

template <std::size_t... I>
std::vector<SolverRow> make_rows(std::index_sequence<I...>) {
  return {row_of<I>()...};
}

}  // namespace

const std::vector<SolverRow>& peer_table() {
  static const std::vector<SolverRow> table = make_rows(std::make_index_sequence<std::size(kPeers)>());
  return table;
}

}  // namespace cleave

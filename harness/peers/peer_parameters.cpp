#include "harness/peers/peer.h"

namespace cleave::parameters {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

const Parameter& peer_max_rows() {
  static const Parameter parameter{
      .name = "peer-max-rows",
      .kind = Parameter::Kind::integer,
      .default_value = "3000",
      .range = {1, 20000},
      .help = "problems of more rows are refused; most peers take a dense matrix"};
  return parameter;
}

const Parameter& peer_timeout() {
  static const Parameter parameter{.name = "peer-timeout-s",
                                   .kind = Parameter::Kind::number,
                                   .default_value = "60",
                                   .range = {0.01, kInfinity},
                                   .unit = "s",
                                   .help = "a solve that takes longer is ended: status timeout"};
  return parameter;
}

const Parameter& peer_tolerance() {
  static const Parameter parameter{
      .name = "peer-tolerance",
      .kind = Parameter::Kind::number,
      .default_value = "1e-10",
      .range = {1e-16, 1},
      .help = "where ipopt (its scaled error) and siconos (its error relative to |q|) may stop"};
  return parameter;
}

const Parameter& peer_iterations() {
  static const Parameter parameter{.name = "peer-iterations",
                                   .kind = Parameter::Kind::integer,
                                   .default_value = "10000",
                                   .range = {1, kInfinity},
                                   .help = "most iterations of peers that would go on until they are done"};
  return parameter;
}

}  // namespace cleave::parameters

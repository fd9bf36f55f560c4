#include "harness/experiment/parameter_columns.h"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace cleave {
namespace {

using Place = ParameterColumn::Place;

struct PlacedName {
  Place place;
  std::string_view name;
};

// In the order in which they stand.
constexpr PlacedName kPlaced[] = {
    {Place::after_status, "max_bodies"},
    {Place::after_status, "tau_mr"},
    {Place::after_status, "tau_mix"},
    {Place::after_status, "max_growth"},
    {Place::after_contact_cap, "degree"},
    {Place::after_contact_cap, "degree_scope"},
    {Place::after_contact_cap, "as_printed"},
    {Place::after_contact_cap, "edge_weight"},
    {Place::after_contact_cap, "sweeps"},
    {Place::after_contact_cap, "ode_step_max_rows"},
    {Place::after_contact_cap, "ode_friction"},
    {Place::after_contact_cap, "quickstep_iterations"},
    {Place::after_contact_cap, "max_iterations"},
    {Place::after_contact_cap, "predictor_sweeps"},
    {Place::after_contact_cap, "reuse_analysis"},
    {Place::after_contact_cap, "arity"},
    {Place::after_contact_cap, "friction_force_n"},
    {Place::after_contact_cap, "mu"},
    {Place::after_factor_mflop_done, "partition_seed"},
    {Place::after_factor_mflop_done, "trials"},
    {Place::after_factor_mflop_done, "karger_method"},
    {Place::after_factor_mflop_done, "ufactor"},
    {Place::after_factor_mflop_done, "scotch_strategy"},
    {Place::after_factor_mflop_done, "effort"},
    {Place::after_factor_mflop_done, "patience"},
    {Place::after_factor_mflop_done, "merge_small"},
    {Place::after_factor_mflop_done, "split"},
    {Place::after_factor_mflop_done, "calibration"},
    {Place::after_factor_mflop_done, "cost_kernel"},
    {Place::after_factor_mflop_done, "cost_threads"},
    {Place::after_factor_mflop_done, "lemke_max_rows"},
    {Place::after_friction_beyond_share, "restart"},
    {Place::after_body_order, "until"},
    {Place::after_body_order, "order"},
    {Place::after_body_order, "order_seed"},
    {Place::after_body_order, "coloring"},
    {Place::after_body_order, "coloring_seed"},
    {Place::at_end, "seeds"},
    {Place::at_end, "bound_sweeps"},
};

std::ptrdiff_t rank_of(const std::string& name) {
  return std::ranges::find(kPlaced, name, &PlacedName::name) - std::begin(kPlaced);
}

}  // namespace

std::vector<ParameterColumn> columns_of(std::span<const CommonParameter> parameters) {
  std::vector<ParameterColumn> columns;
  for (const auto& [parameter, owners, about, in_replay] : parameters) {
    const std::string name = column_of(parameter.name);
    const std::ptrdiff_t rank = rank_of(name);
    const Place place = rank < std::ssize(kPlaced) ? kPlaced[rank].place : Place::at_end;
    columns.push_back({name, parameter.help + "; - where nothing has it", about, place});
  }
  std::ranges::stable_sort(columns, {}, [](const ParameterColumn& column) { return rank_of(column.name); });
  return columns;
}

std::span<const ParameterColumn> parameter_columns() {
  static const std::vector<ParameterColumn> columns = columns_of(common_parameters());
  return columns;
}

}  // namespace cleave

// Every constant of InteriorConstants once, with the values that an ablation tries in its place.
#pragma once

#include <limits>
#include <vector>

#include "solver/strategies/interior_constants.h"

namespace cleave {

struct Alternatives {
  double off;  // the value that takes the constant's effect away; kNeverOff where there is none
  std::vector<double> others;
};

inline constexpr double kNeverOff = std::numeric_limits<double>::quiet_NaN();

// Calls visit(name, member, alternatives) for every constant in the order of the struct. Constants:
// InteriorConstants or const InteriorConstants. A member is a double or an int.
template <class Constants, class Visit>
void visit_constants(Constants& c, Visit&& visit) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto each = [&](const char* name, auto& member, const Alternatives& tried) {
    visit(name, member, tried);
  };
  each("fixed_width_m_per_s", c.fixed_width_m_per_s, {0, {1e-15, 1e-11}});
  each("fixed_roundings", c.fixed_roundings, {0, {16, 256}});
  each("warm_share", c.warm_share, {0, {0.01, 0.5, kInfinity}});
  each("start_energy", c.start_energy, {0, {1, 15, 60}});
  each("least_speed_m_per_s", c.least_speed_m_per_s, {kNeverOff, {1e-6, 1e-4, 1e-2}});
  each("most_speed", c.most_speed, {kInfinity, {10, 1000}});
  each("inside_share", c.inside_share, {kNeverOff, {0.125, 0.5}});

  each("step_fraction", c.step_fraction, {kNeverOff, {0.95, 0.99, 0.9975}});
  each("target_power", c.target_power, {kNeverOff, {1, 2, 4}});
  each("short_step", c.short_step, {0, {0.05, 0.2}});
  each("centring", c.centring, {kNeverOff, {0.15, 0.6}});
  each("corrections", c.corrections, {0, {1, 4}});
  each("long_step", c.long_step, {1, {0.5, 0.9}});
  each("reach", c.reach, {kNeverOff, {0.15, 0.6}});
  each("band", c.band, {0, {0.05, 0.2}});
  each("least_gain", c.least_gain, {0, {0.05, 0.2}});

  each("first_delta", c.first_delta, {kNeverOff, {1e-14, 1e-12, 1e-10}});
  each("least_delta", c.least_delta, {kFactoredCompliance, {1e-15, 1e-13}});
  each("most_delta", c.most_delta, {kFactoredCompliance, {1e-10, 1e-8}});
  each("much_rounding", c.much_rounding, {kInfinity, {0.05, 0.2}});
  each("little_rounding", c.little_rounding, {0, {1e-4, 1e-2}});
  each("delta_rise", c.delta_rise, {1, {3, 30}});
  each("delta_fall", c.delta_fall, {1, {0.03, 0.3}});
  each("raises", c.raises, {0, {1, 6}});
  each("raise_factor", c.raise_factor, {1, {3, 30}});
  each("settled", c.settled, {kInfinity, {1e-4, 1e-2}});
  each("full_step", c.full_step, {0, {0.5, 0.99}});
  each("growth", c.growth, {1, {1.5, 4}});
  each("patience", c.patience, {kNeverOff, {1, 4}});

  each("soft_compliance", c.soft_compliance, {kInfinity, {1e-5, 1e-3}});
  each("soft_polish", c.soft_polish, {0, {1e-6, 1e-4, 1e-3}});
  each("firm_compliance", c.firm_compliance, {kInfinity, {1e-10, 1e-8}});
  each("firm_polish", c.firm_polish, {0, {1e-7, 1e-5}});
  each("stiff_compliance", c.stiff_compliance, {kInfinity, {1e-12, 1e-10}});
  each("stiff_polish", c.stiff_polish, {0, {1e-9, 1e-7}});
  each("rigid_polish", c.rigid_polish, {0, {1e-11, 1e-9}});
  each("next_polish", c.next_polish, {1, {1e-3, 1e-1}});
  each("polish_accuracy", c.polish_accuracy, {kNeverOff, {0.01, 1}});
  each("polish_rounds", c.polish_rounds, {1, {2, 8}});
  each("polish_refinements", c.polish_refinements, {1, {4, 16}});
  each("polish_violations", c.polish_violations, {0, {1, 6}});
  each("polish_violated_share", c.polish_violated_share, {0, {0.0025, 0.01, 0.05}});
}

}  // namespace cleave

#include "io/key_synonyms.hpp"

#include <algorithm>
#include <vector>

namespace zwidth::internal {
namespace {

using enum DeviceTable;

struct Synonyms {
  std::vector<DeviceTable> tables;  ///< where they are taken for the key
  std::vector<std::string_view> names;
  std::string_view remedy;
};

const std::vector<Synonyms>& all_synonyms() {
  static const std::vector<Synonyms> all = {
      {{root, loop},
       {"sampling_frequency", "sample_frequency", "sampling_rate", "sample_rate", "rate", "frequency", "fs", "f_s"},
       "write sampling_period of [loop], which is 1/frequency: 2 kHz is \"500 us\" or 0.5e-3 (s)"},
      {{root, loop},
       {"sample_time", "sampling_time", "sample_period", "period", "step_time", "time_step", "Ts", "T_s", "T", "ts",
        "dt", "cycle_time"},
       "did you mean \"sampling_period\" of [loop]? A number of s, or a text with its unit such as \"500 us\""},
      {{root, loop}, {"latency", "dead_time", "deadtime", "lag", "time_delay"}, "did you mean \"delay\" of [loop]?"},
      {{body, user},
       {"m", "M", "J", "I", "weight", "moment_of_inertia"},
       "did you mean \"mass\", or of rotary motion \"inertia\"?"},
      {{body},
       {"friction", "coulomb_friction", "dry_friction", "static_friction", "stiction", "fc", "f_c"},
       "write damping for viscous friction (N s/m), coulomb for dry friction (N)"},
      {{body, link, user, wall},
       {"viscosity", "viscous", "viscous_friction", "viscous_damping", "damping_coefficient", "damper", "b", "B", "c",
        "d"},
       "did you mean \"damping\"? N s/m, or of rotary motion N m s/rad"},
      {{body, link, user, wall},
       {"k", "K", "spring", "spring_constant", "spring_rate", "elasticity"},
       "did you mean \"stiffness\"? N/m, or of rotary motion N m/rad"},
      {{link},
       {"damping_ratio", "zeta", "loss_factor", "quality_factor"},
       "write damping in N s/m (N m s/rad): 2 damping_ratio sqrt(stiffness m), m = m1 m2/(m1 + m2) of its two bodies"},
      {{link}, {"compliance", "flexibility"}, "write stiffness, which is 1/compliance"},
      {{link}, {"bodies", "body", "connects", "from", "to"}, "write between = [\"BODY\", \"BODY\"]"},
      {{body, user},
       {"damping_ratio", "zeta"},
       "write damping in N s/m (N m s/rad): 2 damping_ratio sqrt(stiffness mass)"},
      {{sensor},
       {"counts_per_turn", "counts_per_rev", "counts_per_revolution", "counts", "cpr", "ppr", "lines", "pulses"},
       "write resolution, one count: resolution = \"1 turn/4096\" (of N lines with quadrature: 4 N counts)"},
      {{sensor}, {"step", "quantum", "quantization", "lsb"}, "did you mean \"resolution\"?"},
      {{actuator},
       {"bandwidth", "bandwidth_hz", "cutoff", "cutoff_hz", "frequency_hz"},
       "write time_constant in s, which is 1/(2 pi frequency)"},
      {{actuator},
       {"limit", "saturation", "max_force", "max_torque", "torque_limit", "peak_torque", "stall_torque"},
       "did you mean \"force_limit\"?"},
      {{actuator}, {"tau", "lag"}, "did you mean \"time_constant\"?"},
      {{wall},
       {"velocity_filter", "filter_hz", "cutoff", "cutoff_hz", "cutoff_frequency", "tau", "filter_time_constant",
        "velocity_filter_cutoff", "velocity_filter_cutoff_hz", "velocity_filter_frequency"},
       "write velocity_filter_hz, or velocity_filter_tau for backward Euler's time constant in s"},
  };
  return all;
}

}  // namespace

std::optional<std::string> remedy_for_synonym(DeviceTable table, std::string_view key) {
  for (const Synonyms& synonyms : all_synonyms()) {
    if (std::ranges::count(synonyms.tables, table) > 0 && std::ranges::count(synonyms.names, key) > 0) {
      return std::string(synonyms.remedy);
    }
  }
  return std::nullopt;
}

}  // namespace zwidth::internal

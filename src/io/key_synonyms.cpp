#include "io/key_synonyms.hpp"

#include <algorithm>

namespace zwidth::internal {
namespace {

using enum DeviceTable;

struct Synonyms {
  std::vector<DeviceTable> tables;  ///< where they are taken for the key
  std::vector<std::string_view> names;
  std::vector<Subject> remedy;
};

const std::vector<Synonyms>& all_synonyms() {
  static const std::vector<Synonyms> all = {
      {{root, loop},
       {"sampling_frequency", "sample_frequency", "sampling_rate", "sample_rate", "rate", "frequency", "fs", "f_s"},
       {{"result", "sampling_period"},
        {"of", "[loop]"},
        {"in", "s"},
        {"formula", "1/frequency"},
        {"example", "\"500 us\" of 2 kHz"}}},
      {{root, loop},
       {"sample_time", "sampling_time", "sample_period", "period", "step_time", "time_step", "Ts", "T_s", "T", "ts",
        "dt", "cycle_time"},
       {{"same", "sampling_period"}, {"of", "[loop]"}, {"in", "s"}}},
      {{root, loop}, {"latency", "dead_time", "deadtime", "lag", "time_delay"}, {{"same", "delay"}, {"of", "[loop]"}}},
      {{body, user}, {"m", "M", "J", "I", "weight", "moment_of_inertia"}, {{"same", "mass"}, {"rotary", "inertia"}}},
      {{body},
       {"friction", "coulomb_friction", "dry_friction", "static_friction", "stiction", "fc", "f_c"},
       {{"kinds", "friction"}}},
      {{body, link, user, wall},
       {"viscosity", "viscous", "viscous_friction", "viscous_damping", "damping_coefficient", "damper", "b", "B", "c",
        "d"},
       {{"same", "damping"}, {"in", "N s/m"}, {"in_rotary", "N m s/rad"}}},
      {{body, link, user, wall},
       {"k", "K", "spring", "spring_constant", "spring_rate", "elasticity"},
       {{"same", "stiffness"}, {"in", "N/m"}, {"in_rotary", "N m/rad"}}},
      {{link},
       {"damping_ratio", "zeta", "loss_factor", "quality_factor"},
       {{"result", "damping"},
        {"in", "N s/m (N m s/rad)"},
        {"formula", "2 damping_ratio sqrt(stiffness m1 m2/(m1 + m2))"}}},
      {{link}, {"compliance", "flexibility"}, {{"result", "stiffness"}, {"formula", "1/compliance"}}},
      {{link}, {"bodies", "body", "connects", "from", "to"}, {{"kinds", "ends"}}},
      {{body, user},
       {"damping_ratio", "zeta"},
       {{"result", "damping"}, {"in", "N s/m (N m s/rad)"}, {"formula", "2 damping_ratio sqrt(stiffness mass)"}}},
      {{sensor},
       {"counts_per_turn", "counts_per_rev", "counts_per_revolution", "counts", "cpr", "ppr", "lines", "pulses"},
       {{"result", "resolution"}, {"formula", "1 turn/counts"}, {"example", "\"1 turn/4096\""}, {"per_line", "4"}}},
      {{sensor}, {"step", "quantum", "quantization", "lsb"}, {{"same", "resolution"}}},
      {{actuator},
       {"bandwidth", "bandwidth_hz", "cutoff", "cutoff_hz", "frequency_hz"},
       {{"result", "time_constant"}, {"in", "s"}, {"formula", "1/(2 pi frequency)"}}},
      {{actuator},
       {"limit", "saturation", "max_force", "max_torque", "torque_limit", "peak_torque", "stall_torque"},
       {{"same", "force_limit"}}},
      {{actuator}, {"tau", "lag"}, {{"same", "time_constant"}}},
      {{wall},
       {"velocity_filter", "filter_hz", "cutoff", "cutoff_hz", "cutoff_frequency", "tau", "filter_time_constant",
        "velocity_filter_cutoff", "velocity_filter_cutoff_hz", "velocity_filter_frequency"},
       {{"kinds", "velocity_filter"}}},
  };
  return all;
}

}  // namespace

std::vector<Subject> remedy_for_synonym(DeviceTable table, std::string_view key) {
  for (const Synonyms& synonyms : all_synonyms()) {
    if (std::ranges::count(synonyms.tables, table) > 0 && std::ranges::count(synonyms.names, key) > 0) {
      return synonyms.remedy;
    }
  }
  return {};
}

}  // namespace zwidth::internal

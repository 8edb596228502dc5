#pragma once

#include <functional>
#include <string_view>

#include "report/excitation_summary.hpp"
#include "results/json.hpp"

namespace zwidth::results {

/// The document of `excite --json`, schema zwidth.excitation/1 (docs/excitation.md).
[[nodiscard]] Json excitation_json(const report::CheckedExcitation& checked);

/// Hands the excitation to `sink` in pieces: a header time_s,force_N (of a rotary device torque_N_m) and one line per
/// sample, the force with nine digits.
void write_excitation_csv(const Excitation& excitation, double rate, Motion motion,
                          const std::function<void(std::string_view)>& sink);

}  // namespace zwidth::results

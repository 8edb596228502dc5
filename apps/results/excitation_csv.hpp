#pragma once

#include "report/output_file.hpp"
#include "zwidth/identification/excitation.hpp"

namespace zwidth::report {

/// Writes the excitation as text in pieces: a header time_s,force_N (of a rotary device torque_N_m) and one line per
/// sample, the force with nine digits.
void write_excitation_csv(const Excitation& excitation, double rate, Motion motion, const Sink& sink);

}  // namespace zwidth::report

#pragma once

#include <string>
#include <vector>

#include "zwidth/remark.hpp"

namespace zwidth {

/// What a column's name says that it holds, by its unit: "F [N]", "angle_deg". `other`: something else, or in a unit that is
/// not known.
enum class StatedQuantity { nothing, force, position, velocity, acceleration, other };

/// One measured signal.
struct Channel {
  std::string name;                                   ///< as the file has it
  std::vector<double> samples;                        ///< finite, in the unit that the user asked for (already scaled)
  std::string unit = {};                              ///< in its name; empty: none, or a scale was given that says more
  StatedQuantity quantity = StatedQuantity::nothing;  ///< of that unit: a force or torque, a length or angle, ...
  std::string base_unit = {};  ///< the samples' own, where that unit is known: "N", "N m", "m", "rad", "m/s", ...
};

/// Signals sampled together at one rate.
struct Recording {
  std::string source;             ///< file name
  double sampling_period = 0.0;   ///< s; > 0
  std::vector<Channel> channels;  ///< in the order asked for, all of one size
  std::vector<Remark> remarks;    ///< what was noticed while reading: gaps, NaN, a timer that wraps, jitter
  /// Why no number that is found from it can be relied on: a stated rate that the times contradict.
  std::vector<Finding> doubts = {};
};

/// What a signal is called in remarks, and its role, which decides what a defect means.
enum class SignalRole { force, position, velocity, acceleration };

/// Looks for what spoils an identification: a constant signal, clipping (runs at the extreme values), coarse
/// quantisation (few distinct steps), a dropout (a long constant run), too short a record. Empty when clean.
[[nodiscard]] std::vector<Remark> check_signal(const Channel& channel, double sampling_period, SignalRole role);

}  // namespace zwidth

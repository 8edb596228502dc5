#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/simulation/relay_trials.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::report {

/// How the relay experiments of Table II are simulated. The paper prints none of these numbers but the encoder's step,
/// the sampling period and the delays.
struct Table2Setting {
  double relay_force = 5.0;        ///< d, N: ours; the results depend on F_c/d, hardly on d
  double inherent_delay = 250e-6;  ///< s, added to every delay: the paper's own estimate
  double large_start = 30e-3;      ///< m, both bodies: from here it settles on the rigid-body branch wherever it exists
  double small_start = 0.1e-3;     ///< m: from here on the resonance branch
  double duration = 20.0;          ///< s per trial
  double variation = 0.05;         ///< of start and friction from trial to trial
};

/// One delay, four trials: frequency and the mean of the decibels, as in the printed table.
struct Table2Row {
  double delay = 0.0;  ///< s, as printed, without the inherent one
  double frequency_hz = 0.0;
  double margin_db = 0.0;
  double lowest_hz = 0.0;  ///< of a trial
  double highest_hz = 0.0;
};

/// Frequency and margin error over the rows of 2 ms and more.
struct Table2Error {
  double frequency = 0.0;  ///< rms, relative
  double margin_db = 0.0;  ///< rms
};

struct FrictionTrial {
  double level = 0.0;  ///< F_c / d
  Table2Error error;
};

struct Table2 {
  Table2Setting setting;
  std::array<Table2Row, 9> printed;
  /// F_c/d of the handle over the grid 0.06 .. 0.10 in steps of 0.0025, from the large start.
  std::vector<FrictionTrial> friction_scan;
  double friction_level = 0.0;          ///< the one of least frequency error; margins are not fitted
  Table2Error error;                    ///< there
  std::array<Table2Row, 9> from_large;  ///< at that level
  std::array<Table2Row, 9> from_small;
  std::array<Table2Row, 9> without_friction;  ///< from the large start
  std::array<Table2Row, 9> rigid;             ///< the same friction, no cable: one body, from the large start
  RelayTrial first_trial;                     ///< no delay but the inherent one, from the large start: for Fig. 11
};

/// The printed rows.
[[nodiscard]] std::array<Table2Row, 9> table_2_printed();

/// Set A with Coulomb friction on the handle, F_c = level d, at one of the printed delays.
[[nodiscard]] Device table_2_device(const Table2Setting& setting, double level, double delay);

/// Computed once, then kept: about 220 simulated minutes, a few seconds.
[[nodiscard]] const Table2& table_2();

}  // namespace zwidth::report

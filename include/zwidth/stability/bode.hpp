#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/bode_points.hpp"

namespace zwidth {

/// Where the responses are computed.
struct BodeOptions {
  std::optional<double> from = {};  ///< rad/s; absent: below everything that matters
  std::optional<double> to = {};    ///< rad/s; absent: Nyquist
  std::size_t points = 400;         ///< even on the logarithmic axis; more are added where a curve bends
  Progress progress = {};           ///< told how far the work is; ends it by throwing
};

/// Checks: frequencies finite and > 0, `to` above `from`, 2 to 100 000 points.
[[nodiscard]] std::optional<OptionProblem> find_problem(const BodeOptions& options);

/// The same, and `from` below the device's Nyquist frequency.
[[nodiscard]] std::optional<OptionProblem> find_problem(const BodeOptions& options, const Device& device);

/// The two frequency responses of a device at the same frequencies, and the crossovers to mark on them.
struct Bode {
  FrequencyRange range;               ///< that was covered
  std::vector<BodePoint> continuous;  ///< G, the virtual damper and the delay left out
  /// F P / (1 + B v F P), P = Z[H G e^{-t_d s}], behind the wall's filters F; to Nyquist. With a faster damper in
  /// a loop of its own the plant that the spring sees, that damper closed at its own rate: a remark of the analysis says so.
  std::vector<BodePoint> sampled;
  /// analysis.critical holds every crossover, inside the range or not; where it is refused, none.
  Analysis analysis;
  double nyquist = 0.0;  ///< pi/T, rad/s
};

/// The range of bode(): where the options leave it open, from a power of ten below every crossover, mode and
/// pi/(1000 T), up to Nyquist; a `to` at or below that begins a decade below itself. `analysis` is of this device.
[[nodiscard]] FrequencyRange bode_range(const Device& device, const Analysis& analysis,
                                        const BodeOptions& options = {});

/// The frequency responses of a device, fine enough for a curve through them, the phase unwrapped from below everything
/// that matters even where the range begins higher.
///
/// Where an analysis is at hand (of this device,
/// with any options) it is taken; else the critical stiffness, the modes and the wall's margins are computed.
/// Throws Error (invalid_argument) where find_problem(options, device) finds one and for a damper that runs slower than the
/// spring, (did_not_converge) as analyze() does.
[[nodiscard]] Bode bode(const Device& device, const BodeOptions& options = {});
/// The same, of an analysis that is at hand.
[[nodiscard]] Bode bode(const Device& device, Analysis analysis, const BodeOptions& options = {});

}  // namespace zwidth

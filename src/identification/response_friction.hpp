#pragma once

#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// Dry friction, N or N m.
struct FrictionEstimate {
  double force = 0.0;      ///< >= 0
  double deviation = 0.0;  ///< one standard deviation of it
};

/// A body behind an antiresonance of the response: a zero of it is where that body rings with the sensed one at rest.
/// Its motion is v R(w), and so is the share of a force on it that reaches the sensed body,
///
///     R = 1/(1 - (w/w_a)^2 + 2j zeta w/w_a)
struct HiddenBody {
  double frequency = 0.0;      ///< w_a, rad/s
  double damping_ratio = 0.0;  ///< zeta
  double compliance = 0.0;     ///< of what holds it to the sensed body, m/N

  [[nodiscard]] std::complex<double> passage(double at) const;
};
/// Of the deepest antiresonances that the lines show.
[[nodiscard]] std::vector<HiddenBody> hidden_bodies(const FrequencyResponse& response);

/// What a recorded motion shows of dry friction beside its measured response, without a model of the device.
struct RecordedSliding {
  using Lines = std::vector<std::complex<double>>;
  double line_spacing = 0.0;        ///< rad/s
  Lines gain;                       ///< kappa on the lines of the record, s/m: what the response makes of the sign
  std::vector<double> force_power;  ///< around each line
  std::optional<FrictionEstimate> friction = {};  ///< by its harmonics
  /// The body moves as the response says, so that there is no more friction than is estimated. One that rests for
  /// long does not.
  bool is_followed = false;

  [[nodiscard]] std::complex<double> gain_at(double at) const;
  [[nodiscard]] double force_power_at(double at) const;
};

/// Looks for friction of one body, by what its sign v does that no damping does.
///
///     S = kappa V + S',   1/G = 1/G_0 + F_c kappa jw/D,   Y - H_Y F = -F_c (G R/D) (S' - H_S F) + rest
///
/// S: lines of sign v, v: recorded velocity, times R of a hidden body; kappa: their regression, line by line over those
/// around it, or their quotient on the lines of a force that repeats; G: the measured response, which holds the
/// damping F_c kappa; D: the hold; H_Y, H_S: what is locally proportional to the force. A delay turns the coefficient
/// by up to some 60 degrees. No harmonics are looked for in a response of lines (`of_lines`), which holds them
/// already. Nothing where the record is too short, does not move, or the response has too few lines.
struct SlidingQuestion {
  OutputQuantity output = OutputQuantity::position;
  bool of_lines = false;                ///< averaged over periods, or fitted
  std::optional<HiddenBody> body = {};  ///< absent: the sensed one
};
[[nodiscard]] std::optional<RecordedSliding> recorded_sliding(const FrequencyResponse& response,
                                                              const Recording& recording,
                                                              const SlidingQuestion& question = {});

/// Friction of any body, by what it makes of two motions: between records r and s of one device, on the lines of both,
///
///     H_s - H_r = F_c jw (kappa_r - kappa_s) R^2 H_r H_s / D
[[nodiscard]] std::optional<FrictionEstimate> friction_between(std::span<const FrequencyResponse> responses,
                                                               std::span<const RecordedSliding> slidings,
                                                               const std::optional<HiddenBody>& body = {});

/// The response of the device without this much friction of a body, x = F_c kappa jw/D:
///
///     G_0 = G + x G^2 R^2/(1 - x (G R^2 + R/k))
[[nodiscard]] FrequencyResponse without_friction(const FrequencyResponse& response,
                                                 std::span<const RecordedSliding> slidings, double force,
                                                 const std::optional<HiddenBody>& body = {});

}  // namespace zwidth::internal

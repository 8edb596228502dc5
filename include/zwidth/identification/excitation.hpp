#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/remark.hpp"

namespace zwidth {

/// The signals that can be made.
enum class ExcitationKind { linear_chirp, logarithmic_chirp, multisine, noise, relay };

/// Which signal, how long, how strong.
struct ExcitationOptions {
  ExcitationKind kind = ExcitationKind::linear_chirp;  ///< of the signal
  double amplitude = 1.0;                              ///< peak force, N or N m
  double lowest_hz = 10.0;     ///< lower end of the band; of a relay, how often per second it runs through both signs
  double highest_hz = 200.0;   ///< upper end of the band; a relay has none
  double duration = 20.0;      ///< s
  std::optional<double> rate;  ///< Hz; absent: that of the device, default_excitation_rate without one
  double fade_in = 0.0;        ///< s, raised cosine at the start, and at the end too except for a multisine
  std::size_t periods = 10;    ///< multisine only: whole periods in the duration
  std::uint64_t seed = 1;      ///< noise only
  std::optional<double> stroke_limit = {};  ///< m or rad: how far the device may move from its start; absent: any way
};

inline constexpr double default_excitation_rate = 1000.0;  ///< Hz, without a device
inline constexpr double max_excitation_samples = 1e8;      ///< of one signal
/// Of noise, and of one period of a multisine: they are made by one transform.
inline constexpr double max_transformed_samples = 1e7;

/// Checks all that excite() requires; with a device, at its rate where the options have none.
[[nodiscard]] std::optional<OptionProblem> find_problem(const ExcitationOptions& options);
/// The first member outside its domain, of the device too.
[[nodiscard]] std::optional<OptionProblem> find_problem(const ExcitationOptions& options, const Device& device);

/// Largest sample, root mean square, and their quotient.
struct CrestFactor {
  double peak = 0.0;    ///< largest magnitude, N or N m
  double rms = 0.0;     ///< N or N m
  double factor = 0.0;  ///< peak / rms; 0 for no signal
};
/// Largest magnitude over the root mean square.
[[nodiscard]] CrestFactor crest_factor(std::span<const double> signal);

/// What the excitation does to a device without feedback.
struct ExcitationCheck {
  std::string device;            ///< its name
  double peak_force = 0.0;       ///< N or N m
  double peak_stroke = 0.0;      ///< m or rad: largest excursion of the sensed body from its start; may be infinite
  std::vector<Remark> exceeded;  ///< limits that it goes beyond: the actuator's force limit, the stroke limit
  std::vector<Remark> remarks;   ///< doubts: friction left out, motion of few encoder steps
};

/// A signal for the actuator, sample by sample.
struct Excitation {
  ExcitationOptions options;             ///< as given
  double rate = 0.0;                     ///< Hz, the one taken
  std::vector<double> samples;           ///< force at k / rate
  std::size_t period = 0;                ///< samples; 0: not periodic
  CrestFactor crest;                     ///< of the samples
  std::vector<Remark> remarks;           ///< rounding of duration or frequency, band narrower than asked for
  Motion motion = Motion::linear;        ///< of the device; linear without one
  std::optional<ExcitationCheck> check;  ///< absent without a device
};

/// Makes an excitation signal.
///
/// Over the duration D, in turns (cycles) p(t) of sin(2 pi p):
///
///     linear chirp        p = f1 t + (f2 - f1) t^2 / (2 D)
///     logarithmic chirp   p = f1 D (r^(t/D) - 1) / ln r,  r = f2 / f1
///     multisine           sum over the n lines k/period in the band of cos(2 pi k t/period - i (i - 1) pi / n),
///                         i = 1..n
///     noise               Gaussian, of constant power density in the band and none outside (sharp, over its whole
///                         length)
///     relay               +, - in turn, each for a whole number of samples
///
/// Chirp and relay have the amplitude as their own; multisine and noise are scaled so that their largest sample is it.
/// The same options give the same noise everywhere. Requires finite amplitude, duration and rate > 0; 0 < lowest <=
/// highest <= rate/2 (a relay: lowest only; a multisine and noise: at least one line of 1/period or 1/duration in the
/// band, at most max_transformed_samples); 2 .. max_excitation_samples samples; fade_in >= 0, and start and end fade
/// without overlap; at least one period, of at least two samples; stroke_limit > 0. Throws Error (invalid_argument)
/// otherwise, as find_problem(options) says.
/// Source: Schroeder 1970; Díaz & Gil, section II (10-200 Hz swept sine).
[[nodiscard]] Excitation excite(const ExcitationOptions& options);

/// The same, at the device's rate where the options have none, and checked against the device: the excitation, held
/// over each period of its rate, is played through the exact sampled device from rest, in linear time.
///
/// Linear: Coulomb friction and the force limit do not act.
[[nodiscard]] Excitation excite(const ExcitationOptions& options, const Device& device);

}  // namespace zwidth

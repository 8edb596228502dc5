#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "property/random_recordings.hpp"
#include "zwidth/io/recorded_columns.hpp"

namespace zwidth::test {

/// How a recorder writes what it sampled.
enum class Damage { lost_at_random, lost_regularly, rows_jitter, stamps_jitter, lost_and_jitter, two_rates };

/// A simulated experiment as it was, and as a recorder wrote it.
struct DamagedRecording {
  std::vector<Recording> whole;           ///< rows all there, at equal steps
  std::vector<RecordedColumns> recorded;  ///< t, force, position
  DeviceParameters truth;
  DeviceParameters structure;  ///< placeholders
  double stiffness = 0.0;      ///< K_CR of the truth
  Damage damage = Damage::lost_at_random;
  std::string what;
};

namespace detail {

constexpr int parts = 100;  // per sampling period, into which rows jitter

/// The position at the rows of a force that is held from row to row; rows in parts of the period.
inline std::vector<double> position_at(const DeviceParameters& truth, const std::vector<double>& force,
                                       const std::vector<long>& rows) {
  const double part = truth.loop.sampling_period / parts;
  const auto late = static_cast<long>(std::lround(truth.loop.delay / part));
  const auto count = static_cast<std::size_t>(rows.back() + 1);
  std::vector<double> acting(count, 0.0);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const long end = k + 1 < rows.size() ? rows[k + 1] : rows.back();
    for (long i = rows[k]; i < end; ++i) {
      if (i + late < static_cast<long>(count)) acting[static_cast<std::size_t>(i + late)] = force[k];
    }
  }
  const std::vector<double> fine = forced_response(sample(state_space(Device(truth)), {part, 0.0}), acting);
  std::vector<double> position;
  for (const long row : rows) position.push_back(fine[static_cast<std::size_t>(row)]);
  return position;
}

}  // namespace detail

/// One or two bodies under a chirp or a multisine of 10 s at 1 kHz, read by an encoder; nothing where no wall is stable.
inline std::optional<DamagedRecording> damaged_recording(std::uint64_t seed) {
  detail::Draw draw(seed);
  DamagedRecording made;
  const std::size_t bodies = 1 + draw.below(2);
  DeviceParameters truth = detail::random_chain(draw, bodies);
  constexpr double period = 1e-3;
  truth.loop.sampling_period = period;
  truth.loop.delay = draw.chance(0.5) ? 0.01 * period * static_cast<double>(draw.below(200)) : 0.0;
  truth.actuator.time_constant = 0.0;
  const CriticalStiffness critical = critical_stiffness(Device(truth));
  if (!critical.limit || !(critical.stiffness > 0.0)) return std::nullopt;
  made.truth = truth;
  made.stiffness = critical.stiffness;
  const double limiting_hz = critical.limit->frequency / (2.0 * std::numbers::pi);
  made.damage = static_cast<Damage>(draw.below(6));
  made.structure.name = "structure";
  for (std::size_t i = 0; i < bodies; ++i) {
    made.structure.bodies.push_back({"body" + std::to_string(i), 1.0, 1.0, 0.0, 0.0});
    if (i > 0) made.structure.links.push_back({i - 1, i, 1.0, 1.0});
  }
  made.structure.loop = {0, 0, bodies - 1, period, 0.0};

  ExcitationOptions excitation;
  const bool is_multisine = draw.chance(0.5);
  excitation.kind = is_multisine       ? ExcitationKind::multisine
                    : draw.chance(0.5) ? ExcitationKind::linear_chirp
                                       : ExcitationKind::logarithmic_chirp;
  excitation.amplitude = draw.logarithmic(1.0, 20.0);
  excitation.duration = 10.0;
  excitation.lowest_hz = is_multisine ? 1.0 : draw.logarithmic(0.5, 2.0);
  excitation.highest_hz = std::min(250.0, std::max(10.0, limiting_hz) * draw.logarithmic(1.5, 6.0));
  excitation.periods = 5;
  excitation.seed = seed;
  const double disturbance = draw.logarithmic(0.0005, 0.005);
  const double steps = draw.logarithmic(0.005, 0.2);
  const double share = draw.logarithmic(0.01, 0.2);
  const double jitter = draw.uniform(0.05, 0.3);
  const bool is_factor = draw.chance(0.5);
  const std::uint64_t noise_seed = draw.below(1U << 30U);

  /// The experiment with rows off their steps by these parts of a period.
  const auto experiment = [&](double rate, std::uint64_t noise, const std::vector<long>& off) {
    DeviceParameters device = truth;
    device.loop.sampling_period = 1.0 / rate;
    detail::Draw own(noise);
    ExcitationOptions at_rate = excitation;
    at_rate.rate = rate;
    if (made.damage == Damage::two_rates) at_rate.duration = 5.0;
    if (is_multisine) at_rate.duration = std::round(at_rate.duration * rate / 5.0) * 5.0 / rate;
    at_rate.highest_hz = std::min(at_rate.highest_hz, 0.45 * rate);
    Recording recording{"seed " + std::to_string(seed), 1.0 / rate, {}, {}};
    const std::vector<double> force = excite(at_rate).samples;
    std::vector<double> real = force;
    const double rms = crest_factor(force).rms;
    for (double& each : real) each += disturbance * rms * own.normal();
    std::vector<long> rows;
    for (std::size_t k = 0; k < force.size(); ++k) {
      rows.push_back(static_cast<long>(k) * detail::parts + (k < off.size() ? off[k] : 0));
    }
    std::vector<double> position = detail::position_at(device, real, rows);
    double moved = 0.0;
    for (std::size_t k = 1; k < position.size(); ++k) moved += std::pow(position[k] - position[k - 1], 2);
    const double step = steps * std::sqrt(moved / static_cast<double>(position.size()));
    for (double& each : position) each = step * std::round(each / step + 0.3);
    recording.channels = {{"force", force}, {"position", position}};
    return recording;
  };
  const auto columns_of = [](const Recording& recording, const std::vector<double>& times,
                             const std::vector<bool>& is_lost) {
    RecordedColumns columns{recording.source, {{"t", {}}, {"force", {}}, {"position", {}}}, std::nullopt};
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (k < is_lost.size() && is_lost[k]) continue;
      columns.columns[0].samples.push_back(times[k]);
      for (std::size_t c = 0; c < 2; ++c) columns.columns[c + 1].samples.push_back(recording.channels[c].samples[k]);
    }
    return columns;
  };
  const auto even = [](const Recording& recording) {
    std::vector<double> times;
    for (std::size_t k = 0; k < recording.channels[0].samples.size(); ++k)
      times.push_back(static_cast<double>(k) * recording.sampling_period);
    return times;
  };

  static const std::array names{"lost at random", "lost regularly",  "rows jitter",
                                "stamps jitter",  "lost and jitter", "two rates"};
  made.what = std::to_string(bodies) + " bodies, " + (is_multisine ? "multisine" : "chirp") + ", " +
              names[static_cast<std::size_t>(made.damage)];
  if (made.damage == Damage::two_rates) {
    const double other = is_factor ? 500.0 : 1000.0 * (1.0 + 1e-5);
    const Recording first = experiment(1000.0, noise_seed, {});
    const Recording same = experiment(1000.0, noise_seed + 1, {});
    const Recording second = experiment(other, noise_seed + 1, {});
    made.whole = {first, same};
    made.recorded = {columns_of(first, even(first), {}), columns_of(second, even(second), {})};
    made.what += is_factor ? " by 2" : " by 10 ppm";
    return made;
  }
  const auto rows = static_cast<std::size_t>(std::lround(excitation.duration / period));
  std::vector<long> off(rows, 0);
  std::vector<double> stamps(rows, 0.0);
  std::vector<bool> is_lost(rows, false);
  const bool jitters = made.damage == Damage::rows_jitter || made.damage == Damage::lost_and_jitter;
  for (std::size_t k = 0; k < rows; ++k) {
    if (jitters && k > 0 && k + 1 < rows)
      off[k] = std::lround(draw.uniform(-jitter, jitter) * static_cast<double>(detail::parts));
    stamps[k] = made.damage == Damage::stamps_jitter ? draw.uniform(-jitter, jitter) * period : 0.0;
    stamps[k] += period * (static_cast<double>(k) + static_cast<double>(off[k]) / detail::parts);
  }
  if (made.damage == Damage::lost_at_random || made.damage == Damage::lost_and_jitter) {
    for (std::size_t k = 1; k < rows; ++k) is_lost[k] = draw.chance(share);
    made.what += " " + std::to_string(100.0 * share) + " %";
  } else if (made.damage == Damage::lost_regularly) {
    const auto every = static_cast<std::size_t>(std::lround(1.0 / share));
    for (std::size_t k = every - 1; k < rows; k += every) is_lost[k] = true;
    made.what += " every " + std::to_string(every);
  }
  if (jitters || made.damage == Damage::stamps_jitter) made.what += " jitter " + std::to_string(100.0 * jitter) + " %";
  made.whole = {experiment(1000.0, noise_seed, {})};
  made.recorded = {columns_of(experiment(1000.0, noise_seed, off), stamps, is_lost)};
  return made;
}

/// As a file with these columns is read.
inline std::vector<Recording> read_back(const DamagedRecording& made) {
  RecordingOptions options;
  options.columns = {{"force", {}}, {"position", {}}};
  std::vector<Recording> recordings;
  for (const RecordedColumns& each : made.recorded) {
    auto recording = read_recording(each, options);
    if (recording) recordings.push_back(*std::move(recording));
  }
  return recordings;
}

}  // namespace zwidth::test

#include "simulation/relay_explanation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

constexpr double agrees_db = 0.5;
/// A relay's square wave on a lightly damped rigid device slows its oscillation by 9 % against the crossover, the
/// sampling by a little more.
constexpr double near = 1.15;
constexpr double same_branch = 1.5;  // ratio of frequencies beyond which a first-harmonic cycle is another one

bool is_near(double frequency, double other) { return frequency <= near * other && other <= near * frequency; }

bool is_same_branch(double frequency, double other) {
  return frequency <= same_branch * other && other <= same_branch * frequency;
}

std::string at(double frequency, double stiffness) {
  return fmt::format("{} Hz, {:.2f} dB", number(hertz(frequency)), decibels(stiffness));
}

std::string mechanism(const Mechanism& limited_by) {
  return limited_by.kind == Mechanism::Kind::rigid_body ? "the rigid body"
                                                        : fmt::format("vibration mode {}", limited_by.mode);
}

/// The element whose frequency is nearest, by ratio; null where there is none.
template <typename Cycle>
const Cycle* nearest(const std::vector<Cycle>& cycles, double frequency) {
  const Cycle* found = nullptr;
  for (const Cycle& each : cycles) {
    if (each.frequency <= 0.0) continue;
    const auto distance = [&](const Cycle& cycle) { return std::abs(std::log(cycle.frequency / frequency)); };
    if (!found || distance(each) < distance(*found)) found = &each;
  }
  return found;
}

std::string crossover_sentence(const RelayMean& mean, const CriticalStiffness& linear) {
  const Crossover* crossover = nearest(linear.crossovers, mean.frequency);
  if (!crossover) return "Linear theory knows no phase crossover of this device.";
  const std::string place =
      fmt::format("{} ({})", at(crossover->frequency, crossover->stiffness), mechanism(crossover->limited_by));
  if (is_near(mean.frequency, crossover->frequency)) {
    const double difference = decibels(mean.stiffness / crossover->stiffness);
    return fmt::format("It oscillates near the phase crossover of linear theory at {}: the relay reads {:.2f} dB {}.",
                       place, std::abs(difference), difference < 0.0 ? "less" : "more");
  }
  return fmt::format(
      "It oscillates at no phase crossover of linear theory, the nearest being at {}: what the relay reads is the "
      "device's response there, not a limit of stability.",
      place);
}

std::string limit_sentence(const RelayResult& result) {
  const CriticalStiffness& linear = result.prediction->linear;
  const std::string limit = linear.limit ? fmt::format("The stiffest stable wall by linear theory is at {}.",
                                                       at(linear.limit->frequency, linear.stiffness))
                                         : "";
  const double difference = std::abs(decibels(result.mean->stiffness / linear.stiffness));
  switch (result.limit_reading) {
    case LimitReading::none:
      break;
    case LimitReading::confirms:
      return limit + " The relay confirms it.";
    case LimitReading::coincides:
      return limit + " The relay reads the same stiffness, but at another frequency: a coincidence.";
    case LimitReading::unsafe:
      return limit + fmt::format(" The relay reads {:.2f} dB more: taken for that limit it is UNSAFE.", difference);
    case LimitReading::too_cautious:
      return limit +
             fmt::format(" The relay reads {:.2f} dB less: taken for that limit it is too cautious.", difference);
  }
  return "Linear theory gives this device no finite limit to compare with.";
}

std::string friction_sentence(const RelayResult& result, const RelayMean& mean) {
  const double level = result.friction_level.value_or(0.0);
  if (level == 0.0) return "";
  const std::string start = fmt::format(
      "Coulomb friction of up to {:.1f} % of the relay's force acts as a damping that "
      "grows as the motion slows.",
      100.0 * level);
  const LimitCycle* cycle = nearest(result.prediction->describing_function, mean.frequency);
  if (!cycle || !is_same_branch(mean.frequency, cycle->frequency)) {
    return start +
           " By first harmonics alone no oscillation would be left near this one: the harmonics of the square "
           "wave, near a resonance, keep it up.";
  }
  const Crossover* crossover = nearest(result.prediction->linear.crossovers, mean.frequency);
  const bool is_moved = crossover && !is_near(cycle->frequency, crossover->frequency);
  return start +
         fmt::format(
             " By first harmonics it {} {}.{}",
             is_moved ? "moves the oscillation away from the crossover, to" : "leaves the oscillation at",
             at(cycle->frequency, cycle->stiffness),
             is_near(mean.frequency, cycle->frequency) ? "" : " The rest of the way is that of the higher harmonics.");
}

std::string bands_text(const std::vector<CycleBand>& bands) {
  static constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t i = 0; i < bands.size() && i < most; ++i) {
    const CycleBand& band = bands[i];
    text += i == 0 ? "" : ", ";
    text += band.count == 1
                ? number(hertz(band.lowest.frequency))
                : fmt::format("{} to {}", number(hertz(band.lowest.frequency)), number(hertz(band.highest.frequency)));
  }
  return text + (bands.size() > most ? ", ..." : "");
}

/// How closely frequencies are known, rad/s.
double resolution_of(const RelayResult& result) {
  double spacing = 0.0;
  for (const RelayTrial& trial : result.trials) {
    if (trial.result) spacing = std::max(spacing, trial.result->line_spacing);
  }
  return spacing;
}

std::string sampled_sentence(const RelayResult& result, const RelayMean& mean) {
  const std::vector<LimitCycle>& cycles = result.prediction->sampled_relay;
  if (cycles.empty()) {
    return fmt::format(
        "Without friction and encoder the sampled relay has no simple oscillation (one switch each way per period) "
        "above {} Hz; below it was not searched.",
        number(hertz(result.prediction->lowest_frequency)));
  }
  const LimitCycle* cycle = nearest(cycles, mean.frequency);
  return fmt::format(
      "Without friction and encoder the sampled relay has {} exact oscillation{} ({} Hz), {}; the start decides "
      "between "
      "them.",
      cycles.size(), cycles.size() == 1 ? "" : "s", bands_text(cycle_bands(cycles)),
      std::abs(mean.frequency - cycle->frequency) <= resolution_of(result)
          ? std::string("this one among them")
          : std::string(result.friction_level.value_or(0.0) > 0.0
                            ? "none of them this one: friction makes the difference"
                            : "none of them this one: it switches more often than once each way per "
                              "period, or the encoder matters"));
}

}  // namespace

bool agree(const RelayMean& mean) { return is_near(mean.lowest_frequency, mean.highest_frequency); }

std::string oscillations_text(const RelayResult& result) {
  std::vector<const RelayReading*> readings;
  for (const RelayTrial& trial : result.trials) {
    if (trial.result) readings.push_back(&*trial.result);
  }
  std::ranges::sort(readings, {}, &RelayReading::frequency);
  const auto range = [](double lowest, double highest, const auto& text) {
    return text(lowest) == text(highest) ? text(lowest) : text(lowest) + " to " + text(highest);
  };
  const auto in_hertz = [](double frequency) { return number(hertz(frequency)); };
  const auto in_units = [&](double stiffness) { return quantity(stiffness, units_of(result.motion).stiffness); };
  std::string all;
  for (auto first = readings.begin(); first != readings.end();) {
    const auto end = std::find_if(first, readings.end(), [&](const RelayReading* each) {
      return !is_near((*first)->frequency, each->frequency);
    });
    const auto [softest, stiffest] =
        std::minmax_element(first, end, [](const auto* a, const auto* b) { return a->stiffness < b->stiffness; });
    const auto count = end - first;
    all += all.empty() ? "" : end == readings.end() ? " and " : ", ";
    all += fmt::format("{} Hz ({}, {} trial{})", range((*first)->frequency, (*(end - 1))->frequency, in_hertz),
                       range((*softest)->stiffness, (*stiffest)->stiffness, in_units), count, count == 1 ? "" : "s");
    first = end;
  }
  return all;
}

LimitReading limit_reading(const RelayMean& mean, const CriticalStiffness& linear) {
  if (!linear.limit || linear.limit->frequency <= 0.0) return LimitReading::none;
  const double difference = decibels(mean.stiffness / linear.stiffness);
  if (std::abs(difference) <= agrees_db) {
    return is_near(mean.frequency, linear.limit->frequency) ? LimitReading::confirms : LimitReading::coincides;
  }
  return difference > 0.0 ? LimitReading::unsafe : LimitReading::too_cautious;
}

std::vector<std::string> relay_explanation(const RelayResult& result) {
  if (!result.mean) {
    return {fmt::format(
        "The trials settle at different oscillations, {}: several exist side by side, and the start decides. "
        "Compare each with the predictions above.",
        oscillations_text(result))};
  }
  const RelayMean& mean = *result.mean;
  std::vector<std::string> sentences{crossover_sentence(mean, result.prediction->linear), limit_sentence(result)};
  if (std::string friction = friction_sentence(result, mean); !friction.empty()) sentences.push_back(friction);
  sentences.push_back(sampled_sentence(result, mean));
  return sentences;
}

}  // namespace zwidth::internal

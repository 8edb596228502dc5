#include "design/diagnosis/oscillation_causes.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

#include "design/diagnosis/loop_poles.hpp"
#include "design/sensitivities/loops_of_wall.hpp"
#include "design/sensitivities/number_limit.hpp"
#include "design/synthesis/users_at_frequency.hpp"
#include "infinity.hpp"
#include "model/known_structure.hpp"
#include "stability/loop/damper_response.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;

constexpr double near = 0.15;                   // |ln| of two frequencies of one linear oscillation
constexpr double near_harmonic = 0.4;           // of one that first harmonics tell
constexpr double counts_of_quantisation = 3.0;  // an amplitude that needs no resonance, in encoder steps
// Of a predicted amplitude. A body that hardly slips swings less than its first harmonic says.
constexpr double most_of_amplitude = 3.0;
constexpr double least_of_amplitude = 0.1;
constexpr double beside_user = 0.1;  // relative, frequencies around the one observed
constexpr double of_user_limit = 0.98;
constexpr double far = 2.0;          // factor of what would have to be otherwise, from which on it is another device
constexpr int users_looked_at = 80;  // frequencies up to that factor around the one observed
constexpr int shares = 80;
constexpr int bisections = 40;

double apart(double a, double b) { return std::abs(std::log(a / b)); }

Evidence frequency_of(double frequency, std::string_view name = "frequency_hz") {
  return {name, hertz(frequency), "Hz"};
}

/// The wall's C(z) = K + B v as a filter: what multiplies it scales the whole force.
WallFilter controller(const Wall& wall, double period) {
  const double a = velocity_filter_pole(wall.velocity_filter_hz, period);
  const double gain = wall.damping * (1.0 - a) / period;
  WallFilter filter;
  filter.kind = WallFilter::Kind::digital;
  filter.numerator = {*wall.stiffness + gain, -(*wall.stiffness * a + gain)};
  filter.denominator = {1.0, -a};
  return filter;
}

/// The largest swing that an encoder's error, within half a step, keeps up in this stable loop: the first harmonic of what
/// lies within +-q/2 is that of a square wave at most, 2 q/pi, and the loop answers it by C P/(1 + C P).
double largest_swing_of_steps(const ObservedLoop& loop, double step) {
  const double period = loop.device.loop().sampling_period;
  const double frequency = std::min(loop.frequency, pi / period);
  const std::complex<double> open = response(filtered_plant(loop.device), frequency) *
                                    (*loop.stiffness + damper_response(virtual_damper(loop.device), period, frequency));
  return 2.0 * step / pi * std::abs(open / (1.0 + open));
}

/// Where the loop is critical with its whole force grown: how many times.
std::vector<NumberLimit::Crossing> crossings_of_force(const ObservedLoop& loop) {
  std::vector<NumberLimit::Crossing> crossings;
  if (loop.number == WallNumber::damping) {
    crossings = unchecked_number_limit(loop.device, loop.number).crossings;
    for (NumberLimit::Crossing& each : crossings) each.value /= *gain_of(loop);
    return crossings;
  }
  const FilteredPlant open = filtered_plant(
      filtered_plant(loop.device), {controller(loop.device.parameters().wall, loop.device.loop().sampling_period)});
  for (const Crossover& each : critical_stiffness(open).crossovers) {
    crossings.push_back({each.frequency, each.stiffness, each.limited_by});
  }
  return crossings;
}

Evidence gain_evidence(const ObservedLoop& loop, double value, std::string_view name = "gain") {
  const Units units = units_of(loop.device.parameters().motion);
  return {name, value, loop.number == WallNumber::stiffness ? units.stiffness : units.damping};
}

/// Some passive user makes walls, or dampers, from this one on oscillate.
Finding by_some_user(const ObservedLoop& loop, double gain) {
  return {.code = FindingCode::some_user_destabilises,
          .evidence = {gain_evidence(loop, gain)},
          .subjects = {{"what", loop.number == WallNumber::stiffness ? "wall" : "damper"}}};
}

void set_gain(const ObservedLoop& loop, double value, OscillationCandidate& candidate) {
  (loop.number == WallNumber::stiffness ? candidate.stiffness : candidate.damping) = value;
}

void set_crossing(const ObservedLoop& loop, const NumberLimit::Crossing& crossing, OscillationCandidate& candidate) {
  candidate.frequency = crossing.frequency;
  candidate.limited_by = crossing.limited_by;
  set_gain(loop, crossing.value, candidate);
}

/// By how much a predicted frequency would have to be another to be within `tolerance` of the one observed.
double frequency_needed(const ObservedLoop& loop, double predicted, double tolerance) {
  return apart(predicted, loop.frequency) <= tolerance ? 1.0 : loop.frequency / predicted;
}

/// Of a loop that is stable with this wall: the crossover that would be it with the least otherwise.
void take_if_nearer(const ObservedLoop& loop, const NumberLimit::Crossing& crossing, OscillationCandidate& candidate) {
  OscillationCandidate other = candidate;
  set_crossing(loop, crossing, other);
  other.otherwise = {.limit = *gain_of(loop) / crossing.value,
                     .frequency = frequency_needed(loop, crossing.frequency, near)};
  if (distance_to_fit(other) < distance_to_fit(candidate)) candidate = std::move(other);
}

/// The frequency at which some user could make it oscillate with the least otherwise, and what that is.
void look_for_nearest_user(const ObservedLoop& loop, const UsersAtFrequency& users, OscillationCandidate& candidate) {
  const std::optional<double> gain = gain_of(loop);
  for (int i = -users_looked_at; i <= users_looked_at; ++i) {
    const double at = loop.frequency * std::pow(far, static_cast<double>(i) / users_looked_at);
    if (at > users.nyquist()) break;
    const double least = users.least_gain_at(at);
    if (!std::isfinite(least) || least == 0.0) continue;
    OscillationCandidate other = candidate;
    other.frequency = at;
    set_gain(loop, least, other);
    other.otherwise = {.limit = gain ? std::min(1.0, *gain / least) : 1.0,
                       .frequency = frequency_needed(loop, at, beside_user)};
    if (distance_to_fit(other) < distance_to_fit(candidate)) candidate = std::move(other);
  }
  if (candidate.otherwise) {
    candidate.why = by_some_user(loop, candidate.stiffness ? *candidate.stiffness : *candidate.damping);
    candidate.why.evidence.push_back(frequency_of(candidate.frequency));
  }
}

/// The lengths that rub: bodies, or joints and cables of a mechanism.
std::vector<Coordinates::Friction> frictions_of(const Device& device) {
  if (const auto& coordinates = device.parameters().coordinates) return coordinates->frictions;
  std::vector<Coordinates::Friction> frictions;
  for (std::size_t i = 0; i < device.bodies().size(); ++i) {
    if (!(device.bodies()[i].coulomb > 0.0)) continue;
    frictions.push_back({std::vector<double>(device.bodies().size(), 0.0), device.bodies()[i].coulomb});
    frictions.back().weights[i] = 1.0;
  }
  return frictions;
}

/// With the position of what rubs, as it is, in place of the sensed one.
Device with_sensed(const Device& device, const Coordinates::Friction& rubbing) {
  DeviceParameters parameters = device.parameters();
  parameters.sensor.tracking_bandwidth = 0.0;
  if (parameters.coordinates) {
    parameters.loop.sensed = parameters.coordinates->points.size();
    parameters.coordinates->points.push_back({"rubbing", rubbing.weights});
  } else {
    parameters.loop.sensed =
        static_cast<std::size_t>(std::ranges::max_element(rubbing.weights) - rubbing.weights.begin());
  }
  return Device(std::move(parameters));
}

/// Of the sensed position, where what rubs moves at V = 4/(pi share): by the ratio of the responses to the actuator; the
/// geometric mean over all that rubs.
double friction_amplitude(const Device& device, double share, double frequency) {
  const auto response_of = [&](const Device& seen) {
    return std::abs(response(sample(state_space(seen), {device.loop().sampling_period, 0.0}), frequency));
  };
  const double sensed = response_of(device);
  double logarithm = 0.0;
  const std::vector<Coordinates::Friction> frictions = frictions_of(device);
  for (const Coordinates::Friction& each : frictions) {
    logarithm += std::log(4.0 / (pi * share) / frequency * sensed / response_of(with_sensed(device, each)));
  }
  return std::exp(logarithm / static_cast<double>(frictions.size()));
}

}  // namespace

double distance_to_fit(const OscillationCandidate& candidate) {
  if (candidate.fits) return 0.0;
  if (!candidate.otherwise) return infinity;
  const OtherwiseNeeded& needed = *candidate.otherwise;
  return apart(needed.limit, 1.0) + apart(needed.frequency, 1.0) + apart(needed.amplitude, 1.0);
}

bool is_near(const OscillationCandidate& candidate) {
  if (candidate.fits) return true;
  if (!candidate.otherwise) return false;
  const auto close = [](double factor) { return apart(factor, 1.0) <= std::log(far); };
  const OtherwiseNeeded& needed = *candidate.otherwise;
  return close(needed.limit) && close(needed.frequency) && close(needed.amplitude);
}

std::optional<double> gain_of(const ObservedLoop& loop) {
  return loop.number == WallNumber::stiffness ? loop.stiffness : loop.device.parameters().wall.damping;
}

bool is_stable(const Device& device) { return LoopPoles(device).is_stable(); }

Device with_friction_as_damping(const Device& device, double share) {
  DeviceParameters parameters = device.parameters();
  for (Body& body : parameters.bodies) body.damping += share * body.coulomb;
  if (parameters.coordinates) {
    for (const Coordinates::Friction& each : parameters.coordinates->frictions) {
      parameters.coordinates->elements.push_back({each.weights, 0.0, share * each.force});
    }
  }
  return Device(std::move(parameters));
}

std::vector<double> friction_shares(const Device& device) {
  // From hardly any damping to what holds the bodies still at any frequency below Nyquist.
  const double highest = 1e3 * moving_mass(device) / device.loop().sampling_period / dry_friction(device);
  std::vector<double> result;
  result.reserve(static_cast<std::size_t>(shares));
  for (int i = 0; i < shares; ++i)
    result.push_back(highest * std::pow(1e-9, 1.0 - static_cast<double>(i) / (shares - 1)));
  return result;
}

OscillationCandidate linear_candidate(const ObservedLoop& loop, OscillationCause cause, const Device& device) {
  OscillationCandidate candidate;
  candidate.cause = cause;
  const NumberLimit critical = unchecked_number_limit(device, loop.number);
  const std::optional<double> gain = gain_of(loop);
  const NumberLimit::Crossing* nearest = nullptr;
  for (const NumberLimit::Crossing& each : critical.crossings) {
    if (each.frequency <= 0.0 || (gain && each.value > *gain)) continue;
    if (nearest == nullptr || apart(each.frequency, loop.frequency) < apart(nearest->frequency, loop.frequency)) {
      nearest = &each;
    }
  }
  if (nearest != nullptr) set_crossing(loop, *nearest, candidate);
  if (!loop.stiffness) {
    if (nearest == nullptr) {
      candidate.why = {.code = FindingCode::no_crossover};
      return candidate;
    }
    candidate.fits = apart(nearest->frequency, loop.frequency) <= near;
    if (!candidate.fits) candidate.otherwise = {.frequency = loop.frequency / nearest->frequency};
    candidate.why = {.code = FindingCode::crossover_at_frequency,
                     .evidence = {frequency_of(nearest->frequency), gain_evidence(loop, nearest->value)}};
    if (critical.at && critical.value < nearest->value) {
      candidate.why.evidence.push_back(gain_evidence(loop, critical.value, "softest"));
      candidate.why.evidence.push_back(frequency_of(critical.at->frequency, "softest_hz"));
    }
    return candidate;
  }
  const double unstable = LoopPoles(device).unstable_frequency(loop.frequency).value_or(0.0);
  if (unstable == 0.0) {
    candidate.why = {.code = FindingCode::loop_stable};
    for (const NumberLimit::Crossing& each : critical.crossings) {
      if (each.frequency > 0.0 && each.value > 0.0) take_if_nearer(loop, each, candidate);
    }
    return candidate;
  }
  // A force limit lets it settle between the frequency at which it grows and the crossover.
  const double low = std::min(unstable, candidate.frequency > 0.0 ? candidate.frequency : unstable);
  const double high = std::max(unstable, candidate.frequency);
  const bool between = loop.frequency >= low && loop.frequency <= high;
  if (apart(unstable, loop.frequency) < apart(std::max(candidate.frequency, 1e-300), loop.frequency)) {
    candidate.frequency = unstable;
  }
  candidate.fits = true;  // whatever else is in the loop: it does not stay at rest
  candidate.why = {.code = FindingCode::loop_unstable, .evidence = {frequency_of(unstable)}};
  if (!between && apart(candidate.frequency, loop.frequency) > near) {
    candidate.why.evidence.push_back({"settles_elsewhere", 1.0});
  }
  return candidate;
}

OscillationCandidate user_candidate(const ObservedLoop& loop) {
  const UsersAtFrequency users(loop.device, loop.number, loop.progress);
  const std::optional<double> gain = gain_of(loop);
  OscillationCandidate candidate;
  candidate.cause = OscillationCause::passive_user;
  candidate.frequency = loop.frequency;
  double least = infinity;
  for (const double share : {0.0, -beside_user, beside_user}) {
    least = std::min(least, users.least_gain_at(std::min(loop.frequency * (1.0 + share), users.nyquist())));
    if (share == 0.0 && gain && least <= *gain) break;
  }
  if (!std::isfinite(least)) {
    candidate.why = {.code = loop.number == WallNumber::stiffness ? FindingCode::no_user_destabilises_wall
                                                                  : FindingCode::no_user_destabilises_damper};
    look_for_nearest_user(loop, users, candidate);
    return candidate;
  }
  set_gain(loop, least, candidate);
  candidate.fits = !gain || *gain >= of_user_limit * least;
  candidate.why = by_some_user(loop, least);
  if (candidate.fits && gain && !is_stable(device_without_user(loop.device))) {
    candidate.fits = false;
    candidate.why.evidence.push_back({"with_nobody", 1.0});
  } else if (!candidate.fits) {
    look_for_nearest_user(loop, users, candidate);
  }
  return candidate;
}

std::optional<OscillationCandidate> quantisation_candidate(const ObservedLoop& observed) {
  if (has_two_loops(observed.device)) return std::nullopt;
  ObservedLoop loop = observed;
  loop.device = in_one_loop(observed.device);
  const DeviceParameters& parameters = loop.device.parameters();
  const double step = parameters.sensor.resolution;
  const std::optional<double> gain = gain_of(loop);
  if (!(step > 0.0) || !gain || !(*gain > 0.0)) return std::nullopt;
  OscillationCandidate candidate;
  candidate.cause = OscillationCause::quantisation;
  if (!is_stable(loop.device)) {
    candidate.why = {.code = FindingCode::unstable_without_steps};
    return candidate;
  }
  const double period = loop.device.loop().sampling_period;
  const std::vector<NumberLimit::Crossing> scaled = crossings_of_force(loop);
  const NumberLimit::Crossing* nearest = nullptr;
  for (const NumberLimit::Crossing& each : scaled) {
    if (each.value <= 1.0 || each.frequency <= 0.0) continue;
    if (nearest == nullptr || apart(each.frequency, loop.frequency) < apart(nearest->frequency, loop.frequency)) {
      nearest = &each;
    }
  }
  if (nearest == nullptr) {
    candidate.why = {.code = FindingCode::no_crossover_for_steps};
    return candidate;
  }
  candidate.frequency = nearest->frequency;
  candidate.limited_by = nearest->limited_by;
  candidate.amplitude = 2.0 * step / (pi * nearest->value);
  const double friction = dry_friction(loop.device);
  const double relay =
      0.5 * step * std::abs(*loop.stiffness + damper_response(virtual_damper(loop.device), period, nearest->frequency));
  const Units units = units_of(parameters.motion);
  if (friction >= relay) {
    candidate.why = {.code = FindingCode::friction_holds_against_steps,
                     .evidence = {{"friction", friction, units.force}, {"force", relay, units.force}}};
    return candidate;
  }
  const double largest = std::max(counts_of_quantisation * step, largest_swing_of_steps(loop, step));
  if (loop.amplitude && *loop.amplitude > largest) {
    candidate.why = {.code = FindingCode::swing_beyond_steps,
                     .evidence = {{"amplitude", *loop.amplitude, units.length},
                                  {"resolution", step, units.length},
                                  {"threshold", largest, units.length}}};
    candidate.otherwise = {.amplitude = *loop.amplitude / largest};
    return candidate;
  }
  // Steps far from a sine swing far from the crossover, but not by more than a step or two.
  candidate.fits = loop.amplitude || apart(nearest->frequency, loop.frequency) <= near_harmonic;
  if (!candidate.fits) candidate.otherwise = {.frequency = loop.frequency / nearest->frequency};
  candidate.why = {.code = FindingCode::cycle_of_steps, .evidence = {frequency_of(nearest->frequency)}};
  if (loop.amplitude && *loop.amplitude > counts_of_quantisation * step) {
    candidate.why = {.code = FindingCode::resonance_of_steps, .evidence = {{"amplitude", largest, units.length}}};
  }
  return candidate;
}

std::optional<OscillationCandidate> friction_candidate(const ObservedLoop& loop) {
  if (!(dry_friction(loop.device) > 0.0) || !loop.stiffness) return std::nullopt;
  OscillationCandidate candidate;
  candidate.cause = OscillationCause::friction;
  // A loop that is unstable even while its bodies slide may still have a small cycle on which they hardly do.
  double sliding = is_stable(loop.device) ? 0.0 : -1.0;
  std::optional<double> best;
  for (const double share : friction_shares(loop.device)) {
    tell(loop.progress, 0.0);
    if (is_stable(with_friction_as_damping(loop.device, share))) {
      sliding = share;
      continue;
    }
    if (sliding < 0.0) continue;  // unstable over a whole range: its lower end is the cycle that holds itself
    double low = sliding;
    double high = share;
    for (int i = 0; i < bisections; ++i) {
      tell(loop.progress, 0.0);
      const double middle = low > 0.0 ? std::sqrt(low * high) : 0.5 * high;
      (is_stable(with_friction_as_damping(loop.device, middle)) ? low : high) = middle;
    }
    const double frequency = LoopPoles(with_friction_as_damping(loop.device, high)).critical_frequency();
    if (frequency > 0.0 && (!best || apart(frequency, loop.frequency) < apart(candidate.frequency, loop.frequency))) {
      best = high;
      candidate.frequency = frequency;
    }
    sliding = -1.0;
  }
  if (!best) {
    candidate.why = {.code = FindingCode::friction_destabilises_nothing};
    return candidate;
  }
  candidate.amplitude = friction_amplitude(with_friction_as_damping(loop.device, *best), *best, candidate.frequency);
  const double share = loop.amplitude.value_or(*candidate.amplitude) / *candidate.amplitude;
  if (share > most_of_amplitude || share < least_of_amplitude) {
    const std::string_view unit = units_of(loop.device.parameters().motion).length;
    candidate.why = {.code = FindingCode::friction_cycle_of_other_swing,
                     .evidence = {frequency_of(candidate.frequency),
                                  {"amplitude", *candidate.amplitude, unit},
                                  {"observed", *loop.amplitude, unit}}};
    candidate.otherwise = {.frequency = frequency_needed(loop, candidate.frequency, near_harmonic), .amplitude = share};
    return candidate;
  }
  candidate.fits = apart(candidate.frequency, loop.frequency) <= near_harmonic;
  if (!candidate.fits) candidate.otherwise = {.frequency = loop.frequency / candidate.frequency};
  candidate.why = {.code = FindingCode::friction_cycle, .evidence = {frequency_of(candidate.frequency)}};
  return candidate;
}

}  // namespace zwidth::internal

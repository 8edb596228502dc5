#include "identification/time_domain_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "identification/alike_devices.hpp"
#include "identification/fit_judgement.hpp"
#include "identification/lateness.hpp"
#include "identification/link_mode.hpp"
#include "identification/misfit_doubt.hpp"
#include "simulation/continuous_motion.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

/// Root mean squares of a record.
struct Sizes {
  double force = 0.0;
  double velocity = 0.0;
  double position = 0.0;  ///< about its mean
};

Sizes sizes_of(const Recording& recording) {
  const std::vector<double>& force = recording.channels[0].samples;
  const std::vector<double>& position = recording.channels[1].samples;
  constexpr std::size_t reach = 4;  // samples: the encoder's steps count less
  Sizes sizes;
  double mean = 0.0;
  for (const double each : position) mean += each / static_cast<double>(position.size());
  for (std::size_t k = 0; k < force.size(); ++k) {
    sizes.force += force[k] * force[k];
    sizes.position += std::pow(position[k] - mean, 2);
    if (k >= reach) sizes.velocity += std::pow(position[k] - position[k - reach], 2);
  }
  const auto n = static_cast<double>(force.size());
  sizes.force = std::sqrt(sizes.force / n);
  sizes.position = std::sqrt(sizes.position / n);
  sizes.velocity = std::sqrt(sizes.velocity / n) / (recording.sampling_period * static_cast<double>(reach));
  return sizes;
}

const Recording& strongest(std::span<const Recording> recordings) {
  return *std::ranges::max_element(recordings, {}, [](const Recording& each) { return sizes_of(each).force; });
}

double typical_link_damping(const Device& device, const std::string& key) {
  const auto dot = key.find('.');
  return link_damping(device.parameters(), device.links().at(std::stoul(key.substr(dot + 1))), typical_damping_ratio);
}

/// A part of the delay as lag where there is none: from 0 itself a search does not see it.
Device with_some_lag(const Device& device, double period) {
  DeviceParameters parameters = device.parameters();
  if (parameters.actuator.time_constant > 0.0) return device;
  constexpr double share = 0.2;
  parameters.actuator.time_constant = share * period;
  parameters.loop.delay = std::max(0.0, parameters.loop.delay - share * period);
  parameters.uncertainty.reset();
  return Device(std::move(parameters));
}

bool is_friction(const std::string& key) { return key.ends_with(".coulomb"); }

void check_free(const Device& structure, const std::vector<std::string>& free) {
  std::set<std::string> seen;
  std::size_t rubbing = 0;
  for (const std::string& key : free) {
    const bool shows = key.starts_with("body.") || key.starts_with("link.") || key == delay_key || key == lag_key;
    if (!shows || !parameter(structure.parameters(), key)) {
      throw Error(
          ErrorCode::invalid_argument,
          fmt::format("{} is no number of the structure's bodies, links, delay or lag; it cannot be free", key));
    }
    if (!seen.insert(key).second) throw Error(ErrorCode::invalid_argument, key + " is given twice as free");
    if (is_friction(key)) ++rubbing;
  }
  if (rubbing > ContinuousMotion::max_friction_bodies) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("Coulomb friction is free on {} bodies; it can be on at most {}", rubbing,
                            ContinuousMotion::max_friction_bodies));
  }
}

/// Of the strongest recording, or of all together where that alone has too few lines, as a single sine has.
Identification linear_fit(std::span<const Recording> recordings, const Device& structure,
                          const IdentifyOptions& options) {
  try {
    return identify(strongest(recordings), structure, options);
  } catch (const Error&) {
    if (recordings.size() == 1) throw;
    return identify(recordings, structure, options);
  }
}

}  // namespace

TimeDomainStart time_domain_start(std::span<const Recording> recordings, const Device& structure,
                                  const TimeDomainOptions& options) {
  IdentifyOptions linear;
  linear.structure_values = options.structure_values;
  linear.loop_delay = options.loop_delay;
  linear.fit.locked = options.locked;
  linear.fit.critical_point = ParameterFitOptions::CriticalPoint::free;
  linear.scrutiny = IdentifyOptions::Scrutiny::of_fit;
  const bool takes_all = frees_all(options.free);
  std::vector<std::string> given;
  for (const std::string& key : options.free) {
    if (key != "all") given.push_back(full_parameter_key(structure.parameters(), key));
  }
  check_free(structure, given);
  std::ranges::copy_if(given, std::back_inserter(linear.fit.free), [](const auto& key) { return !is_friction(key); });
  if (takes_all && !linear.fit.free.empty()) linear.fit.free.emplace_back("all");
  if (!takes_all) linear.loop_delay = IdentifyOptions::LoopDelay::as_given;

  TimeDomainStart start{.device = structure, .free = given};
  if (takes_all || !linear.fit.free.empty()) {
    const Identification found = linear_fit(recordings, structure, linear);
    start.device = found.fit.device;
    start.lowest = found.fit.frequencies.front();
    start.highest = found.fit.frequencies.back();
    start.is_turned = found.fit.model_error_if_turned.has_value();
    if (const auto& interval = found.analysis.interval; interval && !found.trust.refused() && found.fit.settled) {
      start.linear = LinearStiffness{found.analysis.critical.stiffness, interval->upper,
                                     doubt_of_misfit(found.fit, found.response).has_value()};
    }
    start.may_be_late = found.ignored_delay.has_value();
    if (takes_all) start.free = keys_of(found.fit);
    constexpr double above = 2.0;  // the band
    // A link that only damps is too stiff to be played, and a search in time does not leave it.
    if (auto springs = with_springs(start.device.parameters(), start.free, above * start.highest)) {
      start.device = Device(*std::move(springs));
    }
  }
  const bool is_fitted = takes_all || std::ranges::count(given, delay_key) > 0;
  if (!is_fitted && assumes_delay(structure, options.structure_values, options.loop_delay)) start.may_be_late = true;
  if (takes_all) {
    const auto add = [&](const std::string& key) {
      if (std::ranges::count(start.free, key) == 0) start.free.push_back(key);
    };
    if (options.loop_delay != IdentifyOptions::LoopDelay::as_given) {
      for (const char* key : {delay_key, lag_key}) add(key);
      start.device = with_some_lag(start.device, strongest(recordings).sampling_period);
    }
    for (const Body& body : structure.bodies()) {
      const bool is_locked = std::ranges::count(options.locked, body.name) > 0;
      if (!is_locked) add("body." + body.name + ".coulomb");
    }
    for (const std::string& key : given) add(key);
    check_free(structure, start.free);
  }
  return start;
}

std::vector<FrictionStart> starting_frictions(const TimeDomainStart& start, std::span<const Recording> recordings) {
  const Sizes sizes = sizes_of(strongest(recordings));
  std::vector<std::size_t> rubbing;
  DeviceParameters parameters = start.device.parameters();
  parameters.uncertainty.reset();
  for (std::size_t i = 0; i < parameters.bodies.size(); ++i) {
    const bool is_free = std::ranges::count(start.free, "body." + parameters.bodies[i].name + ".coulomb") > 0;
    if (is_free) rubbing.push_back(i);
  }
  if (rubbing.empty()) return {{parameters}};
  std::vector<FrictionStart> starts;
  const auto add = [&](DeviceParameters each, double share, double handicap) {
    const double friction = share * sizes.force / static_cast<double>(rubbing.size());
    for (const std::size_t body : rubbing) {
      constexpr double least = 0.1;
      const double taken = std::sqrt(2.0 / std::numbers::pi) * friction / sizes.velocity;
      each.bodies[body].coulomb = friction;
      each.bodies[body].damping = std::max(least * each.bodies[body].damping, each.bodies[body].damping - taken);
    }
    starts.push_back({std::move(each), handicap});
  };
  for (const double share : {0.03, 0.2, 0.6}) add(parameters, share, 0.0);  // of the force
  for (const DeviceParameters& alike : alike_devices(parameters, start.free)) {
    constexpr double clear = 10.0;
    for (const double share : {0.03, 0.2}) add(alike, share, clear);
  }
  return starts;
}

std::vector<Coordinate> time_domain_coordinates(const TimeDomainStart& start, std::span<const Recording> recordings) {
  const Recording& recording = strongest(recordings);
  const Sizes sizes = sizes_of(recording);
  std::vector<Coordinate> coordinates;
  for (const std::string& key : start.free) {
    Coordinate coordinate{key, Coordinate::kind_of(key), 1.0};
    const bool is_link = key.starts_with("link.");
    const double value = parameter(start.device.parameters(), key).value_or(0.0);
    if (coordinate.kind == Coordinate::Kind::logarithmic) {
      coordinate.unit = value;
    } else if (key == delay_key || key == lag_key) {
      coordinate.unit = recording.sampling_period;
    } else if (is_friction(key)) {
      coordinate.unit = 0.1 * sizes.force;
    } else if (is_link) {
      coordinate.unit = std::max(value, typical_link_damping(start.device, key));
    } else if (key.ends_with(".damping")) {
      coordinate.unit = std::max(value, 0.01 * sizes.force / sizes.velocity);
    } else {
      coordinate.unit = std::max(value, 0.01 * sizes.force / sizes.position);
    }
    coordinates.push_back(std::move(coordinate));
  }
  return coordinates;
}

}  // namespace zwidth::internal

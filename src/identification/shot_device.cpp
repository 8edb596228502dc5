#include "identification/shot_device.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "identification/motion_residuals.hpp"
#include "identification/student_t.hpp"
#include "identification/time_domain_start.hpp"
#include "simulation/continuous_motion.hpp"
#include "stability/device_draws.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {
namespace {

/// Known to a factor of e only: nothing that a number could be given for.
bool is_open(const Coordinate& coordinate, double variance) {
  constexpr double open = 1.0;
  return !std::isfinite(variance) || (coordinate.kind == Coordinate::Kind::logarithmic && variance > open);
}

ParameterEstimate estimate(const Coordinate& coordinate, double x, bool determined, double variance) {
  ParameterEstimate result{coordinate.key, coordinate.value(x), determined, {}, {}, {}};
  if (!determined || is_open(coordinate, variance)) {
    result.identifiable = false;
    return result;
  }
  const double deviation = coordinate.slope(x) * std::sqrt(variance);
  result.standard_deviation = deviation;
  result.lower = std::max(0.0, result.value - two_sided_95 * deviation);
  result.upper = result.value + two_sided_95 * deviation;
  return result;
}

/// The numbers that the records determine, with their covariance.
std::vector<Eigen::Index> kept_of(const ShotModel& model, const ShotCovariance& known) {
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < model.coordinates().size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double variance = known.covariance(at, at);
    const Coordinate& coordinate = model.coordinates()[i];
    const bool is_of_a_combination = !known.known.determined[i] && variance > 0.0;
    const bool shows = (known.known.determined[i] || is_of_a_combination) && !is_open(coordinate, variance);
    if (known.varies[i] && known.known.shows(i) && shows) kept.push_back(at);
  }
  return kept;
}

/// The device at x, known as well as that.
Device device_at(const ShotModel& model, const ShotFit& fit, const ShotCovariance& known) {
  DeviceParameters fitted = model.parameters_at(fit.x);
  const std::vector<Eigen::Index> kept = kept_of(model, known);
  if (kept.empty() || kept.size() > max_uncertain_parameters) return Device(std::move(fitted));
  Uncertainty uncertainty;
  for (const Eigen::Index i : kept) {
    const Coordinate& row = model.coordinates()[static_cast<std::size_t>(i)];
    uncertainty.parameters.push_back(row.key);
    uncertainty.covariance.emplace_back();
    for (const Eigen::Index j : kept) {
      const Coordinate& column = model.coordinates()[static_cast<std::size_t>(j)];
      uncertainty.covariance.back().push_back(row.slope(fit.x(i)) * known.covariance(i, j) * column.slope(fit.x(j)));
    }
  }
  fitted.uncertainty = std::move(uncertainty);
  return Device(std::move(fitted));
}

/// Pairs that are known together only.
std::vector<StrongCorrelation> correlations_of(const ShotModel& model, const ShotCovariance& known) {
  constexpr double strong = 0.95;
  std::vector<StrongCorrelation> found;
  std::vector<Eigen::Index> kept = kept_of(model, known);
  std::erase_if(kept, [&](Eigen::Index i) { return !known.known.determined[static_cast<std::size_t>(i)]; });
  const auto key = [&](Eigen::Index i) { return model.coordinates()[static_cast<std::size_t>(i)].key; };
  for (const Eigen::Index i : kept) {
    for (const Eigen::Index j : kept) {
      const double scale = std::sqrt(known.covariance(i, i) * known.covariance(j, j));
      if (j <= i || !(std::abs(known.covariance(i, j)) > strong * scale)) continue;
      found.push_back({key(i), key(j), known.covariance(i, j) / scale});
    }
  }
  return found;
}

/// The model with more numbers to vary than were free, held where they are.
struct WiderFit {
  ShotModel model;
  ShotFit fit;
  std::size_t first = 0;  ///< of the additional coordinates
};

std::vector<std::string> numbers_not_free(const ShotModel& model, const Device& structure,
                                          const std::vector<std::string>& locked) {
  std::vector<std::string> keys = fittable_parameters(structure, locked);
  std::erase_if(keys, [](const std::string& key) { return !key.starts_with("body.") && !key.starts_with("link."); });
  for (const Body& body : structure.bodies()) {  // a spring to the ground that is not in the structure: a hand, a cable
    const bool moves = std::ranges::count(locked, body.name) == 0;
    if (moves && body.stiffness == 0.0) keys.push_back("body." + body.name + ".stiffness");
  }
  if (structure.bodies().size() <= ContinuousMotion::max_friction_bodies) {
    for (const Body& body : structure.bodies()) {
      if (std::ranges::count(locked, body.name) == 0) keys.push_back("body." + body.name + ".coulomb");
    }
  }
  std::erase_if(
      keys, [&](const std::string& key) { return std::ranges::count(model.coordinates(), key, &Coordinate::key) > 0; });
  return keys;
}

WiderFit wider_fit(const FittedDevice& fitted, std::vector<std::string> keys, std::span<const Recording> recordings,
                   const std::vector<std::string>& locked) {
  const ShotFit& fit = fitted.fitted.fit;
  const Device device(fitted.model.parameters_at(fit.x));
  std::vector<Coordinate> coordinates = fitted.model.coordinates();
  const std::size_t first = coordinates.size();
  TimeDomainStart start{.device = device, .free = std::move(keys)};
  std::ranges::copy(time_domain_coordinates(start, recordings), std::back_inserter(coordinates));
  const std::size_t count = coordinates.size();
  WiderFit wider{ShotModel(device, fitted.model.records(), std::move(coordinates), locked), fit, first};
  const auto biases = static_cast<Eigen::Index>(recordings.size());
  wider.fit.x = wider.model.position_of(device.parameters());
  wider.fit.x.tail(biases) = fit.x.tail(biases);
  wider.fit.held = fit.held;
  wider.fit.held.insert(wider.fit.held.begin() + static_cast<std::ptrdiff_t>(first), count - first, true);
  return wider;
}

}  // namespace

Eigen::VectorXd moved(const ShotModel& model, const Eigen::VectorXd& x, Eigen::VectorXd step,
                      const Eigen::MatrixXd& covariance) {
  Eigen::VectorXd bounds = Eigen::VectorXd::Constant(x.size(), -std::numeric_limits<double>::infinity());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (model.is_bounded(i)) bounds(i) = -x(i);
  }
  bring_within(step, bounds, covariance);
  return x + step.cwiseMax(bounds);
}

void describe_parameters(TimeDomainIdentification& result, const ShotModel& model, const ShotFit& fit,
                         const ShotCovariance& known) {
  for (std::size_t i = 0; i < model.coordinates().size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    result.estimates.push_back(
        estimate(model.coordinates()[i], fit.x(at), known.known.determined[i], known.covariance(at, at)));
  }
  result.correlations = correlations_of(model, known);
  for (const std::vector<std::size_t>& combination : known.known.combinations) {
    UnidentifiableCombination each;
    for (const std::size_t k : combination) {
      if (k < model.coordinates().size()) each.parameters.push_back(model.coordinates()[k].key);
    }
    if (!each.parameters.empty()) result.unidentifiable.push_back(std::move(each));
  }
  result.device = device_at(model, fit, known);
}

std::vector<OwnDevice> devices_of_recordings(const FittedDevice& fitted, std::span<const Recording> recordings) {
  std::vector<OwnDevice> devices;
  if (recordings.size() < 2) return devices;
  const ShotFit& fit = fitted.fitted.fit;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    std::vector<Shot> own;
    ShotFit alone{fit.x, {}, fit.held};
    for (std::size_t i = 0; i < fitted.shots.size(); ++i) {
      if (fitted.shots[i].record != r) continue;
      own.push_back(fitted.shots[i]);
      alone.states.push_back(fit.states[i]);
    }
    // The constant forces of the others have no slopes here: they stay.
    for (std::size_t other = 0; other < recordings.size(); ++other) {
      if (other != r) alone.held[fitted.model.coordinates().size() + other] = true;
    }
    const auto slopes = shot_slopes(fitted.model, own, fitted.fitted.noise, alone.x, alone.states);
    if (!slopes) continue;
    const ShotCovariance known = shot_covariance(*slopes, alone.held);
    alone.x = moved(fitted.model, alone.x, known.step, known.covariance);
    devices.push_back({recordings[r].source, device_at(fitted.model, alone, known)});
  }
  return devices;
}

std::vector<ContradictedNumber> contradicted_numbers(const FittedDevice& fitted, const Device& structure,
                                                     std::span<const Recording> recordings,
                                                     const std::vector<std::string>& locked, double lowest) {
  std::vector<ContradictedNumber> found;
  std::vector<std::string> keys = numbers_not_free(fitted.model, structure, locked);
  if (keys.empty()) return found;
  const WiderFit wider = wider_fit(fitted, std::move(keys), recordings, locked);
  const auto slopes = shot_slopes(wider.model, fitted.shots, fitted.fitted.noise, wider.fit.x, wider.fit.states);
  if (!slopes) return found;
  const ShotCovariance known = shot_covariance(*slopes, wider.fit.held);
  const std::vector<Coordinate>& coordinates = wider.model.coordinates();
  const Device device = device_in_experiment(Device(fitted.model.parameters_at(fitted.fitted.fit.x)), locked,
                                             recordings.front().sampling_period);
  const double compliance = lowest > 0.0 ? std::abs(response(sampled_plant(device), lowest)) : 0.0;
  for (std::size_t k = wider.first; k < coordinates.size(); ++k) {
    constexpr double clear = 5.0;  // deviations, as of white noise: 3.9 at most of what was given rightly
    constexpr double notable = 0.02;
    const auto at = static_cast<Eigen::Index>(k);
    const double pull = known.pull(at);
    Eigen::VectorXd x = wider.fit.x;
    x(at) += pull * known.pulled_deviation(at);
    if (wider.model.is_bounded(at)) x(at) = std::max(0.0, x(at));
    const double given = coordinates[k].value(wider.fit.x(at));
    const double shown = coordinates[k].value(x(at));
    const bool is_new_spring = given == 0.0 && coordinates[k].key.ends_with(".stiffness");
    const bool counts = std::abs(shown - given) > notable * (is_new_spring ? 1.0 / compliance : given);
    if (std::abs(pull) > clear && counts) {
      found.push_back({coordinates[k].key, given, shown});
    }
  }
  return found;
}

}  // namespace zwidth::internal

#include "identification/found_device.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "identification/model/number_keys.hpp"
#include "identification/verdict/confidence.hpp"
#include "model/loop_keys.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {
namespace {

constexpr double clear_deviations = 2.0;

Eigen::Index size_of(const FoundDevice& found) { return static_cast<Eigen::Index>(found.best.numbers.size()); }
const Number& number_at(const FoundDevice& found, Eigen::Index i) {
  return found.best.numbers[static_cast<std::size_t>(i)];
}
double deviation_at(const FoundDevice& found, Eigen::Index i) {
  return std::sqrt(std::max(0.0, found.best.covariance(i, i)));
}
bool is_of_rival(const FoundDevice& found, const std::string& key) {
  return std::ranges::any_of(found.rivals,
                             [&](const AddedRival& rival) { return std::ranges::count(rival.keys, key) > 0; });
}
/// A number of the device that was free: neither a rival's nor a delay that is given.
bool is_free_number(const FoundDevice& found, Eigen::Index i) {
  const Number& number = number_at(found, i);
  const bool is_given = number.key == key_of_delay && std::isfinite(number.prior_deviation);
  return parameter(found.device, number.key) && !is_of_rival(found, number.key) && !is_given;
}
/// The data tell it: a logarithm to a factor of e, another number to three times what such numbers come to.
bool is_told(const FoundDevice& found, Eigen::Index i) {
  const double most = number_at(found, i).scale == Number::Scale::logarithmic ? 1.0 : 3.0;
  return deviation_at(found, i) < most;
}
bool is_clear(const FoundDevice& found, Eigen::Index i) {
  return std::abs(found.best.x(i)) > clear_deviations * deviation_at(found, i);
}

ParameterEstimate estimate_at(const FoundDevice& found, Eigen::Index i, std::string key) {
  const Number& number = number_at(found, i);
  const double x = found.best.x(i);
  const double deviation = deviation_at(found, i);
  ParameterEstimate estimate;
  estimate.key = std::move(key);
  estimate.value = number.value(x);
  estimate.identifiable = is_told(found, i);
  if (!estimate.identifiable) return estimate;
  estimate.standard_deviation = number.slope(x) * deviation;
  estimate.lower = number.value(std::max(number.lowest(), x - deviations_of_95 * deviation));
  estimate.upper = number.value(x + deviations_of_95 * deviation);
  return estimate;
}

/// Lag and spring to the ground that may as well be none, and the friction that is clear.
DeviceParameters with_clear_rivals(const FoundDevice& found) {
  DeviceParameters device = found.device;
  for (Eigen::Index i = 0; i < size_of(found); ++i) {
    const std::string& key = number_at(found, i).key;
    if (const auto rubbing = body_of_friction(key); rubbing && is_clear(found, i)) {
      for (Body& body : device.bodies) {
        if (*rubbing == body.name) body.coulomb = number_at(found, i).value(found.best.x(i));
      }
    }
    if (!parameter(device, key) || !is_of_rival(found, key) || is_clear(found, i)) continue;
    if (key == key_of_lag) device.loop.delay += device.actuator.time_constant;
    set_parameter(device, key, 0.0);
  }
  return device;
}

/// Of the values of those numbers.
Eigen::MatrixXd covariance_of_values(const FoundDevice& found, const std::vector<Eigen::Index>& of) {
  Eigen::VectorXd slopes(static_cast<Eigen::Index>(of.size()));
  for (std::size_t i = 0; i < of.size(); ++i)
    slopes(static_cast<Eigen::Index>(i)) = number_at(found, of[i]).slope(found.best.x(of[i]));
  Eigen::MatrixXd covariance = slopes.asDiagonal() * found.best.covariance(of, of) * slopes.asDiagonal();
  const Eigen::VectorXd limit = found.best.stiffness_slope(of).cwiseQuotient(slopes);
  const Eigen::VectorXd shared = covariance * limit;
  const double variance = limit.dot(shared);
  const Interval& interval = found.best.interval;
  const double half = 0.5 * std::log(interval.upper / interval.lower) / deviations_of_95;
  if (variance > 0.0 && std::isfinite(half) && half * half > variance)
    covariance += (half * half / variance - 1.0) / variance * shared * shared.transpose();
  return covariance;
}

}  // namespace

std::vector<ParameterEstimate> estimates_of(const FoundDevice& found) {
  std::vector<ParameterEstimate> estimates;
  for (Eigen::Index i = 0; i < size_of(found); ++i) {
    if (is_free_number(found, i)) estimates.push_back(estimate_at(found, i, number_at(found, i).key));
  }
  for (Eigen::Index i = 0; i < size_of(found); ++i) {
    const std::string& key = number_at(found, i).key;
    const std::optional<std::string> rubbing = body_of_friction(key);
    if (rubbing && is_clear(found, i)) estimates.push_back(estimate_at(found, i, "body." + *rubbing + ".coulomb"));
  }
  return estimates;
}

std::vector<StrongCorrelation> correlations_of(const FoundDevice& found) {
  constexpr double strong = 0.95;
  std::vector<StrongCorrelation> pairs;
  for (Eigen::Index i = 0; i < size_of(found); ++i) {
    for (Eigen::Index j = i + 1; j < size_of(found); ++j) {
      const double both = deviation_at(found, i) * deviation_at(found, j);
      const bool are_free =
          is_free_number(found, i) && is_free_number(found, j) && is_told(found, i) && is_told(found, j);
      if (!are_free || !(both > 0.0)) continue;
      const double correlation = found.best.covariance(i, j) / both;
      if (std::abs(correlation) > strong)
        pairs.push_back({number_at(found, i).key, number_at(found, j).key, correlation});
    }
  }
  return pairs;
}

std::vector<UnidentifiableCombination> open_numbers_of(const FoundDevice& found) {
  UnidentifiableCombination open;
  for (Eigen::Index i = 0; i < size_of(found); ++i) {
    if (is_free_number(found, i) && !is_told(found, i)) open.parameters.push_back(number_at(found, i).key);
  }
  if (open.parameters.empty()) return {};
  return {open};
}

Device device_of(const FoundDevice& found) {
  DeviceParameters device = with_clear_rivals(found);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < size_of(found); ++i) {
    const std::string& key = number_at(found, i).key;
    const bool is_kept_rival = parameter(device, key) && is_of_rival(found, key) && is_clear(found, i);
    if (is_kept_rival || (is_free_number(found, i) && is_told(found, i))) kept.push_back(i);
  }
  if (kept.empty()) return Device(std::move(device));
  const Eigen::MatrixXd covariance = covariance_of_values(found, kept);
  Uncertainty uncertainty;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    uncertainty.parameters.push_back(number_at(found, kept[i]).key);
    const Eigen::VectorXd row = covariance.row(static_cast<Eigen::Index>(i)).transpose();
    uncertainty.covariance.emplace_back(row.data(), row.data() + row.size());
  }
  device.uncertainty = std::move(uncertainty);
  return Device(std::move(device));
}

}  // namespace zwidth::internal

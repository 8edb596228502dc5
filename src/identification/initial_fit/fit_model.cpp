#include "identification/initial_fit/fit_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "counted.hpp"
#include "identification/initial_fit/motion_slope.hpp"
#include "identification/initial_fit/response_features.hpp"
#include "identification/initial_fit/response_slopes.hpp"
#include "model/key_members.hpp"
#include "model/loop_keys.hpp"
#include "signal/median.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {
namespace {

// Of a central difference: the response is known to some 1e-13, its curvature is felt from 1e-3 of a light damping on.
constexpr double difference_step = 1e-6;

/// What the key's quantity typically is, from the sizes of force per position, per velocity and per acceleration.
double unit_of(std::optional<Measure> measure, const std::vector<ResponsePoint>& points) {
  if (measure == Measure::time) return 1.0 / points.back().frequency;
  const int order = measure == Measure::mass ? 2 : measure == Measure::damping ? 1 : 0;
  std::vector<double> sizes;
  sizes.reserve(points.size());
  for (const ResponsePoint& point : points) {
    sizes.push_back(1.0 / (std::abs(point.value) * std::pow(point.frequency, order)));
  }
  return median(std::move(sizes));
}

void check_response(const FrequencyResponse& response, std::size_t parameters) {
  for (const ResponsePoint& point : response.points) {
    const bool is_finite = std::isfinite(point.value.real()) && std::isfinite(point.value.imag());
    if (!is_finite || point.value == 0.0 || !(point.frequency > 0.0) || !(point.variance >= 0.0)) {
      throw Error(ErrorCode::invalid_argument,
                  Problem{.code = ProblemCode::response_point_unusable, .evidence = {{"frequency", point.frequency}}});
    }
  }
  if (response.points.size() <= parameters) {
    throw Error(ErrorCode::invalid_argument,
                Problem{.code = ProblemCode::too_few_points_to_fit,
                        .evidence = {counted("points", response.points.size()), counted("parameters", parameters)}});
  }
}

void check_free(const DeviceParameters& parameters, const std::string& key) {
  const std::vector<std::string> keys = parameter_keys(parameters);
  if (std::ranges::find(keys, key) == keys.end()) {
    throw Error(ErrorCode::invalid_argument,
                Problem{.code = ProblemCode::no_number_of_structure, .subjects = {{"key", key}}});
  }
  if (row_of(key)->reach != KeyReach::response) {
    throw Error(ErrorCode::invalid_argument, Problem{.code = ProblemCode::not_in_response, .subjects = {{"key", key}}});
  }
}

}  // namespace

Coordinate::Kind Coordinate::kind_of(std::string_view key) {
  return may_vanish(*row_of(key)) ? Kind::not_negative : Kind::logarithmic;
}

double Coordinate::value(double x) const {
  constexpr double least = 1e-30;  // that a device may have
  if (kind == Kind::not_negative && x == 0.0) return 0.0;
  return std::clamp(kind == Kind::logarithmic ? unit * std::exp(x) : unit * x, least, 1.0 / least);
}

double Coordinate::position(double value) const {
  return kind == Kind::logarithmic ? std::log(std::max(value, 1e-12 * unit) / unit) : value / unit;
}

double Coordinate::slope(double x) const { return kind == Kind::logarithmic ? value(x) : unit; }

FitModel::FitModel(const Device& structure, const FrequencyResponse& response, const std::vector<std::string>& free,
                   const std::vector<std::string>& locked)
    : structure_(structure), sampling_period_(response.sampling_period) {
  if (!structure.has_bodies()) {
    throw Error(ErrorCode::invalid_argument, Problem{.code = ProblemCode::fit_needs_bodies});
  }
  for (const std::string& name : locked) locked_.push_back(structure.body_index(name));
  (void)locked_device(structure, locked_);  // refuses what cannot be locked
  check_response(response, free.size());
  std::set<std::string> seen;
  for (const std::string& given : free) {
    const std::string key = full_parameter_key(structure.parameters(), given);
    check_free(structure.parameters(), key);
    if (!seen.insert(key).second) {
      throw Error(ErrorCode::invalid_argument, Problem{.code = ProblemCode::given_twice, .subjects = {{"name", key}}});
    }
    Coordinate coordinate{key, Coordinate::kind_of(key), unit_of(measure_of(key), response.points)};
    if (key == key_of_delay) {
      const double longest = max_delay_samples * sampling_period_.value_or(std::numeric_limits<double>::infinity());
      coordinate.bound = std::min(longest_resolved_delay(response.points), longest) / coordinate.unit;
    }
    coordinates_.push_back(std::move(coordinate));
  }
}

Eigen::VectorXd FitModel::position_of(const DeviceParameters& parameters) const {
  Eigen::VectorXd x(static_cast<Eigen::Index>(coordinates_.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Coordinate& coordinate = coordinates_[static_cast<std::size_t>(i)];
    x(i) = coordinate.position(*parameter(parameters, coordinate.key));
  }
  return x;
}

DeviceParameters FitModel::parameters_at(const Eigen::VectorXd& x) const {
  DeviceParameters parameters = structure_.parameters();
  parameters.uncertainty.reset();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Coordinate& coordinate = coordinates_[static_cast<std::size_t>(i)];
    set_parameter(parameters, coordinate.key, coordinate.value(x(i)));
  }
  return parameters;
}

Device FitModel::as_measured(DeviceParameters parameters) const {
  if (sampling_period_) parameters.loop.sampling_period = *sampling_period_;
  parameters.wall.filters.clear();  // no wall acted; and at the record's rate they may be impossible
  for (Body& body : parameters.bodies) body.coulomb = 0.0;  // does not show in a response
  return locked_device(Device(std::move(parameters)), locked_);
}

Eigen::VectorXcd FitModel::response_of(const Device& device, const std::vector<double>& frequencies) const {
  Eigen::VectorXcd values(static_cast<Eigen::Index>(frequencies.size()));
  if (sampling_period_) {
    const SampledPlant plant = sampled_plant(device);
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      values(static_cast<Eigen::Index>(i)) = response(plant, frequencies[i]);
    }
  } else {  // G(jw) e^{-jw t_d}
    const ModalForm form = modal_form(device);
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      values(static_cast<Eigen::Index>(i)) =
          response(form, frequencies[i]) * std::polar(1.0, -frequencies[i] * device.loop().delay);
    }
  }
  return values;
}

Eigen::VectorXcd FitModel::response_at(const Eigen::VectorXd& x, const std::vector<double>& frequencies) const {
  return response_of(as_measured(parameters_at(x)), frequencies);
}

ResponseWithSlopes FitModel::slopes_at(const Eigen::VectorXd& x, const std::vector<double>& frequencies) const {
  const DeviceParameters parameters = parameters_at(x);
  const Device device = as_measured(parameters);
  ResponseWithSlopes result{response_of(device, frequencies), {}};
  std::vector<ResponseChange> changes;
  for (const Coordinate& each : coordinates_) {
    const bool is_lag = each.key == key_of_lag;
    if (each.key == key_of_delay || (is_lag && device.parameters().actuator.time_constant == 0.0)) {
      changes.push_back({{}, 1.0});  // a short lag is a short delay
    } else {
      changes.push_back(
          {motion_slope(parameters, each, [&](const DeviceParameters& moved) { return as_measured(moved); })});
    }
  }
  std::optional<Eigen::MatrixXcd> slopes =
      response_slopes(device, sampling_period_, changes, frequencies, result.values);
  if (!slopes) {
    result.slopes = differences_at(x, frequencies, result.values);
    return result;
  }
  for (Eigen::Index i = 0; i < x.size(); ++i) slopes->col(i) *= coordinates_[static_cast<std::size_t>(i)].slope(x(i));
  result.slopes = std::move(*slopes);
  return result;
}

Eigen::MatrixXcd FitModel::differences_at(const Eigen::VectorXd& x, const std::vector<double>& frequencies,
                                          const Eigen::VectorXcd& values) const {
  Eigen::MatrixXcd slopes(values.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto shifted = [&](double by) {
      Eigen::VectorXd moved = x;
      moved(i) += by;
      return response_at(moved, frequencies);
    };
    constexpr double h = difference_step;
    const bool at_bound = coordinates_[static_cast<std::size_t>(i)].kind == Coordinate::Kind::not_negative && x(i) < h;
    if (at_bound) {
      slopes.col(i) = (4.0 * shifted(h) - 3.0 * values - shifted(2.0 * h)) / (2.0 * h);
    } else {
      slopes.col(i) = (shifted(h) - shifted(-h)) / (2.0 * h);
    }
  }
  return slopes;
}

}  // namespace zwidth::internal

#include "identification/evidence/response_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "identification/evidence/difference_slopes.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {
namespace {

constexpr double least_model_deviation = 1e-4;  // no device is a model of bodies to better than this
constexpr double first_model_deviation = 0.03;
constexpr double huber_threshold = 4.0;

/// Of a line, with everything relative to |H|.
struct LineCost {
  double deviation = 0.0;  ///< s
  double share = 0.0;      ///< of e^2 in s^2
  double weight = 1.0;     ///< Huber's
  double squares = 0.0;    ///< u^2
  [[nodiscard]] double value() const {
    const double u = std::sqrt(squares);
    const double loss = u <= huber_threshold ? 0.5 * squares : huber_threshold * (u - 0.5 * huber_threshold);
    return loss + 2.0 * std::log(deviation);
  }
};

LineCost line_cost(const ResponsePoint& point, double re, double im, double log_deviation) {
  const double of_model = std::exp(2.0 * log_deviation);
  const double variance = 0.5 * point.variance / std::norm(point.value) + of_model;
  LineCost line{std::sqrt(variance), of_model / variance, 1.0, (re * re + im * im) / variance};
  if (line.squares > huber_threshold * huber_threshold) line.weight = huber_threshold / std::sqrt(line.squares);
  return line;
}

}  // namespace

ResponseEvidence::ResponseEvidence(const DeviceFamily& family, FrequencyResponse response)
    : family_(family), response_(std::move(response)) {}

Eigen::VectorXd ResponseEvidence::own_lowest() const {
  return Eigen::VectorXd::Constant(1, std::log(least_model_deviation));
}

Eigen::VectorXd ResponseEvidence::own_start(const Eigen::VectorXd& /*x*/) const {
  return Eigen::VectorXd::Constant(1, std::log(first_model_deviation));
}

std::optional<Eigen::VectorXd> ResponseEvidence::relative_errors(const Eigen::VectorXd& x) const try {
  DeviceParameters values = family_.recorded_device(x).parameters();
  const double delay = family_.played_delay(x);
  if (response_.sampling_period) {
    values.loop.sampling_period = *response_.sampling_period;
    values.loop.delay = std::max(0.0, delay);
  }
  values.wall.filters.clear();
  for (Body& body : values.bodies) body.coulomb = 0.0;
  const double by_phase = response_.sampling_period ? std::min(0.0, delay) : delay;  // a lead is no delay of a device
  const Device device(std::move(values));
  const std::optional<SampledPlant> sampled =
      response_.sampling_period ? std::optional(sampled_plant(device)) : std::nullopt;
  const std::optional<ModalForm> continuous = sampled ? std::nullopt : std::optional(modal_form(device));
  const auto count = static_cast<Eigen::Index>(response_.points.size());
  Eigen::VectorXd errors(2 * count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const ResponsePoint& point = response_.points[static_cast<std::size_t>(k)];
    const std::complex<double> model =
        (sampled ? response(*sampled, point.frequency) : response(*continuous, point.frequency)) *
        std::polar(1.0, -point.frequency * by_phase);
    const std::complex<double> error = (model - point.value) / std::abs(point.value);
    errors(k) = error.real();
    errors(count + k) = error.imag();
  }
  if (!errors.allFinite()) return std::nullopt;
  return errors;
} catch (const Error&) {
  return std::nullopt;
}

std::optional<double> ResponseEvidence::cost(const Eigen::VectorXd& x, const Eigen::VectorXd& own) const {
  const auto errors = relative_errors(x);
  if (!errors) return std::nullopt;
  const Eigen::Index count = errors->size() / 2;
  double sum = 0.0;
  for (Eigen::Index k = 0; k < count; ++k) {
    sum += line_cost(response_.points[static_cast<std::size_t>(k)], (*errors)(k), (*errors)(count + k), own(0)).value();
  }
  return sum;
}

bool ResponseEvidence::add_picture(const Eigen::VectorXd& x, const Eigen::VectorXd& own, Eigen::Index at,
                                   Picture& sum) const {
  const auto errors = relative_errors(x);
  if (!errors) return false;
  const auto slopes =
      difference_slopes(family_, x, *errors, [&](const Eigen::VectorXd& moved) { return relative_errors(moved); });
  if (!slopes) return false;
  const Eigen::Index count = errors->size() / 2;
  Eigen::VectorXd weights(errors->size());
  for (Eigen::Index k = 0; k < count; ++k) {
    const LineCost line =
        line_cost(response_.points[static_cast<std::size_t>(k)], (*errors)(k), (*errors)(count + k), own(0));
    weights(k) = weights(count + k) = line.weight / (line.deviation * line.deviation);
    sum.cost += line.value();
    sum.gradient(at) += line.share * (2.0 - line.weight * line.squares);
    sum.hessian(at, at) += 4.0 * line.share * line.share;
  }
  const Eigen::MatrixXd weighted = weights.asDiagonal() * *slopes;
  sum.gradient.head(x.size()) += weighted.transpose() * *errors;
  sum.hessian.topLeftCorner(x.size(), x.size()) += slopes->transpose() * weighted;
  return true;
}

}  // namespace zwidth::internal

#include "identification/nonlinearity_test.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "identification/encoder_step.hpp"
#include "identification/shot_fit.hpp"
#include "identification/time_domain_start.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t least_examined = 512;
constexpr std::size_t most_examined = std::size_t{1} << 16U;
constexpr std::size_t error_terms = 24;
// Of chi-squared, and of the squares that are left.
constexpr double clear_evidence = 40.0;
constexpr double notable_share = 0.01;

using Signal = std::vector<double>;

class PredictionErrors {
 public:
  explicit PredictionErrors(const NonlinearityQuestion& question)
      : size_(std::min(question.residuals.size(), most_examined)),
        position_(question.position.begin(), question.position.begin() + static_cast<std::ptrdiff_t>(size_)),
        force_(question.force.begin(), question.force.begin() + static_cast<std::ptrdiff_t>(size_)),
        from_force_(discrete(question.device)),
        at_sensed_(discrete(pushed_where_sensed(question.device))) {
    for (const Shot& each : question.shots) {
      if (each.first + least_examined > size_) break;
      shots_.push_back({0, each.first, std::min(each.count, size_ - each.first)});
    }
    if (shots_.empty()) shots_.push_back({0, 0, size_});
    const std::span<const double> residuals = question.residuals.first(size_);
    noise_ = shot_noise(shots_, parts(residuals), {encoder_step(position_)}, error_terms).front();
    left_ = errors_of(residuals);
    take_out_linear_terms();
  }

  [[nodiscard]] const Signal& position() const { return position_; }
  [[nodiscard]] const Signal& force() const { return force_; }
  [[nodiscard]] double squares() const { return left_.squaredNorm(); }

  /// Effect of a force at the sensed body, or beside the commanded one, on the prediction error.
  [[nodiscard]] Eigen::VectorXd of_push(const Signal& force) const { return errors_of(at_sensed_, force); }
  [[nodiscard]] Eigen::VectorXd of_command(const Signal& force) const { return errors_of(from_force_, force); }

  /// Squares that these columns explain beyond the linear terms.
  [[nodiscard]] double explained_by(Eigen::MatrixXd columns) const {
    const Eigen::VectorXd before = columns.colwise().norm();
    columns -= linear_ * (linear_.transpose() * columns).eval();
    constexpr double own = 1e-4;  // what is less is a linear term but for rounding
    for (Eigen::Index j = 0; j < columns.cols(); ++j) {
      const double norm = columns.col(j).norm();
      columns.col(j) *= norm > own * before(j) ? 1.0 / norm : 0.0;
    }
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
    qr.setThreshold(own);
    return (qr.householderQ().adjoint() * left_).head(qr.rank()).squaredNorm();
  }

 private:
  static DiscreteStateSpace discrete(const Device& device) {
    return sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
  }

  static Device pushed_where_sensed(const Device& device) {
    DeviceParameters parameters = device.parameters();
    parameters.loop.actuated = parameters.loop.sensed;
    parameters.loop.delay = 0.0;
    parameters.actuator.time_constant = 0.0;
    return Device(std::move(parameters));
  }

  [[nodiscard]] Eigen::VectorXd errors_of(const DiscreteStateSpace& system, const Signal& force) const {
    return errors_of(forced_response(system, force));
  }

  [[nodiscard]] ShotPositions parts(std::span<const double> signal) const {
    ShotPositions found;
    for (const Shot& each : shots_) {
      found.emplace_back(
          Eigen::Map<const Eigen::VectorXd>(signal.data() + each.first, static_cast<Eigen::Index>(each.count)));
    }
    return found;
  }

  [[nodiscard]] Eigen::VectorXd errors_of(std::span<const double> signal) const {
    Eigen::VectorXd all(static_cast<Eigen::Index>(size_));
    Eigen::Index count = 0;
    for (const Eigen::VectorXd& each : parts(signal)) {
      const Eigen::MatrixXd errors = whitened(noise_, each);
      all.segment(count, errors.rows()) = errors;
      count += errors.rows();
    }
    return all.head(count);
  }

  void take_out_linear_terms() {
    std::vector<Eigen::VectorXd> terms;
    constexpr int latest = 32;
    for (const int late : {-1, 0, 1, 2, 4, 8, 16, latest}) {
      Signal shifted(size_, 0.0);
      for (std::size_t k = latest; k + 1 < size_; ++k)
        shifted[k] = force_[static_cast<std::size_t>(static_cast<int>(k) - late)];
      terms.push_back(of_command(shifted));
    }
    constexpr std::size_t span = 4;  // samples, over which a velocity is taken
    Signal velocity(size_, 0.0);
    Signal acceleration(size_, 0.0);
    Signal direction(size_, 0.0);
    for (std::size_t k = span; k < size_; ++k) {
      velocity[k] = position_[k] - position_[k - span];
      acceleration[k] = velocity[k] - velocity[k - span];
      direction[k] = velocity[k] > 0.0 ? 1.0 : velocity[k] < 0.0 ? -1.0 : 0.0;
    }
    for (const Signal& each : {position_, velocity, acceleration, direction, Signal(size_, 1.0)})
      terms.push_back(of_push(each));
    Eigen::MatrixXd columns(left_.size(), static_cast<Eigen::Index>(terms.size()));
    for (std::size_t j = 0; j < terms.size(); ++j) {
      columns.col(static_cast<Eigen::Index>(j)) = terms[j] / std::max(terms[j].norm(), 1e-300);
    }
    linear_ = Eigen::HouseholderQR<Eigen::MatrixXd>(columns).householderQ() *
              Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
    left_ -= linear_ * (linear_.transpose() * left_).eval();
  }

  std::size_t size_;
  Signal position_;
  Signal force_;
  DiscreteStateSpace from_force_;
  DiscreteStateSpace at_sensed_;
  std::vector<Shot> shots_;
  ShotNoise noise_;
  Eigen::VectorXd left_;    ///< prediction errors in their deviation, linear terms taken out
  Eigen::MatrixXd linear_;  ///< orthonormal
};

template <class Function>
Signal mapped(const Signal& signal, Function function) {
  Signal result(signal.size());
  std::ranges::transform(signal, result.begin(), function);
  return result;
}

template <std::size_t count>
Eigen::MatrixXd side_by_side(const Eigen::VectorXd (&columns)[count]) {
  Eigen::MatrixXd result(columns[0].size(), static_cast<Eigen::Index>(count));
  for (std::size_t j = 0; j < count; ++j) result.col(static_cast<Eigen::Index>(j)) = columns[j];
  return result;
}

}  // namespace

std::optional<Nonlinearity> find_nonlinearity(const NonlinearityQuestion& question) {
  if (question.residuals.size() < least_examined) return std::nullopt;
  const auto extremes = std::ranges::minmax(question.position);
  const double least = extremes.min;  // no structured binding: the closures below capture it
  const double most = extremes.max;
  const double range = most - least;
  const double middle = 0.5 * (most + least);
  const double largest = std::ranges::max(question.force, {}, [](double each) { return std::abs(each); });
  constexpr double nothing = 1e-9;  // of the range: rounding
  const double left = std::ranges::max(question.residuals, {}, [](double each) { return std::abs(each); });
  if (!(std::abs(left) > nothing * range) || !(std::abs(largest) > 0.0)) return std::nullopt;
  const PredictionErrors errors(question);

  std::optional<Nonlinearity> found;
  const auto keep = [&](double explained, double terms, std::string what, std::string remedy) {
    // Prediction errors are counted in their deviation, which an encoder's rounding bounds from below.
    const double evidence = explained - terms;
    const double share = explained / errors.squares();
    if (!(evidence > clear_evidence && share > notable_share) || (found && found->evidence >= evidence)) return;
    found = Nonlinearity{std::move(what), std::move(remedy), evidence, share};
  };

  keep(errors.explained_by(side_by_side(
           {errors.of_push(mapped(errors.position(), [&](double x) { return std::pow((x - middle) / range, 2); })),
            errors.of_push(mapped(errors.position(), [&](double x) { return std::pow((x - middle) / range, 3); }))})),
       2.0,
       "a force that changes with the position, but not in proportion to it: a spring that stiffens, gravity on a "
       "lever, or a stop",
       "record smaller motion, about the place that matters");

  const auto beyond = [&](double share) {
    const double bound = share * std::abs(largest);
    return errors.of_command(
        mapped(errors.force(), [&](double u) { return std::copysign(std::max(0.0, std::abs(u) - bound), u); }));
  };
  keep(errors.explained_by(side_by_side({beyond(0.25), beyond(0.5), beyond(0.75)})), 3.0,
       "a force that is not in proportion to the recorded one: an amplifier that saturates, or a torque that falls at "
       "large currents",
       "record the force that acts, or excite less strongly");

  constexpr int most_waves = 100;
  constexpr double least_steps = 20.0;  // of an encoder, per wave: less is its rounding
  const double step = encoder_step(errors.position());
  for (int waves = 1; waves <= most_waves && range > least_steps * step * waves; ++waves) {
    const double wave_number = 2.0 * std::numbers::pi * waves / range;
    keep(errors.explained_by(side_by_side(
             {errors.of_push(mapped(errors.position(), [&](double x) { return std::cos(wave_number * (x - least)); })),
              errors.of_push(
                  mapped(errors.position(), [&](double x) { return std::sin(wave_number * (x - least)); }))})),
         2.0,
         fmt::format(
             "a force that comes and goes with the position, about every {:.2g} {}: cogging, gear teeth, or a bearing",
             range / waves, question.device.parameters().motion == Motion::rotary ? "rad" : "m"),
         "compensate it, or excite more strongly: its share falls with the amplitude");
  }
  return found;
}

}  // namespace zwidth::internal

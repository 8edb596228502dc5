#include "identification/nonlinearity_test.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include "identification/response/encoder_step.hpp"
#include "identification/motion_residuals.hpp"
#include "identification/shot_fit.hpp"
#include "identification/time_domain_start.hpp"
#include "linear_systems.hpp"
#include "signal/fourier.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t least_examined = 512;
constexpr std::size_t most_examined = std::size_t{1} << 16U;
constexpr std::size_t error_terms = 24;

using Signal = std::vector<double>;

class PredictionErrors {
 public:
  explicit PredictionErrors(const NonlinearityQuestion& question)
      : size_(std::min(question.residuals.size(), most_examined)),
        position_(question.position.begin(), question.position.begin() + static_cast<std::ptrdiff_t>(size_)),
        force_(question.force.begin(), question.force.begin() + static_cast<std::ptrdiff_t>(size_)),
        from_force_(discrete(question.device)),
        at_sensed_(discrete(pushed_at(question.device, question.device.loop().sensed))) {
    for (const Shot& each : question.shots) {
      if (each.first + least_examined > size_) break;
      shots_.push_back({0, each.first, std::min(each.count, size_ - each.first)});
    }
    if (shots_.empty()) shots_.push_back({0, 0, size_});
    const std::span<const double> residuals = question.residuals.first(size_);
    noise_ = shot_noise(shots_, parts(residuals), {encoder_step(position_)}, error_terms).front();
    left_ = errors_of(residuals);
    take_out_linear_terms(pushed_at(question.device, question.device.loop().sensed));
  }

  [[nodiscard]] const Signal& position() const { return position_; }
  [[nodiscard]] const Signal& force() const { return force_; }

  /// What this force explains beyond the linear terms.
  [[nodiscard]] NonlinearEvidence of(const NonlinearForce& force) const {
    Eigen::MatrixXd columns(left_.size(), static_cast<Eigen::Index>(force.terms.size()));
    for (std::size_t j = 0; j < force.terms.size(); ++j) {
      columns.col(static_cast<Eigen::Index>(j)) =
          errors_of(force.is_of_command ? from_force_ : at_sensed_, force.terms[j]);
    }
    const Eigen::MatrixXd basis = outside_linear_terms(std::move(columns), linear_);
    const Eigen::VectorXd effects = basis.transpose() * left_;
    const auto freedom = static_cast<double>(force.terms.size());
    NonlinearEvidence evidence{effects.squaredNorm() - freedom, effects.squaredNorm() / left_.squaredNorm()};
    if (!(evidence.chi_squared > 0.0)) return evidence;
    const Eigen::VectorXd scaled = solve(covariance(basis, left_ - basis * effects), effects);
    evidence.chi_squared = effects.dot(scaled) - freedom;
    return evidence;
  }

 private:
  /// Covariance of basis^T e where e has the spectrum of these errors, smoothed, where that is above white noise's: what
  /// drifts more slowly than the autoregression sees is no evidence.
  [[nodiscard]] static Eigen::MatrixXd covariance(const Eigen::MatrixXd& basis, const Eigen::VectorXd& errors) {
    const std::size_t length = fast_length(static_cast<std::size_t>(errors.size()));
    const auto lines_of = [&](const Eigen::VectorXd& signal) {
      Signal padded(length, 0.0);
      std::copy(signal.begin(), signal.end(), padded.begin());
      return spectrum(padded);
    };
    const auto lines = lines_of(errors);
    std::vector<double> sums(lines.size() + 1, 0.0);
    for (std::size_t k = 0; k < lines.size(); ++k) sums[k + 1] = sums[k] + std::norm(lines[k]);
    const auto density = [&](std::size_t k) {
      constexpr std::size_t least_reach = 4;
      const std::size_t reach = std::max(least_reach, k / 4);
      const std::size_t begin = k - std::min(k, reach);
      const std::size_t end = std::min(lines.size(), k + reach + 1);
      return std::max(
          1.0, (sums[end] - sums[begin]) / (static_cast<double>(end - begin) * static_cast<double>(errors.size())));
    };
    std::vector<std::vector<std::complex<double>>> columns;
    for (const auto& column : basis.colwise()) columns.push_back(lines_of(column));
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(basis.cols(), basis.cols());
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const double both_sides = k == 0 || 2 * k == length ? 1.0 : 2.0;
      const double weight = both_sides * density(k) / static_cast<double>(length);
      for (Eigen::Index i = 0; i < basis.cols(); ++i) {
        for (Eigen::Index j = 0; j < basis.cols(); ++j) {
          result(i, j) += weight * std::real(columns[static_cast<std::size_t>(i)][k] *
                                             std::conj(columns[static_cast<std::size_t>(j)][k]));
        }
      }
    }
    return result;
  }

  static DiscreteStateSpace discrete(const Device& device) {
    return sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
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

  void take_out_linear_terms(const Device& device) {
    std::vector<Eigen::VectorXd> terms;
    constexpr int latest = 32;
    for (const int late : {-1, 0, 1, 2, 4, 8, 16, latest}) {
      Signal shifted(size_, 0.0);
      for (std::size_t k = latest; k + 1 < size_; ++k)
        shifted[k] = force_[static_cast<std::size_t>(static_cast<int>(k) - late)];
      terms.push_back(errors_of(from_force_, shifted));
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
      terms.push_back(errors_of(at_sensed_, each));
    for (const Signal& each : free_motions(device, size_)) terms.push_back(errors_of(each));
    Eigen::MatrixXd columns(left_.size(), static_cast<Eigen::Index>(terms.size()));
    for (std::size_t j = 0; j < terms.size(); ++j) {
      columns.col(static_cast<Eigen::Index>(j)) = terms[j] / std::max(terms[j].norm(), 1e-300);
    }
    linear_ = orthonormal_basis(columns, 1e-12);
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

}  // namespace

std::optional<Nonlinearity> find_nonlinearity(const NonlinearityQuestion& question) {
  if (question.residuals.size() < least_examined) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(question.position);
  constexpr double nothing = 1e-9;  // of the range: rounding
  const double left = std::ranges::max(question.residuals, {}, [](double each) { return std::abs(each); });
  if (!(std::abs(left) > nothing * (most - least))) return std::nullopt;
  const PredictionErrors errors(question);
  return clearest_nonlinearity(errors.position(), errors.force(), question.device.parameters().motion,
                               [&](const NonlinearForce& force) { return errors.of(force); });
}

}  // namespace zwidth::internal

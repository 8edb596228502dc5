#include "identification/initial_fit/response_slopes.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <utility>

#include "identification/initial_fit/motion_slope.hpp"
#include "model/balance.hpp"
#include "sampling/matrix_exponential.hpp"
#include "sampling/sampling_instants.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

/// F, and g = early + late z^-1; or how they change with a parameter.
struct Dynamics {
  Eigen::MatrixXd f;
  Eigen::VectorXd early;
  Eigen::VectorXd late;
};

/// M = [A B; 0 0] of the device, in coordinates whose rows and columns balance.
class ChangingDynamics {
 public:
  ChangingDynamics(const Device& device, const std::vector<ResponseChange>& changes) {
    const Eigen::MatrixXd motion = motion_matrix(device);
    n_ = motion.rows() - 1;
    scales_ = balancing_scales(motion);
    generator_ = balanced(motion);
    for (const ResponseChange& each : changes) {
      slopes_.push_back(each.matrix.size() > 0 ? balanced(each.matrix) : Eigen::MatrixXd::Zero(n_ + 1, n_ + 1));
      delays_.push_back(each.delay);
    }
    output_ = Eigen::VectorXd::Zero(n_);
    const auto sensed = static_cast<Index>(device.loop().sensed);
    output_(0) = scales_(0);  // q_sensed = q_0 + (q_sensed - q_0)
    if (sensed > 0) output_(sensed) = scales_(sensed);
    output_ /= scales_(n_);
  }

  [[nodiscard]] const Eigen::VectorXd& output() const { return output_; }

  /// The dynamics first, then how each parameter changes them; all but what a delay does where nothing is sampled.
  [[nodiscard]] std::vector<Dynamics> continuous() const {
    std::vector<Dynamics> all = {of_continuous(generator_)};
    for (const Eigen::MatrixXd& slope : slopes_) all.push_back(of_continuous(slope));
    return all;
  }

  [[nodiscard]] std::vector<Dynamics> sampled(const SamplingInstants& instants) const {
    const auto [whole, whole_slopes] = exponential(instants.with_new + instants.with_old);
    const bool is_fractional = instants.with_old > 0.0;
    const auto [first, first_slopes] =
        is_fractional ? exponential(instants.with_new) : ExponentialWithDerivatives{whole, whole_slopes};
    std::vector<Dynamics> all = {of_sampled(whole, first)};
    // u[k - l] acts for so much less: e^{At} B = B + A Gamma(t)
    const Eigen::VectorXd late = input(generator_) + generator_.topLeftCorner(n_, n_) * input(first);
    for (std::size_t i = 0; i < slopes_.size(); ++i) {
      all.push_back(of_sampled(whole_slopes[i], first_slopes[i]));
      all.back().early -= delays_[i] * late;
      all.back().late += delays_[i] * late;
    }
    return all;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd balanced(const Eigen::MatrixXd& matrix) const {
    return scales_.cwiseInverse().asDiagonal() * matrix * scales_.asDiagonal();
  }
  [[nodiscard]] Eigen::VectorXd input(const Eigen::MatrixXd& matrix) const { return matrix.topRightCorner(n_, 1); }
  [[nodiscard]] ExponentialWithDerivatives exponential(double time) const {
    std::vector<Eigen::MatrixXd> slopes;
    slopes.reserve(slopes_.size());
    for (const Eigen::MatrixXd& each : slopes_) slopes.emplace_back(time * each);
    return exponential_with_derivatives(time * generator_, slopes);
  }
  [[nodiscard]] Dynamics of_continuous(const Eigen::MatrixXd& matrix) const {
    return {matrix.topLeftCorner(n_, n_), input(matrix), Eigen::VectorXd::Zero(n_)};
  }
  [[nodiscard]] Dynamics of_sampled(const Eigen::MatrixXd& whole, const Eigen::MatrixXd& first) const {
    return {whole.topLeftCorner(n_, n_), input(first), input(whole) - input(first)};
  }

  Index n_ = 0;  // states, without the commanded force
  Eigen::VectorXd scales_;
  Eigen::MatrixXd generator_;
  std::vector<Eigen::MatrixXd> slopes_;
  std::vector<double> delays_;
  Eigen::VectorXd output_;
};

/// sigma, z^-1 and e of one frequency.
struct AtFrequency {
  Complex sigma;
  Complex back;
  Complex turn;
};

}  // namespace

std::optional<Eigen::MatrixXcd> response_slopes(const Device& device, std::optional<double> period,
                                                const std::vector<ResponseChange>& changes,
                                                const std::vector<double>& frequencies,
                                                const Eigen::VectorXcd& values) {
  const ChangingDynamics changing(device, changes);
  const double delay = device.loop().delay;
  const SamplingInstants instants = period ? sampling_instants({*period, delay}) : SamplingInstants{};
  const std::vector<Dynamics> dynamics = period ? changing.sampled(instants) : changing.continuous();
  const Dynamics& own = dynamics.front();
  if (!own.f.allFinite() || !own.early.allFinite() || !own.late.allFinite()) return std::nullopt;

  // F = U S U^H; all else in the coordinates of U
  const Eigen::ComplexSchur<Eigen::MatrixXd> schur(own.f);
  if (schur.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXcd& u = schur.matrixU();
  const Eigen::MatrixXcd& s = schur.matrixT();
  const Index n = s.rows();
  const auto count = static_cast<Index>(changes.size());
  const Eigen::VectorXcd output = u.transpose() * changing.output();
  const Eigen::VectorXcd early = u.adjoint() * own.early;
  const Eigen::VectorXcd late = u.adjoint() * own.late;
  // A row of a frequency's (y x^T, y, y z^-1), all in one row, times a parameter's column (dF, d early, d late).
  Eigen::MatrixXcd by_parameter(n * n + 2 * n, count);
  for (Index j = 0; j < count; ++j) {
    const Dynamics& change = dynamics[static_cast<std::size_t>(j) + 1];
    const Eigen::MatrixXcd f = u.adjoint() * change.f * u;
    by_parameter.col(j) << f.reshaped(), u.adjoint() * change.early, u.adjoint() * change.late;
  }

  const auto line_at = [&](double frequency) -> AtFrequency {
    if (!period) return {{0.0, frequency}, 0.0, std::polar(1.0, -frequency * delay)};
    const double angle = frequency * *period;
    const double half = std::sin(angle / 2.0);
    return {{-2.0 * half * half, std::sin(angle)},
            std::polar(1.0, -angle),
            std::polar(1.0, -static_cast<double>(instants.whole_samples) * angle)};
  };
  constexpr double agreement = 1e-7;
  const auto lines = static_cast<Index>(frequencies.size());
  Eigen::MatrixXcd by_frequency(lines, n * n + 2 * n);
  Eigen::MatrixXcd shifted = -s;
  Eigen::VectorXcd turns(lines);
  for (Index i = 0; i < lines; ++i) {
    const AtFrequency line = line_at(frequencies[static_cast<std::size_t>(i)]);
    shifted.diagonal() = (line.sigma - s.diagonal().array()).matrix();
    const auto triangle = shifted.triangularView<Eigen::Upper>();
    Eigen::VectorXcd x = early + line.back * late;
    triangle.solveInPlace(x);
    Eigen::VectorXcd y = output;
    shifted.transpose().triangularView<Eigen::Lower>().solveInPlace(y);
    turns(i) = line.turn;
    const Complex value = line.turn * output.cwiseProduct(x).sum();
    if (!(std::abs(value - values(i)) <= agreement * std::abs(values(i)))) return std::nullopt;
    by_frequency.row(i) << (y * x.transpose()).reshaped().transpose(), y.transpose(), line.back * y.transpose();
  }
  Eigen::MatrixXcd slopes = turns.asDiagonal() * (by_frequency * by_parameter);
  if (!period) {
    for (Index j = 0; j < count; ++j) {
      const Complex delayed(0.0, -changes[static_cast<std::size_t>(j)].delay);
      for (Index i = 0; i < lines; ++i) slopes(i, j) += delayed * frequencies[static_cast<std::size_t>(i)] * values(i);
    }
  }
  if (!slopes.allFinite()) return std::nullopt;
  return slopes;
}

}  // namespace zwidth::internal

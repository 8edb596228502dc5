#include "zwidth/sampling/discrete_state_space.hpp"

#include <cmath>

#include "linear_systems.hpp"
#include "model/balance.hpp"
#include "sampling/matrix_exponential.hpp"
#include "sampling/sampling_instants.hpp"

namespace zwidth {
using namespace internal;

DiscreteStateSpace sample(const ContinuousStateSpace& system, Sampling sampling) {
  const SamplingInstants instants = sampling_instants(sampling);
  const Eigen::Index n = system.A.rows();
  Eigen::MatrixXd generator = Eigen::MatrixXd::Zero(n + 1, n + 1);
  generator.topLeftCorner(n, n) = system.A;
  generator.topRightCorner(n, 1) = system.B;
  DiscreteStateSpace sampled;
  sampled.period = sampling.period;
  sampled.C = system.C;
  sampled.delay_samples = instants.whole_samples;
  const Eigen::MatrixXd with_new = exponential_minus_one(generator * instants.with_new);
  sampled.Phi =
      (instants.with_old > 0.0 ? exponential_minus_one(generator * sampling.period) : with_new).topLeftCorner(n, n);
  sampled.Gamma1 = with_new.topRightCorner(n, 1);
  sampled.Gamma2 = Eigen::VectorXd::Zero(n);
  if (instants.with_old > 0.0) {
    // e^{A (1-f) T} int_0^{fT} e^{As} B ds
    const Eigen::VectorXd old = exponential_minus_one(generator * instants.with_old).topRightCorner(n, 1);
    sampled.Gamma2 = old + with_new.topLeftCorner(n, n) * old;
  }
  return sampled;
}

DiscreteStateSpace with_delay_states(const DiscreteStateSpace& system) {
  const bool fractional = !system.Gamma2.isZero(0.0);
  const auto whole = static_cast<Eigen::Index>(system.delay_samples);
  const Eigen::Index held = whole + (fractional ? 1 : 0);
  if (held == 0) return system;
  const Eigen::Index n = system.Phi.rows();
  DiscreteStateSpace full;
  full.period = system.period;
  full.Phi = Eigen::MatrixXd::Zero(n + held, n + held);
  full.Gamma1 = Eigen::VectorXd::Zero(n + held);
  full.Gamma2 = Eigen::VectorXd::Zero(n + held);
  full.C = Eigen::RowVectorXd::Zero(n + held);
  full.C.head(n) = system.C;
  full.Phi.topLeftCorner(n, n) = system.Phi;
  // State n + i holds u[k - 1 - i].
  full.Phi.diagonal().tail(held).setConstant(-1.0);
  full.Gamma1(n) = 1.0;
  for (Eigen::Index i = 1; i < held; ++i) full.Phi(n + i, n + i - 1) = 1.0;
  if (whole == 0) {
    full.Gamma1.head(n) = system.Gamma1;
  } else {
    full.Phi.col(n + whole - 1).head(n) = system.Gamma1;
  }
  if (fractional) full.Phi.col(n + whole).head(n) = system.Gamma2;
  return full;
}

std::complex<double> response(const DiscreteStateSpace& system, double frequency) {
  const double angle = frequency * system.period;
  const double half = std::sin(angle / 2.0);
  const std::complex<double> delta(-2.0 * half * half, std::sin(angle));
  Eigen::MatrixXcd matrix = (-system.Phi).cast<std::complex<double>>();
  matrix.diagonal().array() += delta;
  const Eigen::VectorXcd input = system.Gamma1 + system.Gamma2 * std::polar(1.0, -angle);
  const Eigen::VectorXd scales = balancing_scales(system.Phi);
  const Eigen::MatrixXcd balanced = scales.cwiseInverse().asDiagonal() * matrix * scales.asDiagonal();
  const Eigen::VectorXcd state =
      scales.asDiagonal() * solve_complex(balanced, scales.cwiseInverse().asDiagonal() * input);
  return (system.C * state)(0) * std::polar(1.0, -static_cast<double>(system.delay_samples) * angle);
}

}  // namespace zwidth

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "linear_systems.hpp"
#include "simulation/check_relay.hpp"
#include "staged_progress.hpp"
#include "zwidth/simulation/limit_cycle.hpp"

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;

/// The sign of the force at sample i of a cycle of 2 half samples, i may be negative: + in 0 .. half - 1.
double sign_at(std::ptrdiff_t i, std::ptrdiff_t half) {
  const std::ptrdiff_t halves = i >= 0 ? i / half : -((half - 1 - i) / half);
  return halves % 2 == 0 ? 1.0 : -1.0;
}

/// The cycle from `start`, over one half-period of `half` samples of +d; nothing where the relay would not do that.
std::optional<LimitCycle> cycle_from(const DiscreteStateSpace& system, const Relay& relay, std::size_t half,
                                     const Eigen::VectorXd& start) {
  const auto length = static_cast<std::ptrdiff_t>(half);
  const auto delay = static_cast<std::ptrdiff_t>(system.delay_samples);
  const Eigen::VectorXd newer = system.Gamma1 * relay.amplitude;
  const Eigen::VectorXd older = system.Gamma2 * relay.amplitude;
  Eigen::VectorXd x = start;
  std::complex<double> output = 0.0;
  std::complex<double> force = 0.0;
  double largest = 0.0;
  for (std::ptrdiff_t i = 0; i < length; ++i) {
    const double y = system.C * x;
    if (i == 0 ? !(y < -relay.hysteresis) : !(y <= relay.hysteresis)) return std::nullopt;
    const std::complex<double> turn = std::polar(1.0, -pi * static_cast<double>(i) / static_cast<double>(half));
    output += y * turn;
    force += relay.amplitude * turn;
    largest = std::max(largest, std::abs(y));
    x += system.Phi * x + newer * sign_at(i - delay, length) + older * sign_at(i - delay - 1, length);
  }
  return LimitCycle{pi / (static_cast<double>(half) * system.period), largest, std::abs(force) / std::abs(output)};
}

/// S_j = sum_{i<j} F^i G for j = 0 .. longest, a column each.
class PartialSums {
 public:
  PartialSums(const DiscreteStateSpace& system, const Eigen::VectorXd& gain, std::size_t longest)
      : sums_(gain.size(), static_cast<Eigen::Index>(longest) + 1) {
    sums_.col(0).setZero();
    Eigen::VectorXd term = gain;
    for (Eigen::Index j = 1; j < sums_.cols(); ++j) {
      sums_.col(j) = sums_.col(j - 1) + term;
      term += system.Phi * term;
    }
  }

  /// sum_{i<k} F^{k-1-i} G sign(i - delay): the sign changes once, after r = delay mod k samples, and
  /// F^{k-r} S_r = S_k - S_{k-r}.
  [[nodiscard]] Eigen::VectorXd of_delayed_force(std::size_t half, std::size_t delay) const {
    const auto k = static_cast<Eigen::Index>(half);
    const auto r = static_cast<Eigen::Index>(delay % half);
    const double sign = (delay / half) % 2 == 0 ? 1.0 : -1.0;
    return sign * (2.0 * sums_.col(k - r) - sums_.col(k));
  }

 private:
  Eigen::MatrixXd sums_;
};

}  // namespace

std::vector<LimitCycle> sampled_relay_limit_cycles(const DiscreteStateSpace& system, const Relay& relay,
                                                   std::size_t longest, const Progress& progress) {
  check_relay(relay);
  const Eigen::Index n = system.Phi.rows();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd transition = one + system.Phi;
  const PartialSums newer(system, system.Gamma1, longest);
  const PartialSums older(system, system.Gamma2, longest);
  Eigen::MatrixXd power = one;  // F^k
  std::vector<LimitCycle> cycles;
  for (std::size_t half = 1; half <= longest; ++half) {
    tell(progress, static_cast<double>(half - 1) / static_cast<double>(longest));
    power = transition * power;
    const Eigen::VectorXd forced =
        newer.of_delayed_force(half, system.delay_samples) + older.of_delayed_force(half, system.delay_samples + 1);
    const Eigen::VectorXd start = -solve(one + power, forced * relay.amplitude);
    if (const auto cycle = cycle_from(system, relay, half, start)) cycles.push_back(*cycle);
  }
  std::reverse(cycles.begin(), cycles.end());
  return cycles;
}

std::vector<CycleBand> cycle_bands(const std::vector<LimitCycle>& cycles) {
  constexpr double same_band = 1.1;
  std::vector<CycleBand> bands;
  for (const LimitCycle& cycle : cycles) {
    if (bands.empty() || cycle.frequency > same_band * bands.back().highest.frequency) {
      bands.push_back({0, cycle, cycle});
    }
    ++bands.back().count;
    bands.back().highest = cycle;
  }
  return bands;
}

}  // namespace zwidth

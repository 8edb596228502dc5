#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "linear_systems.hpp"
#include "require_argument.hpp"
#include "simulation/check_relay.hpp"
#include "staged_progress.hpp"
#include "zwidth/simulation/limit_cycle.hpp"

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;
constexpr int half_periods_scanned = 4000;
constexpr int trajectory_points = 2000;
constexpr int peak_bits = 26;  // half of the digits: all that a minimum has

void require(bool holds, ProblemCode otherwise) {
  if (!holds) throw Error(ErrorCode::invalid_argument, {.code = otherwise});
}

/// The state where the force changes from -d to +d, on the cycle x(h) = -x(0): -(I + F)^{-1} Gamma d.
Eigen::VectorXd state_at_switch(const DiscreteStateSpace& half_period, double amplitude) {
  const Eigen::Index n = half_period.Phi.rows();
  const Eigen::MatrixXd sum = 2.0 * Eigen::MatrixXd::Identity(n, n) + half_period.Phi;
  return -solve(sum, half_period.Gamma1 * amplitude);
}

/// The continuous relay's cycle at one half-period.
class HalfPeriod {
 public:
  HalfPeriod(const ContinuousStateSpace& system, const Relay& relay, double length, double delay)
      : system_(system), amplitude_(relay.amplitude), length_(length) {
    start_ = state_at_switch(sample(system, {length, 0.0}), relay.amplitude);
    // The relay switched `delay` before the force did: at length - rest, in a half-period of sign (-1)^(whole + 1).
    const double whole = std::ceil(delay / length);
    const double since = whole * length - delay;  // after the force's change before the switch, in [0, length)
    sign_ = std::fmod(whole, 2.0) == 0.0 ? 1.0 : -1.0;
    output_at_switch_ = sign_ * output(since);
    since_ = since;
  }

  /// Follows y over the half-period; before holds() and cycle().
  void follow() {
    const DiscreteStateSpace part = sample(system_, {length_ / trajectory_points, 0.0});
    Eigen::VectorXd x = start_;
    for (int i = 0; i <= trajectory_points; ++i) {
      outputs_.push_back(system_.C * x);
      x += part.Phi * x + part.Gamma1 * amplitude_;
    }
  }

  /// y where the relay switched to +d.
  [[nodiscard]] double output_at_switch() const { return output_at_switch_; }

  /// Whether y, over the half-period after the switch, stays below +hysteresis: nothing switches back early.
  [[nodiscard]] bool holds(double hysteresis) const {
    const double scale = std::abs(outputs_[largest_at()]);
    for (int i = 1; i < trajectory_points; ++i) {
      // The half-period after the switch is the force's own after `since`, then the next one up to it, mirrored.
      const bool is_mirrored = length_ * i / trajectory_points < since_;
      const double y = (is_mirrored ? -sign_ : sign_) * outputs_[static_cast<std::size_t>(i)];
      if (y > hysteresis + 1e-9 * scale) return false;
    }
    return true;
  }

  [[nodiscard]] LimitCycle cycle() const {
    // First harmonic of y by the trapezoidal rule over the half-period; its ends y(0) and y(h) e^{-j pi} = y(0) are one
    // term.
    std::complex<double> harmonic = 0.0;
    for (int i = 0; i < trajectory_points; ++i) {
      harmonic += outputs_[static_cast<std::size_t>(i)] * std::polar(1.0, -pi * i / trajectory_points);
    }
    const double first = 2.0 * std::abs(harmonic) / trajectory_points;
    return {pi / length_, largest(), 4.0 * amplitude_ / (pi * first)};
  }

 private:
  /// y at `time` after the force's change to +d, within the half-period.
  [[nodiscard]] double output(double time) const {
    if (time <= 0.0) return system_.C * start_;
    const DiscreteStateSpace part = sample(system_, {time, 0.0});
    const Eigen::VectorXd moved = start_ + part.Phi * start_ + part.Gamma1 * amplitude_;
    return system_.C * moved;
  }

  [[nodiscard]] std::size_t largest_at() const {
    const auto by_size = [](double a, double b) { return std::abs(a) < std::abs(b); };
    return static_cast<std::size_t>(std::max_element(outputs_.begin(), outputs_.end(), by_size) - outputs_.begin());
  }

  [[nodiscard]] double largest() const {
    const std::size_t at = largest_at();
    const double part = length_ / trajectory_points;
    const double lower = part * static_cast<double>(at == 0 ? 0 : at - 1);
    const double upper = part * static_cast<double>(std::min<std::size_t>(at + 1, trajectory_points));
    const auto depth = [&](double time) { return -std::abs(output(time)); };
    const auto peak = boost::math::tools::brent_find_minima(depth, lower, upper, peak_bits);
    return std::max(-peak.second, std::abs(outputs_[at]));
  }

  const ContinuousStateSpace& system_;
  double amplitude_;
  double length_;
  double since_ = 0.0;
  double sign_ = 1.0;
  double output_at_switch_ = 0.0;
  Eigen::VectorXd start_;
  std::vector<double> outputs_;  // y at i / trajectory_points of the half-period, both ends included
};

}  // namespace

std::vector<LimitCycle> relay_limit_cycles(const ContinuousStateSpace& system, const Relay& relay, double shortest,
                                           double longest, double delay, const Progress& progress) {
  check_relay(relay);
  require(std::isfinite(longest) && shortest > 0.0 && shortest < longest, ProblemCode::half_periods_not_ordered);
  require_not_negative({"delay", delay, "s"});
  // To +d the relay switches where y falls to -hysteresis.
  const auto excess = [&](double length) {
    return HalfPeriod(system, relay, length, delay).output_at_switch() + relay.hysteresis;
  };
  std::vector<LimitCycle> cycles;
  const double step = std::pow(longest / shortest, 1.0 / half_periods_scanned);
  double lower = shortest;
  double at_lower = excess(lower);
  for (int i = 1; i <= half_periods_scanned; ++i) {
    tell(progress, static_cast<double>(i - 1) / half_periods_scanned);
    const double upper = shortest * std::pow(step, i);
    const double at_upper = excess(upper);
    if ((at_lower < 0.0) != (at_upper < 0.0)) {
      std::uintmax_t iterations = 100;
      const auto [a, b] = boost::math::tools::toms748_solve(excess, lower, upper, at_lower, at_upper,
                                                            boost::math::tools::eps_tolerance<double>(48), iterations);
      HalfPeriod found(system, relay, 0.5 * (a + b), delay);
      // A pole of (I + e^{Ah})^{-1} also changes the sign, without being a root.
      const bool is_root =
          std::abs(found.output_at_switch() + relay.hysteresis) < std::abs(at_lower) + std::abs(at_upper);
      if (!is_root) continue;
      found.follow();
      if (found.holds(relay.hysteresis)) cycles.push_back(found.cycle());
    }
    lower = upper;
    at_lower = at_upper;
  }
  std::reverse(cycles.begin(), cycles.end());
  return cycles;
}

}  // namespace zwidth

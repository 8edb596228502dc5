#include "stability/second_route/scheduled_loop.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "eigenvalues.hpp"
#include "linear_systems.hpp"
#include "model/balance.hpp"
#include "model/rate_ratio.hpp"
#include "stability/second_route/pole_modulus.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth::internal {
namespace {

// A pole this close to the circle, over |z - 1|, may be on either side: its eigenvalue is rounded.
constexpr double rounding_of_pole = 1e-12;
constexpr double rounding_beside_one = 1e-13;

// Rows of forces, each as it depends on the state at the period's beginning: those of this period and of earlier ones.
class Forces {
 public:
  Forces(std::size_t first_state, std::size_t kept, Eigen::Index states)
      : first_state_(first_state), kept_(kept), states_(states) {}

  void add(Eigen::RowVectorXd force) { own_.push_back(std::move(force)); }

  // That of a sample, counted from the period's beginning.
  [[nodiscard]] Eigen::RowVectorXd at(std::ptrdiff_t sample) const {
    if (sample >= 0) return own_[static_cast<std::size_t>(sample)];
    return Eigen::RowVectorXd::Unit(states_, static_cast<Eigen::Index>(first_state_) - 1 - sample);
  }
  // What the next period finds of earlier ones, row by row.
  void write(Eigen::MatrixXd& next) const {
    const auto count = static_cast<std::ptrdiff_t>(own_.size());
    for (std::size_t i = 0; i < kept_; ++i) {
      next.row(static_cast<Eigen::Index>(first_state_ + i)) = at(count - 1 - static_cast<std::ptrdiff_t>(i));
    }
  }

 private:
  std::size_t first_state_;
  std::size_t kept_;
  Eigen::Index states_;
  std::vector<Eigen::RowVectorXd> own_;
};

std::ptrdiff_t floor_quotient(std::ptrdiff_t a, std::size_t b) {
  const auto divisor = static_cast<std::ptrdiff_t>(b);
  return a >= 0 ? a / divisor : -((-a + divisor - 1) / divisor);
}

}  // namespace

ScheduledLoop::ScheduledLoop(const ContinuousStateSpace& device, const Sampling& spring, const InnerLoop& damper) {
  const bool is_damper_fast = damper.sampling.period <= spring.period;
  const auto [shorter, longer] = std::minmax(spring.period, damper.sampling.period);
  ticks_ = periods_within(longer, shorter);
  // The spring's period stands; the other is what it is of that, without its rounding.
  tick_ = is_damper_fast ? spring.period / static_cast<double>(ticks_) : spring.period;
  spring_ = path(device, is_damper_fast ? ticks_ : 1, spring.delay);
  const std::size_t damper_every = is_damper_fast ? 1 : ticks_;
  if (damper.sampling.delay == spring.delay) {
    damper_ = spring_;
    damper_.every = damper_every;
    damper_.kept = (damper_.first_late() + damper_every - 1) / damper_every;
  } else {
    damper_ = path(device, damper_every, damper.sampling.delay);
  }
  damping_ = damper.damping;
  damper_period_ = static_cast<double>(damper_.every) * tick_;
  pole_ = velocity_filter_pole(damper.velocity_filter_hz, damper_period_);
  output_ = device.C;
  states_ = static_cast<std::size_t>(phi_.rows()) + (pole_ > 0.0 ? 2U : 1U) + spring_.kept + damper_.kept;
}

ScheduledLoop::PathSchedule ScheduledLoop::path(const ContinuousStateSpace& device, std::size_t every, double delay) {
  const DiscreteStateSpace sampled = sample(device, {tick_, delay});
  PathSchedule result;
  result.every = every;
  result.whole = sampled.delay_samples;
  result.with_new = sampled.Gamma1;
  if (!sampled.Gamma2.isZero(0.0)) result.with_old = sampled.Gamma2;
  result.kept = (result.first_late() + every - 1) / every;
  phi_ = sampled.Phi;
  return result;
}

ScheduledLoop::Period ScheduledLoop::over_period(std::optional<double> stiffness, double damping) const {
  const double rate = damping / damper_period_;
  const Eigen::Index n = phi_.rows();
  const auto size = static_cast<Eigen::Index>(states_ + (stiffness ? 0U : 1U));
  const auto last_position = n;
  const bool filtered = pole_ > 0.0;
  const std::size_t first_spring = static_cast<std::size_t>(n) + (filtered ? 2U : 1U);
  Forces spring(first_spring, spring_.kept, size);
  Forces damper(first_spring + spring_.kept, damper_.kept, size);

  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(n, size);  // the device's state less that at the beginning
  Eigen::MatrixXd state = Eigen::MatrixXd::Identity(n, size);
  Eigen::RowVectorXd last = Eigen::RowVectorXd::Unit(size, last_position);
  Eigen::RowVectorXd velocity = Eigen::RowVectorXd::Zero(size);  // times T_v
  if (filtered) velocity(n + 1) = 1.0;
  Period result;
  result.positions.resize(static_cast<Eigen::Index>(ticks_), size);
  for (std::size_t tick = 0; tick < ticks_; ++tick) {
    const Eigen::RowVectorXd position = output_ * state;
    result.positions.row(static_cast<Eigen::Index>(tick)) = position;
    if (tick % spring_.every == 0) {
      spring.add(stiffness ? Eigen::RowVectorXd(-*stiffness * position)
                           : Eigen::RowVectorXd(Eigen::RowVectorXd::Unit(size, size - 1)));
    }
    if (tick % damper_.every == 0) {
      velocity = pole_ * velocity + (1.0 - pole_) * (position - last);
      last = position;
      damper.add(-rate * velocity);
    }
    Eigen::MatrixXd change = phi_ * state;
    for (const auto& [path, forces] : {std::pair{&spring_, &spring}, std::pair{&damper_, &damper}}) {
      const auto arriving = static_cast<std::ptrdiff_t>(tick) - static_cast<std::ptrdiff_t>(path->whole);
      change += path->with_new * forces->at(floor_quotient(arriving, path->every));
      if (path->with_old.size() == 0) continue;
      change += path->with_old * forces->at(floor_quotient(arriving - 1, path->every));
    }
    moved += change;
    state += change;
  }
  result.change = Eigen::MatrixXd::Zero(size, size);
  result.change.row(last_position) = last;
  if (filtered) result.change.row(n + 1) = velocity;
  spring.write(result.change);
  damper.write(result.change);
  result.change.diagonal().tail(size - n).array() -= 1.0;
  result.change.topRows(n) = moved;
  return result;
}

std::vector<std::complex<double>> ScheduledLoop::poles_minus_one(double stiffness) const {
  return poles_minus_one(stiffness, damping_);
}

std::vector<std::complex<double>> ScheduledLoop::poles_minus_one(double stiffness, double damping) const {
  const Eigen::MatrixXd change = over_period(stiffness, damping).change;
  const Eigen::VectorXd scales = balancing_scales(change);
  const Eigen::VectorXcd values = eigenvalues(scales.cwiseInverse().asDiagonal() * change * scales.asDiagonal());
  return {values.data(), values.data() + values.size()};
}

DiscreteStateSpace ScheduledLoop::seen_by_spring() const {
  const Period over = over_period(std::nullopt, damping_);
  const auto size = static_cast<Eigen::Index>(states_);
  DiscreteStateSpace seen;
  seen.period = period();
  seen.Phi = over.change.topLeftCorner(size, size);
  seen.Gamma1 = over.change.col(size).head(size);
  seen.Gamma2 = Eigen::VectorXd::Zero(size);
  seen.C = over.positions.row(0).head(size);
  return seen;
}

std::optional<int> ScheduledLoop::unstable_poles(double stiffness) const {
  if (states_ > most_states) return std::nullopt;
  int outside = 0;
  for (const std::complex<double>& delta : poles_minus_one(stiffness)) {
    if (!std::isfinite(std::abs(delta))) return std::nullopt;
    const double excess = modulus_minus_one(delta);
    if (!(std::abs(excess) > std::max(rounding_of_pole * std::abs(delta), rounding_beside_one))) return std::nullopt;
    if (excess > 0.0) ++outside;
  }
  return outside;
}

double ScheduledLoop::frequency_of(std::complex<double> pole_minus_one, double stiffness) const {
  const Period over = over_period(stiffness, damping_);
  const Eigen::VectorXd scales = balancing_scales(over.change);
  Eigen::MatrixXcd shifted =
      (scales.cwiseInverse().asDiagonal() * over.change * scales.asDiagonal()).cast<std::complex<double>>();
  // Just beside the pole, for inverse iteration.
  shifted.diagonal().array() -= pole_minus_one + 1e-9 * std::max(std::abs(pole_minus_one), 1e-6);
  Eigen::VectorXcd motion = Eigen::VectorXcd::Constant(shifted.rows(), 1.0);
  for (int step = 0; step < 3; ++step) motion = solve_complex(shifted, motion).normalized();
  const Eigen::VectorXcd seen = over.positions * (scales.asDiagonal() * motion);
  const double angle = std::arg(1.0 + pole_minus_one);  // of the longer period
  double best = angle;
  double most = -1.0;
  const auto count = static_cast<double>(ticks_);
  for (double turn = -std::floor(0.5 * count); turn <= std::floor(0.5 * count); turn += 1.0) {
    const double total = angle + 2.0 * std::numbers::pi * turn;
    if (std::abs(total) > std::numbers::pi * count * (1.0 + 1e-12)) continue;
    std::complex<double> sum = 0.0;
    for (Eigen::Index tick = 0; tick < seen.size(); ++tick) {
      sum += seen(tick) * std::polar(1.0, -total * static_cast<double>(tick) / count);
    }
    if (std::abs(sum) > most) {
      most = std::abs(sum);
      best = total;
    }
  }
  return std::abs(best) / period();
}

}  // namespace zwidth::internal

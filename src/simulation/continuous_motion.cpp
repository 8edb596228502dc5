#include "simulation/continuous_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "counted.hpp"
#include "simulation/first_root.hpp"
#include "simulation/motion_tangent.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/state_space.hpp"

namespace zwidth::internal {
namespace {

/// |other forces| may exceed F_c by this relative amount before a body counts as broken away: rounding.
constexpr double stiction_tolerance = 1e-12;
/// A term of the series this small beside every component of the state, with |A| h <= 1, ends it.
constexpr double negligible = 1e-20;

int sign_of(double value) noexcept { return value > 0.0 ? 1 : value < 0.0 ? -1 : 0; }

}  // namespace

ContinuousMotion::ContinuousMotion(const Device& device, OutsideForce outside, std::vector<double> recurring_lengths)
    : lengths_(std::move(recurring_lengths)) {
  if (device.has_bodies()) {
    bodies_ = device.bodies().size();
    sensed_ = device.loop().sensed;
    actuated_ = device.loop().actuated;
    size_ = 2 * bodies_;
    lag_ = device.parameters().actuator.time_constant > 0.0 ? size_++ : no_state;
    bandwidth_ = device.parameters().sensor.tracking_bandwidth;
    tracked_ = bandwidth_ > 0.0 ? size_ : no_state;
    if (bandwidth_ > 0.0) size_ += 2;
  } else {
    const ContinuousStateSpace system = state_space(device);
    output_ = system.C.transpose();
    size_ = static_cast<std::size_t>(system.A.rows());
  }
  command_ = size_++;
  outside_ = outside.acts ? size_ : no_state;
  if (outside.acts) size_ += 2;
  for (std::size_t i = 0; i < bodies_; ++i) {
    if (device.bodies()[i].coulomb > 0.0) friction_.push_back({i, device.bodies()[i].coulomb, size_++, {}, 1, false});
  }
  if (friction_.size() > max_friction_bodies) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::too_many_bodies_with_friction,
                                              .evidence = {internal::counted("most", max_friction_bodies),
                                                           internal::counted("bodies", friction_.size())}});
  }
  const auto n = static_cast<Eigen::Index>(size_);
  state_ = Eigen::VectorXd::Zero(n);
  next_ = Eigen::VectorXd::Zero(n);
  sizes_ = Eigen::VectorXd::Zero(n);
  series_ = Eigen::MatrixXd::Zero(n, degree + 1);
  multiply_ = matrix_vector(size_);
  moving_ = outside.acts ? size_ : command_;
  multiply_moving_ = matrix_part_vector(moving_);

  const Eigen::MatrixXd free = matrix_of(device, outside, 0);
  for (FrictionBody& each : friction_) {
    const auto row = static_cast<Eigen::Index>(bodies_ + each.body);
    const double mass = 1.0 / free(row, static_cast<Eigen::Index>(each.force));
    each.other_forces = mass * free.row(row).transpose();
    each.other_forces[static_cast<Eigen::Index>(each.force)] = 0.0;
    each.other_forces[row] = 0.0;  // at rest
  }
  for (unsigned stuck = 0; stuck < 1u << friction_.size(); ++stuck) {
    patterns_.push_back(pattern_of(matrix_of(device, outside, stuck)));
  }
  if (!friction_.empty() && !lengths_.empty()) {
    const double longest = *std::max_element(lengths_.begin(), lengths_.end());
    const double parts = std::log2(std::max(1.0, 2.0 * rate() * longest));
    halvings_ = static_cast<std::size_t>(std::clamp(std::ceil(parts), least_halvings, most_halvings));
  }
  for (unsigned stuck = 0; stuck < 1u << friction_.size(); ++stuck) add_steps(patterns_[stuck], stuck);
  reset();
}

void ContinuousMotion::reset() noexcept {
  state_.setZero();
  events_ = overloaded_ = 0;
  for (FrictionBody& each : friction_) stick(each);
}

void ContinuousMotion::set_outside(double w0, double w1) noexcept {
  if (outside_ == no_state) return;
  state_.data()[outside_] = w0;
  state_.data()[outside_ + 1] = w1;
}

void ContinuousMotion::switch_command(double force) noexcept {
  if (tangent_ != nullptr) tangent_->switch_command(pattern().matrix, command_, command() - force);
  set_command(force);
}

void ContinuousMotion::set_motion(const double* positions, const double* velocities) noexcept {
  for (std::size_t i = 0; i < bodies_; ++i) {
    state_.data()[i] = positions[i] - (i == 0 ? 0.0 : positions[0]);
    state_.data()[bodies_ + i] = velocities[i];
  }
  if (tracked_ != no_state) {  // as after a long motion at that velocity
    state_.data()[tracked_] = positions[sensed_];
    state_.data()[tracked_ + 1] = velocities[sensed_] / bandwidth_;
  }
  for (FrictionBody& each : friction_) {
    const double velocity = this->velocity(each.body);
    if (velocity == 0.0) {
      stick_or_slide(each);
    } else {
      slide(each, sign_of(velocity));
      each.fresh = false;
    }
  }
}

double ContinuousMotion::output() const noexcept { return output_.dot(state_.head(output_.size())); }

double ContinuousMotion::rate() const noexcept {
  double rate = 0.0;
  for (const Pattern& each : patterns_) rate = std::max(rate, each.norm);
  return rate;
}

bool ContinuousMotion::sticks(std::size_t body) const noexcept {
  return std::any_of(friction_.begin(), friction_.end(),
                     [body](const FrictionBody& each) { return each.body == body && each.direction == 0; });
}

void ContinuousMotion::slide(FrictionBody& body, int direction) noexcept {
  const auto index = static_cast<unsigned>(&body - friction_.data());
  body.direction = direction;
  body.fresh = true;
  state_.data()[body.force] = -direction * body.limit;
  stuck_ &= ~(1u << index);
  if (tangent_ != nullptr) tangent_->slide(body.body, body.force, direction);
}

void ContinuousMotion::stick(FrictionBody& body) noexcept {
  const auto index = static_cast<unsigned>(&body - friction_.data());
  body.direction = 0;
  body.fresh = false;
  state_.data()[bodies_ + body.body] = 0.0;
  stuck_ |= 1u << index;
  if (tangent_ != nullptr) tangent_->turn(bodies_ + body.body, 0.0);
}

void ContinuousMotion::stick_or_slide(FrictionBody& body) noexcept {
  state_.data()[bodies_ + body.body] = 0.0;
  const double others = body.other_forces.dot(state_);
  if (std::abs(others) <= body.limit * (1.0 + stiction_tolerance)) {
    stick(body);
  } else {
    slide(body, sign_of(others));
  }
}

void ContinuousMotion::break_away() noexcept {
  for (FrictionBody& each : friction_) {
    if (each.direction != 0) continue;
    stick_or_slide(each);
    if (tangent_ != nullptr && each.direction != 0) tangent_->start(bodies_ + each.body, acceleration(each));
  }
}

double ContinuousMotion::acceleration(const FrictionBody& body) const noexcept {
  return pattern().matrix.row(static_cast<Eigen::Index>(bodies_ + body.body)).dot(state_);
}

bool ContinuousMotion::nothing_happens(const RecurringStep& step) noexcept {
  sizes_ = state_.cwiseAbs();
  for (std::size_t i = 1; i < bodies_; ++i) sizes_.data()[bodies_ + i] = std::abs(velocity(i) - velocity(0));
  for (std::size_t k = 0; k < friction_.size(); ++k) {
    const FrictionBody& each = friction_[k];
    const double bend = step.bend[k].dot(sizes_);
    // A function lies above its chord less h²/8 sup |y''|.
    if (each.direction != 0) {
      const double start = each.direction * state_.data()[bodies_ + each.body];
      const double end = each.direction * next_.data()[bodies_ + each.body];
      if (!(std::min(start, end) > bend)) return false;
    } else {
      const double start = std::abs(each.other_forces.dot(state_));
      const double end = std::abs(each.other_forces.dot(next_));
      if (!(each.limit - std::max(start, end) > bend)) return false;
    }
  }
  return true;
}

void ContinuousMotion::advance_recurring(std::size_t which) noexcept { advance_part(which, 0); }

void ContinuousMotion::advance_part(std::size_t which, std::size_t halvings) noexcept {
  const RecurringStep& step = pattern().steps[which * (halvings_ + 1) + halvings];
  multiply_(step.transition.data(), state_.data(), next_.data(), size_);
  if (friction_.empty() || nothing_happens(step)) {
    if (tangent_ != nullptr) tangent_->step(stuck_, which * (halvings_ + 1) + halvings, state_.data());
    state_.swap(next_);
  } else if (halvings < halvings_) {
    advance_part(which, halvings + 1);
    advance_part(which, halvings + 1);
  } else {
    advance_by_series(std::ldexp(lengths_[which], -static_cast<int>(halvings)), which * (halvings_ + 1) + halvings);
  }
}

void ContinuousMotion::advance(double duration) noexcept { advance_by_series(duration, no_step); }

void ContinuousMotion::expand(double length) noexcept {
  const Pattern& now = pattern();
  std::copy_n(state_.data(), size_, series_.data());
  terms_ = degree + 1;
  for (int k = 1; k <= degree; ++k) {
    double* column = series_.data() + static_cast<std::size_t>(k) * size_;
    // The derivatives of constant states, whose columns of the series stay 0, move nothing.
    multiply_moving_(now.matrix.data(), column - size_, column, moving_, k == 1 ? size_ : moving_, size_);
    const double factor = length / k;
    bool is_negligible = true;
    for (std::size_t i = 0; i < moving_; ++i) {
      column[i] *= factor;
      is_negligible = is_negligible && std::abs(column[i]) <= negligible * std::abs(state_.data()[i]);
    }
    if (!is_negligible) continue;
    terms_ = static_cast<std::size_t>(k);
    return;
  }
}

void ContinuousMotion::evaluate_series(double fraction) noexcept {
  double* x = state_.data();
  for (std::size_t i = 0; i < size_; ++i) x[i] = 0.0;
  for (std::size_t k = terms_; k-- > 0;) {
    const double* column = series_.data() + k * size_;
    for (std::size_t i = 0; i < size_; ++i) x[i] = x[i] * fraction + column[i];
  }
}

double ContinuousMotion::first_event(std::size_t& body) noexcept {
  std::array<double, degree + 1> y{};
  double first = 2.0;
  const auto consider = [&](std::size_t k, std::size_t from) {
    const double found = first_turn_negative(std::span<const double>(y).subspan(from, terms_ - from));
    if (found >= first) return;
    first = found;
    body = k;
  };
  for (std::size_t k = 0; k < friction_.size(); ++k) {
    const FrictionBody& each = friction_[k];
    if (each.direction != 0) {
      for (std::size_t i = 0; i < terms_; ++i) y[i] = each.direction * series_.data()[i * size_ + bodies_ + each.body];
      std::size_t from = 0;
      if (each.fresh) {
        // The velocity starts at exactly 0: look at y/s, and at y/s² where the body only just breaks away.
        const double others = std::abs(each.other_forces.dot(state_));
        from = others <= each.limit * (1.0 + stiction_tolerance) ? 2 : 1;
      }
      consider(k, from);
    } else {
      for (std::size_t i = 0; i < terms_; ++i) {
        y[i] = -each.other_forces.dot(series_.col(static_cast<Eigen::Index>(i)));
      }
      const double others = -y[0];
      const double tolerance = stiction_tolerance * each.limit;
      for (const double direction : {1.0, -1.0}) {  // F_c - others, F_c + others
        y[0] = each.limit - direction * others;
        if (y[0] < 0.0 && y[0] >= -tolerance) y[0] = 0.0;
        consider(k, 0);
        for (double& coefficient : y) coefficient = -coefficient;
      }
    }
  }
  return first;
}

void ContinuousMotion::advance_by_series(double duration, std::size_t whole_step) noexcept {
  break_away();
  double remaining = duration;
  for (int count = 0; remaining > 0.0;) {
    const double longest = 1.0 / pattern().norm;
    const double length = longest < remaining ? longest : remaining;
    expand(length);
    std::size_t body = 0;
    const double fraction = friction_.empty() || count >= max_events ? 2.0 : first_event(body);
    if (tangent_ != nullptr) {
      if (fraction > 1.0 && length == duration && whole_step != no_step) {
        tangent_->step(stuck_, whole_step, state_.data());
      } else {
        tangent_->move(pattern(), stuck_, series_, terms_, length, std::min(fraction, 1.0));
      }
    }
    if (fraction <= 1.0) {
      evaluate_series(fraction);
      for (FrictionBody& each : friction_) each.fresh = each.fresh && fraction == 0.0;
      FrictionBody& met = friction_[body];
      if (met.direction != 0) {
        const double before = acceleration(met);
        stick_or_slide(met);
        if (tangent_ != nullptr && met.direction != 0) {
          tangent_->turn(bodies_ + met.body, before == 0.0 ? 0.0 : acceleration(met) / before);
        }
      } else {
        slide(met, sign_of(met.other_forces.dot(state_)));
      }
      ++events_;
      if (++count == max_events) ++overloaded_;
      remaining -= fraction * length;
    } else {
      evaluate_series(1.0);
      for (FrictionBody& each : friction_) each.fresh = false;
      remaining = length == remaining ? 0.0 : remaining - length;
    }
  }
}

}  // namespace zwidth::internal

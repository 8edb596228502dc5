#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "identification/shot_model.hpp"
#include "sampling/sampling_instants.hpp"
#include "simulation/continuous_motion.hpp"
#include "simulation/motion_tangent.hpp"

namespace zwidth::internal {

/// By what a weak force's slope is weighed.
struct Weighing {
  std::size_t body = 0;
  double length = 0.0;  ///< WeakForce::length
};

/// Of an element of x, for Player's slopes: how it changes the motion, and the lagged force that a shot begins with.
struct PlayedParameter {
  MotionParameter motion;
  double of_lag = 0.0;                    ///< s per unit
  std::optional<Weighing> weighing = {};  ///< of a weak force
};

/// The lagged force as a shot begins, and how it changes.
struct LaggedForce {
  double force = 0.0;
  double of_lag = 0.0;
  double of_delay = 0.0;
  double of_constant = 0.0;
};

/// The filter of the commands before the shot: f+ = u + (f - u) e^{-h/lag} over each stretch h of constant command u.
[[nodiscard]] LaggedForce lagged_force(const Device& device, const MotionRecord& record, std::size_t first,
                                       double constant);

/// One record's device on its way through the shots of that record.
class Player {
 public:
  Player(const Device& device, const MotionRecord& record, ShotUnits units, double constant)
      : device_(device),
        record_(record),
        units_(units),
        constant_(constant),
        instants_(sampling_instants({record.sampling_period, device.loop().delay})),
        motion_(device, {},
                instants_.with_old > 0.0 ? std::vector{instants_.with_old, instants_.with_new}
                                         : std::vector{record.sampling_period}),
        positions_(device.bodies().size()),
        velocities_(device.bodies().size()) {}

  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;
  Player(Player&&) = delete;
  Player& operator=(Player&&) = delete;
  ~Player() = default;

  /// Stick-slip instants are met in parts of 1/rate: too many of them per period would take for ever.
  [[nodiscard]] double parts_per_period() const { return motion_.rate() * record_.sampling_period; }

  /// From then on play() finds slopes too: by the parameters, the constant force, and the shot's state.
  void follow_slopes(std::vector<PlayedParameter> parameters) {
    std::vector<MotionParameter> motions;
    motions.reserve(parameters.size());
    for (PlayedParameter& each : parameters) motions.push_back(std::move(each.motion));
    delays_.clear();
    weights_.clear();
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      delays_.push_back({motions[j].switching, parameters[j].of_lag});
      if (parameters[j].weighing) weights_.push_back({j, *parameters[j].weighing});
    }
    tangent_.emplace(motion_, std::move(motions), 1 + 2 * positions_.size());
    motion_.set_tangent(&*tangent_);
  }

  /// False where stick-slip instants were cut off, or where it is not played on.
  bool play(const Shot& shot, const Eigen::VectorXd& state, ShotMotion& out,
            const std::function<bool(const Eigen::Ref<const Eigen::VectorXd>&)>& play_on) {
    start(shot, state);
    out.positions.resize(static_cast<Eigen::Index>(shot.count));
    if (tangent_) out.slopes.resize(tangent_->columns(), out.positions.size());
    const auto sensed = static_cast<Eigen::Index>(device_.loop().sensed);
    for (std::size_t i = 0; i < shot.count; ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      out.positions(column) = motion_.sensed();
      constexpr Eigen::Index stretch = 256;
      if (play_on && (column + 1) % stretch == 0 && !play_on(out.positions.head(column + 1))) return false;
      if (tangent_) {
        const auto slopes_of = [&](Eigen::Index row) {
          return tangent_->slopes().row(row).head(tangent_->columns()).transpose();
        };
        out.slopes.col(column) = slopes_of(0);
        if (sensed > 0) out.slopes.col(column) += slopes_of(sensed);
        weigh(i == 0);
      }
      const std::size_t k = shot.first + i;
      if (instants_.with_old > 0.0) {
        motion_.set_command(command(k, instants_.whole_samples + 1));
        motion_.advance_recurring(0);
        motion_.switch_command(command(k, instants_.whole_samples));
        motion_.advance_recurring(1);
      } else {
        motion_.switch_command(command(k, instants_.whole_samples));
        motion_.advance_recurring(0);
      }
    }
    return motion_.overloaded() == 0;
  }

 private:
  struct Delays {
    double of_delay = 0.0;  // s per unit of x
    double of_lag = 0.0;
  };

  struct Weight {
    std::size_t parameter = 0;
    Weighing of;
    double speed = 0.0;   // as the sample before began
    int direction = 0;    // of the last motion
    double turned = 0.0;  // position of the last turn; NaN: before the first
  };

  /// For the sample that begins.
  void weigh(bool is_first) {
    for (Weight& each : weights_) {
      const double velocity = motion_.velocity(each.of.body);
      const double weight = each.of.length > 0.0 ? since_the_turn(each, velocity, is_first)
                                                 : speed_within(each, std::abs(velocity), is_first);
      tangent_->weigh(each.parameter, weight);
    }
  }

  /// In its middle, as far as this sample and the last tell.
  static double speed_within(Weight& each, double speed, bool is_first) {
    const double before = is_first ? speed : each.speed;
    each.speed = speed;
    return std::max(0.0, 1.5 * speed - 0.5 * before);
  }

  /// e^{-distance / length} since the body turned; 0 before it does.
  double since_the_turn(Weight& each, double velocity, bool is_first) const {
    const double position = motion_.position(each.of.body);
    const int before = is_first ? 0 : each.direction;
    const int direction = velocity > 0.0 ? 1 : velocity < 0.0 ? -1 : before;
    if (is_first) {
      each.turned = std::numeric_limits<double>::quiet_NaN();
    } else if (direction != each.direction && each.direction != 0) {  // from rest it does not turn
      each.turned = position;
    }
    each.direction = direction;
    return std::isnan(each.turned) ? 0.0 : std::exp(-std::abs(position - each.turned) / each.of.length);
  }

  [[nodiscard]] double command(std::size_t k, std::size_t late) const {
    return record_.force[k < late ? 0 : k - late] + constant_;
  }

  void start(const Shot& shot, const Eigen::VectorXd& state) {
    const std::size_t sensed = device_.loop().sensed;
    const std::size_t bodies = positions_.size();
    const double own = state(0) * units_.position;
    Eigen::Index next = 1;
    for (std::size_t i = 0; i < bodies; ++i) {
      positions_[i] = i == sensed ? own : own + state(next++) * units_.position;
    }
    for (std::size_t i = 0; i < bodies; ++i) velocities_[i] = state(next++) * units_.velocity;
    motion_.reset();
    const LaggedForce lagged = lagged_force(device_, record_, shot.first, constant_);
    motion_.set_lagged_force(lagged.force);
    motion_.set_command(command(shot.first, instants_.whole_samples + 1));
    if (tangent_) start_slopes(lagged);
    motion_.set_motion(positions_.data(), velocities_.data());
  }

  /// As start() sets the states, whose positions but the first are relative to body 0's.
  void start_slopes(const LaggedForce& lagged) {
    MotionTangent::Slopes& slopes = tangent_->slopes();
    slopes.setZero();
    const auto sensed = static_cast<Eigen::Index>(device_.loop().sensed);
    const auto bodies = static_cast<Eigen::Index>(positions_.size());
    auto column = static_cast<Eigen::Index>(delays_.size());
    const auto of_constant = column++;
    slopes(motion_.command_row(), of_constant) = units_.force;
    if (device_.parameters().actuator.time_constant > 0.0) {
      slopes(motion_.lag_row(), of_constant) = units_.force * lagged.of_constant;
      for (std::size_t j = 0; j < delays_.size(); ++j) {
        slopes(motion_.lag_row(), static_cast<Eigen::Index>(j)) =
            delays_[j].of_delay * lagged.of_delay + delays_[j].of_lag * lagged.of_lag;
      }
    }
    slopes(0, column++) = units_.position;
    for (Eigen::Index i = 0; i < bodies; ++i) {
      if (i == sensed) continue;
      if (i > 0) {
        slopes(i, column++) = units_.position;
      } else {
        slopes(0, column) = units_.position;
        slopes.col(column++).segment(1, bodies - 1).setConstant(-units_.position);
      }
    }
    for (Eigen::Index i = 0; i < bodies; ++i) slopes(bodies + i, column++) = units_.velocity;
  }

  const Device& device_;
  const MotionRecord& record_;
  ShotUnits units_;
  double constant_;
  SamplingInstants instants_;
  ContinuousMotion motion_;
  std::vector<Delays> delays_;  ///< by parameter
  std::vector<Weight> weights_;
  std::optional<MotionTangent> tangent_;
  std::vector<double> positions_;
  std::vector<double> velocities_;
};

}  // namespace zwidth::internal

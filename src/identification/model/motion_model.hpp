#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/model/force_law.hpp"
#include "identification/model/number.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// A record of force and position.
struct ForceMotionRecord {
  std::span<const double> force;     ///< N or N m, held over each sampling period
  std::span<const double> position;  ///< m or rad, at each period's beginning
  double sampling_period = 0.0;      ///< s
};

/// A part of a record that begins in a state of its own.
struct Segment {
  std::size_t record = 0;
  std::size_t first = 0;  ///< sample
  std::size_t count = 0;
};

/// A smooth force beside the linear device.
struct ForceTerm {
  std::shared_ptr<const ForceLaw> law;
  std::string body;
  std::string against = {};             ///< another body, which feels the opposite; empty: the ground
  std::size_t number = 0;               ///< its first among the model's numbers
  std::optional<std::size_t> record{};  ///< it acts in; absent: all
};

/// Dry friction of a body, which sticks.
struct FrictionTerm {
  std::string body;
  std::size_t number = 0;  ///< N or N m
};

/// A drive that gives less than it is told: none within the dead band, no more than its limit.
struct DriveTerm {
  std::optional<std::size_t> dead_band{};   ///< a number, N or N m
  std::optional<std::size_t> saturation{};  ///< a number, N or N m: by how much the limit is below the largest command
};

/// What moves the device beside its linear equations.
struct MotionTerms {
  std::vector<ForceTerm> forces;
  std::vector<FrictionTerm> frictions;
  DriveTerm drive;
};

/// Positions of the sensed body, and how they change: a column per number, then per element of the segment's state.
struct PlayedSegment {
  Eigen::VectorXd positions;
  Eigen::MatrixXd slopes;
};

/// A device with all that moves it, played under recorded forces.
///
/// Between two changes of the command the linear device moves exactly (matrix exponential, any delay, lag included); the
/// terms act as forces held over a part of that time: smooth ones as they are halfway, friction in closed form with its
/// stops and turns (friction_step()). Derivatives are exact of this recursion.
///
/// x: a coordinate per number. A segment's state: positions of the sensed body, of the others less that of body 0, velocities;
/// in units of the record.
class MotionModel {
 public:
  MotionModel(DeviceParameters structure, std::vector<std::string> locked, std::vector<ForceMotionRecord> records,
              std::vector<Number> numbers, MotionTerms terms, int parts);

  [[nodiscard]] const std::vector<Number>& numbers() const noexcept { return numbers_; }
  [[nodiscard]] const std::vector<ForceMotionRecord>& records() const noexcept { return records_; }
  [[nodiscard]] Eigen::Index states() const noexcept { return 2 * bodies_; }
  /// The device: where the lag is a number, loop.delay is that of the sum of both, which is what a record tells.
  [[nodiscard]] DeviceParameters device_at(const Eigen::VectorXd& x) const;

  /// From the recorded position alone: no link stretched, all bodies at the sensed one's velocity.
  [[nodiscard]] Eigen::VectorXd recorded_state(const Segment& segment) const;

  /// All segments at x from their states; nothing where the numbers make no device, or the motion leaves all bounds.
  [[nodiscard]] std::optional<std::vector<PlayedSegment>> play(const Eigen::VectorXd& x, const std::vector<Segment>& segments,
                                                               const std::vector<Eigen::VectorXd>& states, bool with_slopes) const;

 private:
  struct Prepared;
  /// As the numbers say: where the lag is one of them, loop.delay is the sum of both.
  [[nodiscard]] DeviceParameters values_at(const Eigen::VectorXd& x) const;
  /// s; below 0 where a lag is longer than the sum.
  [[nodiscard]] double played_delay(const Eigen::VectorXd& x) const;
  [[nodiscard]] Prepared prepared(const Eigen::VectorXd& x, std::size_t record, bool with_slopes) const;
  [[nodiscard]] bool play(const Prepared& prepared, const Segment& segment, const Eigen::VectorXd& state, PlayedSegment& out) const;

  struct Units {
    double position = 0.0;
    double velocity = 0.0;
    double largest_force = 0.0;
  };

  DeviceParameters structure_;
  std::vector<std::string> locked_;
  std::vector<ForceMotionRecord> records_;
  std::vector<Number> numbers_;
  MotionTerms terms_;
  int parts_;  ///< of a sampling period, where a term acts
  std::vector<Units> units_;
  Eigen::Index bodies_ = 0;
  Eigen::Index sensed_ = 0;
  Eigen::Index actuated_ = 0;
  std::vector<std::string> names_;  ///< of the bodies that move
};

}  // namespace zwidth::internal

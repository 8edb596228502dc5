#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/model/device_family.hpp"
#include "identification/model/motion_terms.hpp"

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

/// Positions of the sensed body, and how they change: a column per number, then per element of the segment's state.
struct PlayedSegment {
  Eigen::VectorXd positions;
  Eigen::MatrixXd slopes;
};

/// A family of devices with all that moves them, played under recorded forces.
///
/// Between two changes of the command the linear device moves exactly (matrix exponential, any delay, lag included); the
/// terms act as forces held over a part of that time: smooth ones as they are halfway, friction in closed form with its
/// stops and turns (friction_step()). Derivatives are those of this recursion.
///
/// x: a coordinate per number. A segment's state: position of the sensed body, of the others less that of body 0, velocities;
/// in units of the record.
class MotionModel {
 public:
  /// `substeps`: of a sampling period, in each of which the terms act anew.
  MotionModel(DeviceFamily family, MotionTerms terms, std::vector<ForceMotionRecord> records, int substeps);

  [[nodiscard]] const DeviceFamily& family() const noexcept { return family_; }
  [[nodiscard]] const std::vector<Number>& numbers() const noexcept { return family_.numbers(); }
  [[nodiscard]] const std::vector<ForceMotionRecord>& records() const noexcept { return records_; }
  [[nodiscard]] int substeps() const noexcept { return substeps_; }
  [[nodiscard]] Eigen::Index states() const noexcept { return 2 * bodies_; }

  /// From the recorded position alone: no link stretched, all bodies at the sensed one's velocity.
  [[nodiscard]] Eigen::VectorXd recorded_state(const Segment& segment) const;

  /// All segments at x from their states; nothing where the numbers make no device, or the motion leaves all bounds.
  [[nodiscard]] std::optional<std::vector<PlayedSegment>> play(const Eigen::VectorXd& x,
                                                               const std::vector<Segment>& segments,
                                                               const std::vector<Eigen::VectorXd>& states,
                                                               bool with_slopes) const;

 private:
  struct Units {
    double position = 0.0;
    double velocity = 0.0;
    double largest_force = 0.0;
  };

  DeviceFamily family_;
  MotionTerms terms_;
  std::vector<ForceMotionRecord> records_;
  int substeps_;
  std::vector<Units> units_;
  std::vector<std::string> names_;  ///< of the bodies that move
  Eigen::Index bodies_ = 0;
  Eigen::Index sensed_ = 0;

  friend class SegmentPlayer;
};

}  // namespace zwidth::internal

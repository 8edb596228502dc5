#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "identification/model/motion_model.hpp"
#include "identification/model/played_device.hpp"
#include "identification/model/presliding_step.hpp"
#include "identification/model/row_sums.hpp"

namespace zwidth::internal {

/// What a drive gives, N or N m, and how it changes with the drive's own numbers, per unit of x.
struct DriveForce {
  double force = 0.0;
  double by_dead_band = 0.0;
  double by_saturation = 0.0;
  double by_drift = 0.0;
};

/// A motion and how it changes, moved part by part.
///
/// A part's end hangs on few things: the state and the bends at its beginning, the command, a force on each body, one of each
/// friction, and the device's numbers. Their slopes are followed through the part; those of the motion, a column per number
/// and element of the segment's state, are multiplied by them once, at its end.
class SegmentPlayer {
 public:
  SegmentPlayer(const PlayedDevice& device, Eigen::Index bodies, Eigen::Index columns);

  static constexpr Eigen::Index most_states = 13;
  static constexpr Eigen::Index most_bodies = 6;
  using Step = PlayedDevice::Step;
  using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_states, 1>;

  /// What the drive makes of the command of a sample when `share` of the record is over. A drift of the delay takes the mean
  /// of two neighbours by their shares of the period: the impulse is exact, the position to (omega T)^3 / 50.
  [[nodiscard]] DriveForce given(const ForceMotionRecord& record, std::ptrdiff_t sample, double share) const;
  /// Friction that bends, bent as the recorded motion before a sample leaves it.
  void bend_as_recorded(const ForceMotionRecord& record, std::size_t sample);
  /// One of the steps; `share` of the record is over. Halved again and again where a body stops, starts or turns within.
  void move(const PlayedDevice::Steps& steps, const DriveForce& command, double share) {
    move(steps.halves, 0, command, share);
  }

  State x;
  Rows slopes;  ///< of x, then of the bends; columns padded

 private:
  /// A number that acts in one place: the motion's column of it grows by a part's column, or by one element.
  struct OwnSlope {
    Eigen::Index number = 0;
    Eigen::Index column = 0;
    double slope = 0.0;
  };
  struct BendSlope {
    Eigen::Index row = 0;
    Eigen::Index number = 0;
    double slope = 0.0;
  };

  void move(const std::vector<Step>& halves, std::size_t halved, const DriveForce& command, double share);
  /// Whether a friction holds its body at the step's end where it did not before, or the other way round, or turns it.
  [[nodiscard]] bool changes() const;
  void take_frictions();
  [[nodiscard]] DriveForce through_drive(double command) const;
  [[nodiscard]] const PlayedDevice::Friction& friction(Eigen::Index i) const {
    return device_.frictions[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] PreslidingStep& end(Eigen::Index friction) { return ends_[static_cast<std::size_t>(friction)]; }
  [[nodiscard]] bool rubs(Eigen::Index i) const { return friction(i).limit > 0.0; }
  /// Of what a friction slides on.
  [[nodiscard]] double speed(const State& of, Eigen::Index i) const;
  /// row += by * the slopes of the step's compliance.
  void add_compliance_slopes(double* row, double by, const Step& step, Eigen::Index on, Eigen::Index of) const;

  void begin_slopes(const Step& step, double command);
  void add_forces(double share);
  void add_force(const PlayedDevice::Force& force, const LawForce& now);
  void add_frictions(const Step& step);
  void rub(const Step& step, Eigen::Index i, bool with_slopes);
  void add_friction_slopes(const Step& step);
  void add_slopes_of(const Step& step, Eigen::Index i);
  /// How each friction answers the others' slopes, in sweeps as it answers their forces.
  void answer(const Step& step);
  void bend_slopes_of(const Step& step, Eigen::Index i);
  /// The part's end by the forces on the bodies so far.
  void apply(const Step& step);
  void end_slopes(const DriveForce& command);

  const PlayedDevice& device_;
  Eigen::Index bodies_;
  Eigen::Index frictions_;
  bool with_slopes_;
  State before_;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_bodies, 1> forces_;
  std::vector<double> friction_forces_;  ///< N or N m, of frictions
  std::vector<double> bends_;            ///< of frictions
  std::vector<char> held_;               ///< whether a friction holds its body
  std::vector<PreslidingStep> ends_;     ///< of frictions

  // Slopes of a part, by: state and bends, from 0 on; command; force on each body; of each friction; numbers of the device.
  Eigen::Index command_at_ = 0;
  Eigen::Index forces_at_ = 0;
  Eigen::Index frictions_at_ = 0;
  Eigen::Index numbers_at_ = 0;
  Rows ends_slopes_;   ///< of state and bends
  Rows force_slopes_;  ///< of the forces on the bodies
  Rows free_slopes_;   ///< of each friction's velocity without it
  Rows added_slopes_;  ///< of each friction while all others stay
  Rows answers_;       ///< of each friction, by those in `added_slopes_`
  Rows heard_;         ///< of each friction's velocity without it, by them
  Rows gradients_;     ///< of the forces on the bodies, by the state
  std::vector<OwnSlope> own_slopes_;
  std::vector<BendSlope> bend_slopes_;
  Rows next_slopes_;
};

}  // namespace zwidth::internal

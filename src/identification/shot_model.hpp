#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/fit_model.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// A record of force and position as a fit in time sees it.
struct MotionRecord {
  std::span<const double> force;
  std::span<const double> position;
  double sampling_period = 0.0;  ///< s
};

/// A part of a record that is played from a state of its own.
struct Shot {
  std::size_t record = 0;
  std::size_t first = 0;  ///< sample
  std::size_t count = 0;

  bool operator==(const Shot&) const = default;
};

/// Positions of the sensed body, one vector per shot.
using ShotPositions = std::vector<Eigen::VectorXd>;

/// By which a record's forces and shots' states are counted.
struct ShotUnits {
  double force = 0.0;
  double position = 0.0;
  double velocity = 0.0;
};

/// A shot as it is played.
struct ShotMotion {
  Eigen::VectorXd positions;
  /// By sample, a column each: d position by the coordinates, the constant force of its record, and the shot's state.
  Eigen::MatrixXd slopes;
};

/// Whether to play on: told the positions of a shot, by its index, as far as it is played. From several threads at
/// once, for each shot from one.
using PlayOn = std::function<bool(std::size_t shot, Eigen::Ref<const Eigen::VectorXd> positions)>;

struct PlayedParameter;

/// The last motions of a model, and where they were played. A copy begins without any.
class PlayedShots {
 public:
  using Motions = std::shared_ptr<const std::vector<ShotMotion>>;

  PlayedShots() = default;
  PlayedShots(const PlayedShots&) {}
  PlayedShots& operator=(const PlayedShots&) = delete;
  PlayedShots(PlayedShots&&) = delete;
  PlayedShots& operator=(PlayedShots&&) = delete;
  ~PlayedShots() = default;

  [[nodiscard]] Motions find(const Eigen::VectorXd& x, const std::vector<Shot>& shots,
                             const std::vector<Eigen::VectorXd>& states) const;
  void keep(const Eigen::VectorXd& x, const std::vector<Shot>& shots, const std::vector<Eigen::VectorXd>& states,
            Motions motions);

 private:
  mutable std::mutex mutex_;
  Eigen::VectorXd x_;
  std::vector<Shot> shots_;
  std::vector<Eigen::VectorXd> states_;
  Motions motions_;
};

/// As ShotModel plays it: a lag far below the sampling period is too fast to follow, and no other than that much delay.
[[nodiscard]] Device without_short_lag(const Device& device);

/// A force on a body beside what a device has: drag -c |v| v, or what friction has more, c e^{-s/length} against the motion,
/// after the body turned and went s. |v| and s are held over each sampling period.
struct WeakForce {
  std::string body;
  double length = 0.0;  ///< m or rad; 0: drag
};

/// The structure moved exactly under the recorded forces, friction included.
///
/// x: the coordinates of the free parameters, then a constant force per record in its unit. A shot's state: position of
/// the sensed body, positions of the others less that one, velocities of all, each in its unit.
class ShotModel {
 public:
  /// A device that takes more parts per sampling period to follow than `most_parts` is not played.
  ShotModel(Device structure, std::vector<MotionRecord> records, std::vector<Coordinate> coordinates,
            std::vector<std::string> locked, double most_parts = 60.0);

  [[nodiscard]] const std::vector<Coordinate>& coordinates() const noexcept { return coordinates_; }
  [[nodiscard]] const std::vector<MotionRecord>& records() const noexcept { return records_; }
  [[nodiscard]] Eigen::Index parameters() const noexcept {
    return static_cast<Eigen::Index>(coordinates_.size() + records_.size());
  }
  [[nodiscard]] Eigen::Index states() const noexcept { return 2 * static_cast<Eigen::Index>(bodies_); }
  /// Whether the element of x may not be negative.
  [[nodiscard]] bool is_bounded(Eigen::Index i) const;
  /// N or N m per unit of a constant force in x.
  [[nodiscard]] double force_unit(std::size_t record) const { return units_[record].force; }

  [[nodiscard]] Eigen::VectorXd position_of(const DeviceParameters& parameters) const;
  [[nodiscard]] DeviceParameters parameters_at(const Eigen::VectorXd& x) const;

  /// A state for each shot from the recorded position alone: no link stretched, all bodies at the sensed one's velocity.
  [[nodiscard]] std::vector<Eigen::VectorXd> recorded_states(const std::vector<Shot>& shots) const;

  /// The same, with these parameters as the structure's and none of them free: x is the constant forces alone.
  [[nodiscard]] ShotModel at(const Eigen::VectorXd& x) const;

  /// The same under other forces, as long as the recorded ones and by their units; the caller keeps them alive.
  [[nodiscard]] ShotModel with_forces(const std::vector<std::span<const double>>& forces) const;

  /// The same with a further coordinate c for each of these, after the others. It is 0 in every device, and has slopes
  /// only.
  [[nodiscard]] ShotModel with_weak_forces(std::vector<WeakForce> forces) const;

  enum class Slopes { none, exact };
  /// Null where the parameters make no device that can be followed in time. With slopes a free friction of 0 is
  /// taken as one too small to matter, so that its own slope shows; they are exact along the motion, of a short lag by a
  /// difference. Null too where `play_on`, asked in between, says no. The last motions are kept: a fit comes back to
  /// where a search ended.
  [[nodiscard]] std::shared_ptr<const std::vector<ShotMotion>> play(const Eigen::VectorXd& x,
                                                                    const std::vector<Shot>& shots,
                                                                    const std::vector<Eigen::VectorXd>& states,
                                                                    Slopes slopes, const PlayOn& play_on = {}) const;

 private:
  [[nodiscard]] Device device_in(std::size_t record, const DeviceParameters& parameters) const;
  /// Whether any is free that was 0.
  bool free_friction(DeviceParameters& parameters) const;
  /// Whether the element of x is a lag so short that it differs from a delay in the second order only: by the motion's
  /// own slopes it is one.
  [[nodiscard]] bool is_short_lag(Eigen::Index i, double x) const;
  [[nodiscard]] std::optional<std::vector<ShotMotion>> play_anew(const Eigen::VectorXd& x,
                                                                 const std::vector<Shot>& shots,
                                                                 const std::vector<Eigen::VectorXd>& states,
                                                                 Slopes slopes, const PlayOn& play_on) const;
  [[nodiscard]] PlayedParameter played(std::size_t i, double x, std::size_t record, const DeviceParameters& parameters,
                                       const Device& device) const;

  Device structure_;
  std::vector<MotionRecord> records_;
  std::vector<Coordinate> coordinates_;
  std::vector<WeakForce> weak_forces_;  ///< of the last coordinates
  std::vector<std::string> locked_;
  double most_parts_;             ///< per sampling period
  std::vector<ShotUnits> units_;  ///< by record
  std::size_t bodies_ = 0;
  mutable PlayedShots last_plain_;
  mutable PlayedShots last_with_slopes_;
};

}  // namespace zwidth::internal

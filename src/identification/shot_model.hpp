#pragma once

#include <Eigen/Core>
#include <cstddef>
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

struct PlayedParameter;

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
  /// Whether the element of x is a lag so short that it differs from a delay in the second order only: by play()'s slopes
  /// it is one.
  [[nodiscard]] bool is_short_lag(Eigen::Index i, double x) const;
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

  enum class Slopes { none, exact };
  /// Nothing where the parameters make no device that can be followed in time. With slopes a free friction of 0 is
  /// taken as one too small to matter, so that its own slope shows.
  [[nodiscard]] std::optional<std::vector<ShotMotion>> play(const Eigen::VectorXd& x, const std::vector<Shot>& shots,
                                                            const std::vector<Eigen::VectorXd>& states,
                                                            Slopes slopes) const;

 private:
  [[nodiscard]] Device device_in(std::size_t record, const DeviceParameters& parameters) const;
  void free_friction(DeviceParameters& parameters) const;
  [[nodiscard]] PlayedParameter played(std::size_t i, double x, std::size_t record, const DeviceParameters& parameters,
                                       const Device& device) const;

  Device structure_;
  std::vector<MotionRecord> records_;
  std::vector<Coordinate> coordinates_;
  std::vector<std::string> locked_;
  double most_parts_;             ///< per sampling period
  std::vector<ShotUnits> units_;  ///< by record
  std::size_t bodies_ = 0;
};

}  // namespace zwidth::internal

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "identification/model/linear_step.hpp"
#include "identification/model/motion_model.hpp"

namespace zwidth::internal {

/// A device of the family in one record, ready to be played.
struct PlayedDevice {
  /// The device at x.
  PlayedDevice(const DeviceFamily& family, const MotionTerms& terms, const std::vector<std::string>& bodies,
               std::size_t record, double largest_force, double period, int parts, const Eigen::VectorXd& x,
               bool with_slopes);

  struct Force {
    const ForceLaw* law = nullptr;
    Eigen::Index body = 0;
    Eigen::Index against = -1;
    std::array<Eigen::Index, most_numbers_of_law> numbers = {};  // behind the law's own: not used
    std::array<double, most_numbers_of_law> values = {};
  };
  struct Friction {
    Eigen::Index body = 0;
    Eigen::Index number = 0;
    double limit = 0.0;
    std::optional<Eigen::Index> length_number = {};
    double length = 0.0;  ///< m or rad
  };
  bool with_slopes = false;
  LinearStep before;                 ///< until the command changes
  LinearStep after;                  ///< from then on
  std::ptrdiff_t delay_samples = 0;  ///< of the command from then on
  Eigen::VectorXd input;             ///< b
  std::vector<std::pair<Eigen::Index, double>>
      instants;                   ///< numbers that move the change of the command, s per unit of x
  Eigen::VectorXd number_slopes;  ///< d value / dx
  std::vector<Force> forces;
  std::vector<Friction> frictions;
  std::optional<Eigen::Index> dead_band_number;
  std::optional<Eigen::Index> saturation_number;
  std::optional<Eigen::Index> drift_number;
  double drift = 0.0;        ///< samples, by which the command is later at the record's end than at its beginning
  double drift_slope = 0.0;  ///< samples per unit of x
  double dead_band = 0.0;    ///< N or N m
  double limit = 0.0;        ///< N or N m
};

/// A motion and how it changes, moved part by part. Rows of a body are contiguous: a step is a few sums of rows.
class SegmentPlayer {
 public:
  SegmentPlayer(const PlayedDevice& device, Eigen::Index bodies, Eigen::Index columns);

  static constexpr Eigen::Index most_states = 13;
  static constexpr Eigen::Index most_bodies = 6;
  static constexpr Eigen::Index most_columns = 80;
  using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_states, 1>;
  using Slopes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, most_states, most_columns>;
  using Row = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, most_columns>;

  /// What the drive makes of the command of a sample when `share` of the record is over, and its slopes where it has any. A
  /// drift of the delay takes the mean of two neighbours by their shares of the period: the impulse is exact, the position
  /// to (omega T)^3 / 50.
  [[nodiscard]] double given(const ForceMotionRecord& record, std::ptrdiff_t sample, double share, Row& slopes) const;
  /// Friction that bends, bent as the recorded motion before a sample leaves it.
  void bend_as_recorded(const ForceMotionRecord& record, std::size_t sample);
  /// One part; `share` of the record is over.
  void move(const LinearStep& step, double command, const Row& command_slopes, double share);

  State x;
  Slopes slopes;

 private:
  [[nodiscard]] double through_drive(double command, Row& slopes) const;
  void add_forces(double share);
  void add_frictions(const LinearStep& step);
  /// x and slopes by the forces on the bodies so far.
  void apply(const LinearStep& step);

  const PlayedDevice& device_;
  Eigen::Index bodies_;
  std::array<double, most_bodies> bends_ = {};
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, most_bodies, most_columns> bend_slopes_;
  State before_;
  Slopes before_slopes_;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_bodies, 1> forces_;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, most_bodies, most_columns> force_slopes_;
};

}  // namespace zwidth::internal

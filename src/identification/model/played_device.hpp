#pragma once

#include <Eigen/Core>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "identification/model/device_family.hpp"
#include "identification/model/force_law.hpp"
#include "identification/model/linear_step.hpp"
#include "identification/model/motion_terms.hpp"

namespace zwidth::internal {

/// A device of the family in one record, ready to be played.
struct PlayedDevice {
  /// The device at x.
  PlayedDevice(const DeviceFamily& family, const MotionTerms& terms, const std::vector<std::string>& bodies,
               std::size_t record, double largest_force, double period, int substeps, const Eigen::VectorXd& x,
               bool with_slopes);

  struct Force {
    ForceLaw law = nullptr;
    Eigen::Index body = 0;
    std::array<Eigen::Index, most_numbers_of_law> numbers = {};  // behind the law's own: not used
    std::array<double, most_numbers_of_law> values = {};
  };
  /// A body that a friction pushes, and which way.
  struct RubbedBody {
    Eigen::Index body = 0;
    double sign = 1.0;
  };
  struct Friction {
    boost::container::static_vector<RubbedBody, 2> bodies =
        {};  ///< its velocity is the sum of theirs, each by its sign
    Eigen::Index number = 0;
    double limit = 0.0;
    std::optional<Eigen::Index> length_number = {};
    double length = 0.0;     ///< m or rad
    Eigen::Index bend = -1;  ///< its place among those whose bend moves the body: none where the limit is 0
  };
  struct Step : LinearStep {
    Eigen::MatrixXd compliance;  ///< velocity of a friction (row) at the end by the force of one (column)
  };
  /// Equal steps, one after the other.
  struct Steps {
    int count = 0;
    std::vector<Step> halves = {};  ///< one of them, its half, its quarter, ...
  };
  [[nodiscard]] const Step& step() const { return (before.count > 0 ? before : after).halves.front(); }

  bool with_slopes = false;
  Steps before;                      ///< until the command changes
  Steps after;                       ///< from then on
  std::ptrdiff_t delay_samples = 0;  ///< of the command from then on
  Eigen::VectorXd input;             ///< b
  std::vector<std::pair<Eigen::Index, double>>
      instants;                   ///< numbers that move the change of the command, s per unit of x
  Eigen::VectorXd number_slopes;  ///< d value / dx
  std::vector<Force> forces;
  std::vector<Friction> frictions;
  Eigen::Index rubbing = 0;  ///< frictions whose limit is above 0
  Eigen::Index bends = 0;    ///< of them, those that bend
  std::optional<Eigen::Index> dead_band_number;
  std::optional<Eigen::Index> saturation_number;
  std::optional<Eigen::Index> drift_number;
  double drift = 0.0;        ///< samples, by which the command is later at the record's end than at its beginning
  double drift_slope = 0.0;  ///< samples per unit of x
  double dead_band = 0.0;    ///< N or N m
  double limit = 0.0;        ///< N or N m
};

}  // namespace zwidth::internal

#pragma once

#include <Eigen/Core>
#include <complex>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "zwidth/identification/parameter_fit.hpp"

namespace zwidth::internal {

/// How a free parameter is a coordinate x of the search.
struct Coordinate {
  std::string key;
  enum class Kind {
    logarithmic,   ///< value = unit exp(x): masses and stiffnesses of links
    not_negative,  ///< value = unit x, x >= 0: what may be 0
  };
  Kind kind = Kind::not_negative;
  double unit = 1.0;  ///< a typical value
  /// x stays below: a delay is known only modulo what the spacing of the lines resolves.
  double bound = std::numeric_limits<double>::infinity();

  [[nodiscard]] static Kind kind_of(std::string_view key);  ///< by its row of the table of keys
  [[nodiscard]] double value(double x) const;
  [[nodiscard]] double position(double value) const;  ///< x of a value
  [[nodiscard]] double slope(double x) const;         ///< d value / dx
};

/// A response with its derivatives with respect to the coordinates.
struct ResponseWithSlopes {
  Eigen::VectorXcd values;  ///< one per frequency
  Eigen::MatrixXcd slopes;  ///< a column per coordinate
};

/// What the measurement would be of the structure with other values of its free parameters.
class FitModel {
 public:
  /// The units of the coordinates come from the response. Throws as fit_parameters() does.
  FitModel(const Device& structure, const FrequencyResponse& response, const std::vector<std::string>& free,
           const std::vector<std::string>& locked);

  [[nodiscard]] const std::vector<Coordinate>& coordinates() const noexcept { return coordinates_; }
  [[nodiscard]] const Device& structure() const noexcept { return structure_; }
  [[nodiscard]] const std::vector<std::size_t>& locked() const noexcept { return locked_; }
  [[nodiscard]] std::optional<double> sampling_period() const noexcept { return sampling_period_; }

  /// Coordinates of the structure's own values.
  [[nodiscard]] Eigen::VectorXd position_of(const DeviceParameters& parameters) const;
  /// The structure with the values at x.
  [[nodiscard]] DeviceParameters parameters_at(const Eigen::VectorXd& x) const;

  /// The response at each frequency, rad/s. Throws Error (did_not_converge) as sampled_plant() does.
  [[nodiscard]] Eigen::VectorXcd response_at(const Eigen::VectorXd& x, const std::vector<double>& frequencies) const;
  /// The same with its slopes, exact or, where doubles do not carry those, by central differences (one-sided ones at a
  /// bound).
  [[nodiscard]] ResponseWithSlopes slopes_at(const Eigen::VectorXd& x, const std::vector<double>& frequencies) const;

 private:
  /// Bodies locked, sampled as the response is, no wall's filters, no friction.
  [[nodiscard]] Device as_measured(DeviceParameters parameters) const;
  [[nodiscard]] Eigen::VectorXcd response_of(const Device& device, const std::vector<double>& frequencies) const;
  [[nodiscard]] Eigen::MatrixXcd differences_at(const Eigen::VectorXd& x, const std::vector<double>& frequencies,
                                                const Eigen::VectorXcd& values) const;

  Device structure_;
  std::vector<std::size_t> locked_;
  std::optional<double> sampling_period_;
  std::vector<Coordinate> coordinates_;
};

}  // namespace zwidth::internal

#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/response/line_regression.hpp"
#include "identification/missing_mode.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// A fitted device beside a record that it was fitted to.
struct MotionQuestion {
  const Device& device;  ///< fitted
  const std::vector<std::string>& locked;
  const std::vector<std::string>& free;  ///< keys of the fit
  double sampling_period = 0.0;          ///< of the record, s
  double lowest = 0.0;                   ///< rad/s, of the excited band
  double highest = 0.0;
};

/// A force at one body that opposes its motion.
struct Opposing {
  std::string body;
  std::vector<double> effect;  ///< on the sensed position, of unit size
};

/// What a fitted linear device leaves of a recorded motion, and what its numbers would change of that:
///
///     y - y_M = sum_j dy_M/dp_j dp_j + start + constant force + offset + c e,   in the frequency domain, each line weighted
///     by the rest around it
///
/// y_M: motion of the fitted device, as it was in the experiment, under the recorded force.
class MotionResiduals {
 public:
  MotionResiduals(const MotionQuestion& question, std::span<const double> force, std::span<const double> position);

  /// Whether the record is long enough to tell.
  [[nodiscard]] bool are_enough() const { return are_enough_; }
  [[nodiscard]] std::span<const double> force() const { return force_; }

  /// e of an opposing_force() at each body that moves.
  [[nodiscard]] std::vector<Opposing> opposing_forces(const std::function<double(double)>& size) const;

  /// c with its deviation; dp first.
  [[nodiscard]] std::optional<LineRegression> beside(const Opposing& force) const;

  /// dp, start, constant force and offset are known. Refers to this.
  [[nodiscard]] RestLines rest() const;

  /// The fitted device with dp of that; a number of which nothing would be left keeps a tenth.
  [[nodiscard]] DeviceParameters parameters_beside(const LineRegression& found) const;

 private:
  /// The change of the motion as a number grows by a typical amount of itself, `unit`.
  struct Slope {
    std::string key;
    double unit = 0.0;
    std::vector<double> change;
  };
  [[nodiscard]] std::optional<Slope> slope(const std::string& key, const std::vector<double>& own) const;

  const MotionQuestion& question_;
  Device device_;  ///< as it was in the experiment
  std::span<const double> force_;
  std::vector<Slope> slopes_;
  LineBand band_;
  bool are_enough_ = false;
  Eigen::MatrixXcd known_;  ///< the columns before e
  Eigen::VectorXcd target_;
};

/// The fitted device as it was in the experiment: bodies locked, sampled at the record's rate, no wall's filters.
[[nodiscard]] Device device_in_experiment(const Device& fitted, const std::vector<std::string>& locked,
                                          double sampling_period);

/// Of positions a sampling period apart: a force -size(|v|) sign(v) by sample; `size` of a speed in m/s or rad/s.
[[nodiscard]] std::vector<double> opposing_force(std::span<const double> positions, double sampling_period,
                                                 const std::function<double(double)>& size);

/// The device pushed at a body, at once.
[[nodiscard]] Device pushed_at(const Device& device, std::size_t body);

/// Positions of the sensed body under a force.
[[nodiscard]] std::vector<double> motion_of(const Device& device, std::span<const double> force);

/// Sensed positions of `size` samples from each initial state at 1, without a force.
[[nodiscard]] std::vector<std::vector<double>> free_motions(const Device& device, std::size_t size);

}  // namespace zwidth::internal

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/study/distribution.hpp"
#include "zwidth/study/sampling_plan.hpp"

namespace zwidth {

/// One number that varies.
struct StudyParameter {
  std::string key;            ///< as in model/parameter.hpp
  Distribution distribution;  ///< that it follows
};

/// How the units of one design vary: the distribution of each number, and how they go together (a Gaussian copula).
struct StudyDistributions {
  std::vector<StudyParameter> parameters;  ///< in the order of the file
  /// Correlations of the normal scores, one row per parameter: symmetric, positive definite, ones on the diagonal.
  /// Empty: independent.
  std::vector<std::vector<double>> correlation = {};
};

/// What every unit must reach; N/m or N m/rad.
struct Specification {
  std::optional<double> critical_stiffness;  ///< N/m or N m/rad; absent: not asked
  std::optional<double> any_user;            ///< N/m or N m/rad; absent: not asked
};

/// The first thing that makes no study of the device: a key that is no number of it, or that it does not have a value
/// of, or given twice; an impossible distribution; one that reaches a value which makes no device, the others at the
/// device's own; a correlation that is not positive definite. Keys: "parameter.2.upper", "correlation.matrix".
[[nodiscard]] std::optional<DeviceProblem> find_problem(const Device& device, const StudyDistributions& distributions);

/// The parameters of the device's own [uncertainty] by their key: a normal of its value and deviation.
/// Nothing where the device says nothing of that key.
[[nodiscard]] std::optional<Distribution> uncertainty_of(const Device& device, const std::string& key);

/// The correlation that [uncertainty] gives two of its parameters; 0 where it knows either not.
[[nodiscard]] double uncertain_correlation(const Device& device, const std::string& one, const std::string& other);

/// From uniform numbers to the numbers of a device:
///     z = Phi^-1(u),    y = L z with L L^T the correlation,    x_j = F_j^-1(Phi(y_j))
class StudyInputs {
 public:
  /// Throws Error (invalid_argument) where the distributions or the correlation have a problem of their own.
  explicit StudyInputs(const StudyDistributions& distributions);

  [[nodiscard]] std::size_t size() const { return quantiles_.size(); }  ///< how many parameters
  /// The quantiles of the j-th parameter.
  [[nodiscard]] const QuantileFunction& quantile(std::size_t j) const { return quantiles_[j]; }
  /// Whether the parameter is correlated with another.
  [[nodiscard]] bool is_correlated(std::size_t j) const { return correlated_[j]; }

  /// `numbers`: uniform on the way in, values of the parameters on the way out.
  void from_uniform(std::span<double> numbers) const;
  /// Independent standard normal numbers on the way in, on the way out those that vary together: y = L z.
  void correlate(std::span<double> scores) const;
  /// `numbers`: independent standard normal numbers on the way in, values on the way out.
  void from_normal(std::span<double> numbers) const;

 private:
  std::vector<QuantileFunction> quantiles_;
  std::vector<bool> correlated_;
  std::vector<std::vector<double>> root_;  // L, row by row up to the diagonal; empty: independent
};

}  // namespace zwidth

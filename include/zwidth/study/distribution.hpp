#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "zwidth/option_problem.hpp"

namespace zwidth {

/// How one number of a device varies from one unit to the next. SI units.
struct Distribution {
  /// Which law.
  enum class Kind {
    normal,      ///< `centre` the mean, `deviation` the standard deviation
    lognormal,   ///< `centre` the median, `deviation` that of the natural logarithm
    uniform,     ///< from `lower` to `upper`
    triangular,  ///< from `lower` to `upper`, likeliest at `centre`
    discrete,    ///< `values`, each as likely as its weight says; so are measured samples
  };
  Kind kind = Kind::normal;  ///< of this one
  double centre = 0.0;       ///< mean, median or mode, as its kind has it
  double deviation = 0.0;    ///< standard deviation, or its logarithm's
  /// A normal or lognormal one is cut off here, what remains scaled to 1.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();  ///< no value is above
  std::vector<double> values = {};                         ///< rising, each once
  std::vector<double> weights = {};                        ///< one per value, > 0; their sum is finite
};

/// The first member that makes no distribution: deviation > 0, lower < upper, values rising, ...
[[nodiscard]] std::optional<OptionProblem> find_problem(const Distribution& distribution);

/// The uniform numbers that a study draws lie in least_uniform..1 - least_uniform: 2^-53, 8.2 standard deviations.
inline constexpr double least_uniform = 0x1p-53;

/// The inverse of a distribution function, with what is computed once for all its values.
class QuantileFunction {
 public:
  /// Throws Error (invalid_argument) where find_problem() finds one.
  explicit QuantileFunction(Distribution distribution);

  /// x with P(X <= x) = u; never beyond the distribution's ends. u is brought to least_uniform..1 - least_uniform.
  [[nodiscard]] double operator()(double u) const;
  /// x with P(X <= x) = Phi(z) for a standard normal number z, exact in both tails for a normal that is not cut off.
  [[nodiscard]] double at_score(double z) const;
  /// The least and the largest value that a study can draw.
  [[nodiscard]] double least() const { return (*this)(0.0); }
  [[nodiscard]] double largest() const { return (*this)(1.0); }  ///< the largest value; infinity where there is none
  /// Whether its ends are its own, not those of the numbers that are drawn.
  [[nodiscard]] bool bounded() const;

  [[nodiscard]] const Distribution& distribution() const { return distribution_; }  ///< that it is of

 private:
  [[nodiscard]] double cut(double score) const;

  Distribution distribution_;
  double below_ = 0.0;              // P(X < lower) of the normal before it is cut
  double above_ = 0.0;              // P(X > upper)
  std::vector<double> cumulative_;  // of the discrete values
};

/// Phi(z) and its inverse, for 0 < u < 1.
[[nodiscard]] double standard_normal_probability(double z);
[[nodiscard]] double standard_normal_score(double u);  ///< z with P(Z < z) = u

}  // namespace zwidth

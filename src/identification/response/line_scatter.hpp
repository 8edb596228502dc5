#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// One line of force and output in each of several repetitions (periods, blocks) p: sums of D = F_p - F_last and
/// E = X_p - X_last. The last repetition as reference keeps the digits of a scatter far smaller than the lines.
struct LineScatter {
  std::complex<double> last_force;
  std::complex<double> last_output;
  std::complex<double> force;   ///< sum D
  std::complex<double> output;  ///< sum E
  double ff = 0.0;              ///< sum |D|^2
  double xx = 0.0;              ///< sum |E|^2
  std::complex<double> xf;      ///< sum E conj D

  void add(std::complex<double> d, std::complex<double> e);
};

/// Mean of F_p over `count` repetitions, the last included, and the variance of one of them.
struct MeanForce {
  std::complex<double> value;
  double variance = 0.0;
};
[[nodiscard]] MeanForce mean_force(const LineScatter& line, double count);

/// H = mean X / mean F, its variance from the scatter of X_p - H F_p, and |mean F|; requires a force other than 0.
[[nodiscard]] ResponsePoint response_point(const LineScatter& line, double count, double frequency);

/// Leading repetitions that are still on their way to the rest: further from the last, in power, than four times the
/// usual. Among few none can be told from the others. `distance`: of all but the last.
[[nodiscard]] std::size_t transient_repetitions(const std::vector<double>& distance);

}  // namespace zwidth::internal

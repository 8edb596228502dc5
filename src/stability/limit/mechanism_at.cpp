#include "stability/limit/mechanism_at.hpp"

#include <algorithm>
#include <complex>

namespace zwidth::internal {

Mechanism mechanism_at(const SampledPlant& plant, double angle) {
  std::complex<double> lag = 0.0;
  int modes = 0;
  for (const SampledTerm& term : plant.terms) {
    if (term.mode < 0) lag = response(term, angle);
    modes = std::max(modes, term.mode);
  }
  Mechanism mechanism;
  double largest = -1.0;
  for (int mode = 0; mode <= modes; ++mode) {
    std::complex<double> sum = 0.0;
    for (const SampledTerm& term : plant.terms) {
      if (term.mode == mode) sum += response(term, angle) + term.lag_share * lag;
    }
    if (std::abs(sum) > largest) {
      largest = std::abs(sum);
      mechanism = {mode == 0 ? Mechanism::Kind::rigid_body : Mechanism::Kind::vibration_mode, mode};
    }
  }
  return mechanism;
}

}  // namespace zwidth::internal

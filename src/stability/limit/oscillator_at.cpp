#include "stability/limit/oscillator_at.hpp"

#include <algorithm>
#include <complex>

namespace zwidth::internal {

Oscillator oscillator_at(const SampledPlant& plant, double angle) {
  std::complex<double> lag = 0.0;
  int modes = 0;
  const SampledTerm* tracking = nullptr;
  for (const SampledTerm& term : plant.terms) {
    if (term.mode == -1) lag = response(term, angle);
    if (term.mode == -2) tracking = &term;
    modes = std::max(modes, term.mode);
  }
  const auto tracked = [&](const SampledTerm& term) -> std::complex<double> {
    if (tracking == nullptr || tracking->degree != 2) return 0.0;
    SampledTerm part = *tracking;
    std::copy_n(term.tracking_numerator, 3, part.numerator);
    return response(part, angle);
  };
  Oscillator oscillator;
  double largest = -1.0;
  for (int mode = 0; mode <= modes; ++mode) {
    std::complex<double> sum = 0.0;
    for (const SampledTerm& term : plant.terms) {
      if (term.mode == mode) sum += response(term, angle) + term.lag_share * lag + tracked(term);
    }
    if (std::abs(sum) > largest) {
      largest = std::abs(sum);
      oscillator = {mode == 0 ? Oscillator::Kind::rigid_body : Oscillator::Kind::vibration_mode, mode};
    }
  }
  return oscillator;
}

}  // namespace zwidth::internal

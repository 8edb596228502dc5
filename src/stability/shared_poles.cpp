#include "stability/shared_poles.hpp"

#include <algorithm>

namespace zwidth::internal {

void SharedPoles::add(const ModalForm& form) {
  if (forms_.empty()) {
    for (const ModalTerm& term : form.terms) pairs_.push_back({term.denominator[0], term.denominator[1], {}});
  }
  are_shared_ = are_shared_ && form.terms.size() == pairs_.size();
  for (std::size_t i = 0; i < form.terms.size() && are_shared_; ++i) {
    const ModalTerm& term = form.terms[i];
    are_shared_ = term.degree == 2 && term.denominator[0] == pairs_[i].d0 && term.denominator[1] == pairs_[i].d1;
    pairs_[i].numerators.insert(pairs_[i].numerators.end(), {term.numerator[0], term.numerator[1]});
  }
  forms_.push_back(form);
}

void SharedPoles::responses(double frequency, std::complex<double>* values) const {
  constexpr double least = 1e-200;  // of a denominator's square
  constexpr double most = 1e200;
  const auto each_alone = [&] {
    for (std::size_t k = 0; k < forms_.size(); ++k) values[k] = response(forms_[k], frequency);
  };
  if (!are_shared_) return each_alone();
  std::fill(values, values + forms_.size(), 0.0);
  for (const Pair& pair : pairs_) {
    const double real = pair.d0 - frequency * frequency;
    const double imaginary = pair.d1 * frequency;
    const double size = real * real + imaginary * imaginary;
    if (!(size > least && size < most)) return each_alone();
    const double scale = 1.0 / size;
    const double* numerator = pair.numerators.data();
    for (std::size_t k = 0; k < forms_.size(); ++k, numerator += 2) {
      const double turning = numerator[1] * frequency;
      values[k] += std::complex<double>((numerator[0] * real + turning * imaginary) * scale,
                                        (turning * real - numerator[0] * imaginary) * scale);
    }
  }
}

}  // namespace zwidth::internal

#include "stability/users/shared_poles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace zwidth::internal {
namespace {

constexpr double kept = 1e-6;  // of the terms' sizes

double one_norm(std::complex<double> value) { return std::abs(value.real()) + std::abs(value.imag()); }

}  // namespace

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

bool SharedPoles::responses(double frequency, std::complex<double>* values) const {
  constexpr double least = 1e-200;  // of a denominator's square
  constexpr double most = 1e200;
  if (!are_shared_) return sum_each(frequency, values);
  const std::size_t count = forms_.size();
  std::array<double, 8> few{};
  std::vector<double> many(count > few.size() ? count : 0, 0.0);
  double* const sizes = count > few.size() ? many.data() : few.data();  // of all terms, added up
  std::fill(values, values + count, 0.0);
  for (const Pair& pair : pairs_) {
    const double real = pair.d0 - frequency * frequency;
    const double imaginary = pair.d1 * frequency;
    const double size = real * real + imaginary * imaginary;
    if (!(size > least && size < most)) return sum_each(frequency, values);
    const double scale = 1.0 / size;
    const double* numerator = pair.numerators.data();
    for (std::size_t k = 0; k < count; ++k, numerator += 2) {
      const double turning = numerator[1] * frequency;
      const std::complex<double> term((numerator[0] * real + turning * imaginary) * scale,
                                      (turning * real - numerator[0] * imaginary) * scale);
      values[k] += term;
      sizes[k] += one_norm(term);
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    if (!(one_norm(values[k]) >= kept * sizes[k])) return false;
  }
  return true;
}

bool SharedPoles::sum_each(double frequency, std::complex<double>* values) const {
  bool all_kept = true;
  for (std::size_t k = 0; k < forms_.size(); ++k) {
    values[k] = response(forms_[k], frequency);
    double size = 0.0;
    for (const ModalTerm& term : forms_[k].terms) size += one_norm(response(term, frequency));
    all_kept = all_kept && one_norm(values[k]) >= kept * size;
  }
  return all_kept;
}

}  // namespace zwidth::internal

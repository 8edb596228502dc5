#include "model/partial_fractions.hpp"

#include "counted.hpp"

namespace zwidth::internal::partial_fractions {
namespace {

PolynomialX times_root(const PolynomialX& p, const ComplexX& root) {
  PolynomialX result(p.size() + 1);
  for (std::size_t i = 0; i < p.size(); ++i) {
    result[i + 1] += p[i];
    result[i] -= p[i] * root;
  }
  return result;
}

// Numerator size in units that compare between terms: acceleration per force near the term's own frequency.
double weight(const ModalTerm& term, double frequency) {
  double sum = 0.0;
  for (std::size_t i = 0; i < term.degree; ++i) {
    sum += std::abs(term.numerator[i]) *
           std::pow(frequency, static_cast<double>(i) + 2.0 - static_cast<double>(term.degree));
  }
  return sum;
}

}  // namespace

PolynomialX expand_product(const std::vector<ComplexX>& roots) {
  PolynomialX p{ComplexX(Extended(1.0))};
  for (const ComplexX& root : roots) p = times_root(p, root);
  return p;
}

PolynomialX multiply(const PolynomialX& a, const PolynomialX& b) {
  PolynomialX result(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  return result;
}

PolynomialX shifted(const PolynomialX& p, const ComplexX& center) {
  PolynomialX result{p.back()};
  for (std::size_t i = p.size() - 1; i-- > 0;) {
    result = times_root(result, center);
    result[0] += p[i];
  }
  return result;
}

ComplexX product(const std::vector<ComplexX>& roots, const ComplexX& s) {
  ComplexX p = s - roots[0];
  for (std::size_t i = 1; i < roots.size(); ++i) p *= s - roots[i];
  return p;
}

PolynomialX from_power_sums(const std::vector<ComplexX>& sums) {
  const std::size_t k = sums.size();
  std::vector<ComplexX> elementary(k + 1);
  elementary[0] = ComplexX(Extended(1.0));
  for (std::size_t j = 1; j <= k; ++j) {
    ComplexX sum;
    for (std::size_t i = 1; i <= j; ++i) {
      const ComplexX term = elementary[j - i] * sums[i - 1];
      sum = i % 2 == 1 ? sum + term : sum - term;
    }
    elementary[j] = sum * (Extended(1.0) / Extended(static_cast<double>(j)));
  }
  PolynomialX p(k + 1);
  for (std::size_t j = 0; j <= k; ++j) p[k - j] = j % 2 == 0 ? elementary[j] : ComplexX() - elementary[j];
  return p;
}

std::vector<ComplexX> directions(std::size_t count) {
  std::vector<ComplexX> result;
  const auto n = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * (static_cast<double>(i) + 0.5) / n;
    ComplexX z{Extended(std::cos(angle)), Extended(std::sin(angle))};
    // One Newton step on z^n = -1 takes the direction from double to double-double.
    ComplexX power = z;
    for (std::size_t j = 1; j < count; ++j) power *= z;
    const ComplexX residual{power.re + Extended(1.0), power.im};
    z -= residual * z / (power * Extended(n));
    result.push_back(z);
  }
  return result;
}

void cancel_common_factors(PolynomialX& numerator, PolynomialX& denominator, double scale) {
  while (numerator.size() > 1) {
    double size = 0.0;
    double power = scale;
    for (std::size_t j = 1; j < numerator.size(); ++j, power *= scale) {
      size = std::max(size, magnitude(numerator[j]) * power);
    }
    if (magnitude(numerator[0]) > cancel_below * size) return;
    numerator.erase(numerator.begin());
    denominator.erase(denominator.begin());
  }
}

double isolation(const PoleGroup& group, const std::vector<ComplexX>& all_poles) {
  double nearest = std::numeric_limits<double>::infinity();
  double size = 0.0;
  for (const ComplexX& own : group.poles) size = std::max(size, magnitude(own));
  for (const ComplexX& other : all_poles) {
    double distance = std::numeric_limits<double>::infinity();
    for (const ComplexX& own : group.poles) distance = std::min(distance, magnitude(own - other));
    if (distance > 0.0) nearest = std::min(nearest, distance);
  }
  if (std::isfinite(nearest)) return nearest;
  return size > 0.0 ? size : 1.0;
}

ModalTerm real_term(const PoleGroup& group, PolynomialX numerator, PolynomialX denominator) {
  if (!group.closed) {  // N/p + N*/p*
    PolynomialX conjugate = denominator;
    for (ComplexX& c : conjugate) c = conj(c);
    numerator = multiply(numerator, conjugate);
    for (ComplexX& c : numerator) c = {c.re * Extended(2.0), Extended(0.0)};
    denominator = multiply(denominator, conjugate);
  }
  ModalTerm term;
  term.degree = denominator.size() - 1;
  term.mode = group.mode;
  if (term.degree > ModalTerm::max_degree) {
    throw Error(ErrorCode::did_not_converge,
                {.code = ProblemCode::too_many_poles_coincide, .evidence = {counted("most", ModalTerm::max_degree)}});
  }
  // Poles of a cluster are known to fewer digits.
  const double on_axis = group.cluster ? 1e-7 : 0.0;
  for (const ComplexX& pole : group.poles) {
    const double re = leading(pole.re);
    const double size = magnitude(pole);
    if (size == 0.0) continue;
    if (std::abs(re) <= on_axis * size && !group.closed) {
      ++term.undamped_pairs;
    } else if (re > 0.0) {
      term.unstable_poles += group.closed ? 1 : 2;
    }
  }
  term.undamped_pairs = std::min(term.undamped_pairs, static_cast<int>(term.degree) / 2);  // less what cancelled
  if (term.undamped_pairs > 0) term.undamped_frequency = std::abs(leading(group.poles.front().im));
  while (static_cast<std::size_t>(term.integrators) < term.degree &&
         magnitude(denominator[static_cast<std::size_t>(term.integrators)]) == 0.0) {
    ++term.integrators;
  }
  for (std::size_t i = 0; i < term.degree; ++i) {
    term.numerator[i] = i < numerator.size() ? leading(numerator[i].re) : 0.0;
    term.denominator[i] = leading(denominator[i].re);
    if (i < numerator.size()) term.numerator_rest[i] = leading(numerator[i].re - Extended(term.numerator[i]));
    term.denominator_rest[i] = leading(denominator[i].re - Extended(term.denominator[i]));
    if (!std::isfinite(term.numerator[i]) || !std::isfinite(term.denominator[i])) {
      throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::poles_not_found});
    }
  }
  return term;
}

void clear_unseen(ModalForm& form) {
  std::vector<double> weights;
  for (const ModalTerm& term : form.terms) {
    const double frequency = term.mode > 0
                                 ? form.modes[static_cast<std::size_t>(term.mode) - 1].frequency
                                 : std::pow(std::abs(term.denominator[0]), 1.0 / static_cast<double>(term.degree));
    weights.push_back(weight(term, frequency > 0.0 ? frequency : 1.0));
  }
  const double largest = *std::max_element(weights.begin(), weights.end());
  for (std::size_t i = 0; i < form.terms.size(); ++i) {
    ModalTerm& term = form.terms[i];
    if (term.mode > 0 && weights[i] <= unseen_below * largest) {
      std::fill_n(term.numerator, term.degree, 0.0);
      std::fill_n(term.numerator_rest, term.degree, 0.0);
    }
  }
}

namespace {

// c0 + c1 s modulo a term's denominator s² + d1 s + d0.
struct Remainder {
  double c0 = 0.0;
  double c1 = 0.0;

  [[nodiscard]] double at(double s) const { return c0 + c1 * s; }
};

Remainder multiply(const Remainder& a, const Remainder& b, const ModalTerm& term) {
  const double square = a.c1 * b.c1;
  return {a.c0 * b.c0 - square * term.denominator[0], a.c0 * b.c1 + a.c1 * b.c0 - square * term.denominator[1]};
}

// 1/(1 + a s)
Remainder inverse(double a, const ModalTerm& term) {
  const double norm = 1.0 - a * term.denominator[1] + a * a * term.denominator[0];
  return {(1.0 - a * term.denominator[1]) / norm, -a / norm};
}

// The mode's numerator without the drive: N/E mod D.
Remainder without_drive(const ModalTerm& term, const DrivePath& drive) {
  Remainder n{term.numerator[0], term.numerator[1]};
  n = multiply(n, {1.0, drive.lag}, term);
  if (drive.tracking == 0.0) return n;
  const Remainder below{1.0, 1.0 / drive.tracking};
  return multiply(multiply(n, multiply(below, below, term), term), inverse(2.0 / drive.tracking, term), term);
}

}  // namespace

void share_drive(ModalForm& form, const DrivePath& drive) {
  if (drive.is_ideal()) return;
  for (ModalTerm& term : form.terms) {
    if (term.mode < 0 || term.degree != 2) continue;
    const Remainder n = without_drive(term, drive);
    const auto below = [&](double s) { return term.denominator[0] + s * (term.denominator[1] + s); };
    if (drive.lag > 0.0) {  // the residue of N E/D at s = -1/lag
      const double s = -1.0 / drive.lag;
      const double ratio = drive.tracking > 0.0 ? s / drive.tracking : 0.0;
      const double tracked = (1.0 + 2.0 * ratio) / ((1.0 + ratio) * (1.0 + ratio));
      term.lag_numerator = n.at(s) / below(s) * tracked / drive.lag;
    }
    if (drive.tracking > 0.0) {  // g + g' (s + w) at s = -w, g = N/D (2 w s + w²)/(lag s + 1)
      const double w = drive.tracking;
      const double d = below(-w);
      const double lagged = 1.0 - drive.lag * w;
      const double g = -w * w * n.at(-w) / d / lagged;
      const double slope = -w * w * (n.c1 - n.at(-w) * (term.denominator[1] - 2.0 * w) / d) / d / lagged +
                           n.at(-w) / d * (2.0 * w / lagged + w * w * drive.lag / (lagged * lagged));
      term.tracking_numerator[0] = g + w * slope;
      term.tracking_numerator[1] = slope;
    }
  }
}

}  // namespace zwidth::internal::partial_fractions

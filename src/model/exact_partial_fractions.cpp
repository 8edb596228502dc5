#include "model/exact_partial_fractions.hpp"

#include <acb_poly.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "counted.hpp"
#include "model/exact_modal_form.hpp"
#include "model/exact_poles.hpp"
#include "model/partial_fractions.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using ComplexX = Complex<Extended>;

constexpr slong first_precision = 256;  // bits
// Terms that exceed their sum by more than this leave too few digits to whoever adds them up in double.
constexpr double carried_cancellation = 1e7;
// A pole of a transfer function that is this close to the imaginary axis, relative, is on it: its coefficients are not
// known better. Where poles crowd they respond more to those numbers. Of bodies the damping is what the dampers make it.
constexpr double undamped_in_cluster_below = 1e-7;
constexpr double undamped_body_below = 1e-60;

// A set of poles and what they contribute: numerator / denominator.
struct Fraction {
  RealBallPolynomial numerator;
  RealBallPolynomial denominator;
  std::vector<std::size_t> poles;
  int mode = 0;

  [[nodiscard]] std::size_t degree() const { return static_cast<std::size_t>(arb_poly_degree(denominator)); }
};

void add(Fraction& a, const Fraction& b, slong precision) {
  if (a.poles.empty()) {
    const int mode = a.mode;
    a = b;
    a.mode = mode;
    return;
  }
  RealBallPolynomial other;
  arb_poly_mul(other, b.numerator, a.denominator, precision);
  arb_poly_mul(a.numerator, a.numerator, b.denominator, precision);
  arb_poly_add(a.numerator, a.numerator, other, precision);
  arb_poly_mul(a.denominator, a.denominator, b.denominator, precision);
  a.poles.insert(a.poles.end(), b.poles.begin(), b.poles.end());
}

// The part of N/p at one pole of multiplicity m: with s = pole + e, N / (p e^-m) = a_0 + a_1 e + ...,
// the part is sum_{k < m} a_k e^(k - m); of a complex pole, plus its conjugate.
Fraction part_at(const ExactFraction& g, const ExactPole& pole, std::size_t index, slong precision) {
  const slong m = pole.multiplicity;
  ComplexBallPolynomial numerator;
  ComplexBallPolynomial denominator;
  acb_poly_set_fmpz_poly(numerator, g.numerator, precision);
  acb_poly_set_fmpz_poly(denominator, g.denominator, precision);
  acb_poly_taylor_shift(numerator, numerator, pole.at, precision);
  acb_poly_taylor_shift(denominator, denominator, pole.at, precision);
  acb_poly_shift_right(denominator, denominator, m);  // these coefficients are zero: the multiplicity is exact
  ComplexBallPolynomial series;
  acb_poly_div_series(series, numerator, denominator, m, precision);
  ComplexBall scale;
  acb_one(scale);
  acb_mul_2exp_si(scale, scale, g.exponent);
  acb_poly_scalar_mul(series, series, scale, precision);
  ComplexBall back;
  acb_neg(back, pole.at);
  acb_poly_taylor_shift(series, series, back, precision);

  Fraction part;
  part.poles.push_back(index);
  const auto real_part = [](RealBallPolynomial& real, const ComplexBallPolynomial& p) {
    ComplexBall c;
    arb_poly_zero(real);
    for (slong i = 0; i < acb_poly_length(p); ++i) {
      acb_poly_get_coeff_acb(c, p, i);
      arb_poly_set_coeff_arb(real, i, acb_realref(c));
    }
  };
  ComplexBallPolynomial factor;  // s - conj(pole), or s - pole where that is real
  ComplexBall root;
  acb_conj(root, pole.at);
  acb_neg(root, root);
  acb_poly_set_coeff_acb(factor, 0, root);
  acb_poly_set_coeff_si(factor, 1, 1);
  ComplexBallPolynomial power;
  acb_poly_pow_ui(power, factor, static_cast<ulong>(m), precision);
  if (pole.is_real) {
    real_part(part.denominator, power);
    real_part(part.numerator, series);
    return part;
  }
  acb_poly_mul(series, series, power, precision);
  real_part(part.numerator, series);
  arb_poly_scalar_mul_2exp_si(part.numerator, part.numerator, 1);
  RealBallPolynomial pair;  // s² - 2 Re s + |pole|²
  RealBall coefficient;
  arb_mul(coefficient, acb_realref(pole.at), acb_realref(pole.at), precision);
  arb_addmul(coefficient, acb_imagref(pole.at), acb_imagref(pole.at), precision);
  arb_poly_set_coeff_arb(pair, 0, coefficient);
  arb_mul_2exp_si(coefficient, acb_realref(pole.at), 1);
  arb_neg(coefficient, coefficient);
  arb_poly_set_coeff_arb(pair, 1, coefficient);
  arb_poly_set_coeff_si(pair, 2, 1);
  arb_poly_pow_ui(part.denominator, pair, static_cast<ulong>(m), precision);
  return part;
}

// log2 |N(jw) / D(jw)|, to a bit; nothing where D or the precision fails.
std::optional<double> log_magnitude(const RealBallPolynomial& numerator, const RealBallPolynomial& denominator,
                                    double frequency, slong precision) {
  ComplexBall s;
  arb_set_d(acb_imagref(s), frequency);
  ComplexBall above;
  ComplexBall below;
  arb_poly_evaluate_acb(above, numerator, s, precision);
  arb_poly_evaluate_acb(below, denominator, s, precision);
  acb_div(above, above, below, precision);
  RealBall size;
  acb_abs(size, above, precision);
  if (!arb_is_finite(size) || arb_contains_zero(size) || arb_rel_accuracy_bits(size) < 4) return std::nullopt;
  arb_log(size, size, 64);
  return arf_get_d(arb_midref(size), ARF_RND_NEAR) / std::log(2.0);
}

// Joins the fractions that cancel most until none exceeds the sum by `joined_above`. Returns the cancellation left.
double join(std::vector<Fraction>& fractions, const ExactFraction& g, const std::vector<double>& frequencies,
            slong precision) {
  RealBallPolynomial numerator;
  RealBallPolynomial denominator;
  arb_poly_set_fmpz_poly(numerator, g.numerator, precision);
  arb_poly_set_fmpz_poly(denominator, g.denominator, precision);
  arb_poly_scalar_mul_2exp_si(numerator, numerator, g.exponent);
  struct Sample {
    double frequency;
    double size;  // log2 |G|
  };
  std::vector<Sample> samples;
  double largest_sum = -1e300;
  for (const double frequency : frequencies) {
    const std::optional<double> sum = log_magnitude(numerator, denominator, frequency, precision);
    if (!sum) continue;
    samples.push_back({frequency, *sum});
    largest_sum = std::max(largest_sum, *sum);
  }
  std::erase_if(samples, [&](const Sample& at) { return at.size < largest_sum + std::log2(irrelevant_below); });
  while (true) {
    double worst = 0.0;  // log2 of the cancellation
    std::size_t first = 0;
    std::size_t second = 0;
    for (const auto& [frequency, sum] : samples) {
      std::size_t largest = fractions.size();
      double size = 0.0;
      std::vector<double> sizes(fractions.size(), -1e300);
      for (std::size_t i = 0; i < fractions.size(); ++i) {
        const auto part = log_magnitude(fractions[i].numerator, fractions[i].denominator, frequency, precision);
        if (!part) continue;
        sizes[i] = *part;
        if (largest == fractions.size() || *part > size) {
          largest = i;
          size = *part;
        }
      }
      if (largest == fractions.size() || size - sum <= worst) continue;
      worst = size - sum;
      // What cancels the largest: the next largest that fits.
      first = second = largest;
      for (std::size_t i = 0; i < fractions.size(); ++i) {
        if (i == largest || fractions[i].degree() + fractions[largest].degree() > ModalTerm::max_degree) continue;
        if (second == largest || sizes[i] > sizes[second]) second = i;
      }
    }
    if (worst <= std::log2(joined_above) || first == second) return std::exp2(worst);
    if (first > second) std::swap(first, second);
    if (fractions[first].mode < 0) fractions[first].mode = fractions[second].mode;
    if (fractions[second].mode >= 0) fractions[first].mode = std::min(fractions[first].mode, fractions[second].mode);
    add(fractions[first], fractions[second], precision);
    fractions.erase(fractions.begin() + static_cast<std::ptrdiff_t>(second));
  }
}

std::optional<ModalTerm> rounded_term(const Fraction& fraction, const std::vector<ExactPole>& poles, bool has_bodies) {
  double largest = 0.0;
  for (const std::size_t i : fraction.poles) largest = std::max(largest, magnitude(poles[i].rounded));
  const double scale = largest > 0.0 ? largest : 1.0;
  ModalTerm term;
  term.degree = fraction.degree();
  term.mode = fraction.mode;
  const auto numerator = rounded_coefficients(fraction.numerator, term.degree, scale);
  const auto denominator = rounded_coefficients(fraction.denominator, term.degree, scale);
  if (!numerator || !denominator) return std::nullopt;
  for (std::size_t i = 0; i < term.degree; ++i) {
    term.numerator[i] = leading((*numerator)[i]);
    term.numerator_rest[i] = leading((*numerator)[i] - Extended(term.numerator[i]));
    term.denominator[i] = leading((*denominator)[i]);
    term.denominator_rest[i] = leading((*denominator)[i] - Extended(term.denominator[i]));
    if (!std::isfinite(term.numerator[i]) || !std::isfinite(term.denominator[i])) {
      throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::poles_not_found});
    }
  }
  for (const std::size_t i : fraction.poles) {
    const ExactPole& pole = poles[i];
    const double size = magnitude(pole.rounded);
    const auto copies = static_cast<int>(pole.multiplicity);
    if (size == 0.0) {
      term.integrators = copies;
      continue;
    }
    const bool crowded = std::any_of(poles.begin(), poles.end(), [&](const ExactPole& other) {
      return &other != &pole && magnitude(other.rounded - pole.rounded) <= cluster_tolerance * size;
    });
    const double re = leading(pole.rounded.re);
    const double on_axis = has_bodies ? undamped_body_below : crowded ? undamped_in_cluster_below : undamped_below;
    if (!pole.is_real && std::abs(re) <= on_axis * size) {
      term.undamped_pairs += copies;
      term.undamped_frequency = std::abs(leading(pole.rounded.im));
    } else if (re > 0.0) {
      term.unstable_poles += pole.is_real ? copies : 2 * copies;
    }
  }
  return term;
}

// Which poles share a term to begin with, and its mode: the groups of the ordinary route. Poles that the path does not
// see are in no fraction.
std::vector<Fraction> group(const std::vector<ExactPole>& seen, const std::vector<ExactPole>& all,
                            const DrivePath& drive, const PoleLabels& labels, ModalForm& form) {
  std::vector<ComplexX> poles;
  std::size_t zeros = 0;
  const std::vector<DrivePole> of_drive = poles_of(drive);
  std::vector<slong> left;  // of each pole's copies those that are the device's own
  for (const ExactPole& pole : all) left.push_back(pole.multiplicity);
  for (const DrivePole& each : of_drive) {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < all.size(); ++i) {
      if (magnitude(all[i].rounded - each.at) < magnitude(all[nearest].rounded - each.at)) nearest = i;
    }
    left[nearest] -= static_cast<slong>(each.copies);
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    const ExactPole& pole = all[k];
    if (magnitude(pole.rounded) == 0.0) {
      zeros = static_cast<std::size_t>(pole.multiplicity);
      continue;
    }
    for (slong i = 0; i < left[k]; ++i) {
      poles.push_back(pole.rounded);
      if (!pole.is_real) poles.push_back(conj(pole.rounded));
    }
  }
  std::vector<PoleGroup> groups = group_poles(poles, zeros, labels, form);
  for (const DrivePole& each : of_drive) add_drive_pole(groups, each);

  std::vector<Fraction> fractions(groups.size());
  for (std::size_t k = 0; k < groups.size(); ++k) fractions[k].mode = groups[k].mode;
  // Each pole goes to the group that holds the nearest one; the copies of a multiple pole stay together.
  for (std::size_t i = 0; i < seen.size(); ++i) {
    std::size_t nearest = 0;
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < groups.size(); ++k) {
      for (const ComplexX& own : groups[k].poles) {
        const double here = magnitude(own - seen[i].rounded);
        if (here >= distance) continue;
        distance = here;
        nearest = k;
      }
    }
    fractions[nearest].poles.push_back(i);
  }
  std::erase_if(fractions, [](const Fraction& fraction) { return fraction.poles.empty(); });
  return fractions;
}

// All terms at a given precision; nothing where it does not suffice.
std::optional<ModalForm> expand(const ExactFraction& whole, const ExactFraction& seen, const DrivePath& drive,
                                const PoleLabels& labels, slong precision, KnownPoles& known) {
  const std::optional<std::vector<ExactPole>>& all = known.of(whole.denominator, precision);
  const bool some_unseen = fmpz_poly_degree(seen.denominator) < fmpz_poly_degree(whole.denominator);
  const std::optional<std::vector<ExactPole>>& found = some_unseen ? known.of(seen.denominator, precision) : all;
  if (!all || !found) return std::nullopt;
  const std::vector<ExactPole>& poles = *found;
  ModalForm form;
  std::vector<Fraction> fractions = group(poles, *all, drive, labels, form);
  for (Fraction& fraction : fractions) {
    Fraction sum;
    sum.mode = fraction.mode;
    for (const std::size_t i : fraction.poles) add(sum, part_at(seen, poles[i], i, precision), precision);
    fraction = sum;
  }
  std::vector<double> frequencies;
  for (const ExactPole& pole : poles) {
    if (magnitude(pole.rounded) > 0.0) frequencies.push_back(magnitude(pole.rounded));
  }
  const double cancellation = join(fractions, seen, frequencies, precision);
  for (const Fraction& fraction : fractions) {
    if (fraction.degree() > ModalTerm::max_degree) {
      throw Error(ErrorCode::did_not_converge,
                  {.code = ProblemCode::too_many_poles_coincide, .evidence = {counted("most", ModalTerm::max_degree)}});
    }
    std::optional<ModalTerm> term = rounded_term(fraction, poles, labels.has_bodies);
    if (!term) return std::nullopt;
    form.terms.push_back(*term);
  }
  if (cancellation > carried_cancellation) {
    throw Error(ErrorCode::did_not_converge,
                {.code = ProblemCode::too_many_poles_cancel,
                 .evidence = {counted("most", ModalTerm::max_degree), {"cancellation", cancellation}}});
  }
  return form;
}

}  // namespace

namespace {

// (slope s + constant) 2^shift, whole for the shift that is returned.
long whole_factor(double slope, double constant, IntegerPolynomial& result) {
  long shift = 0;
  for (const double each : {slope, constant}) {
    int exponent = 0;
    std::frexp(each, &exponent);
    shift = std::max(shift, 53L - exponent);
  }
  RealBallPolynomial factor;
  RealBall coefficient;
  arb_set_d(coefficient, slope);
  arb_poly_set_coeff_arb(factor, 1, coefficient);
  arb_set_d(coefficient, constant);
  arb_poly_set_coeff_arb(factor, 0, coefficient);
  arb_poly_scalar_mul_2exp_si(factor, factor, shift);
  arb_poly_get_unique_fmpz_poly(result, factor);
  return shift;
}

// Times E(s).
void pass(ExactFraction& fraction, const DrivePath& drive) {
  IntegerPolynomial factor;
  if (drive.lag > 0.0) {
    fraction.exponent += whole_factor(drive.lag, 1.0, factor);
    fmpz_poly_mul(fraction.denominator, fraction.denominator, factor);
  }
  if (drive.tracking > 0.0) {  // w (2 s + w) / (s + w)²
    fraction.exponent += 2 * whole_factor(1.0, drive.tracking, factor);
    fmpz_poly_mul(fraction.denominator, fraction.denominator, factor);
    fmpz_poly_mul(fraction.denominator, fraction.denominator, factor);
    fraction.exponent -= whole_factor(2.0, drive.tracking, factor);
    fmpz_poly_mul(fraction.numerator, fraction.numerator, factor);
    fraction.exponent -= whole_factor(0.0, drive.tracking, factor);
    fmpz_poly_mul(fraction.numerator, fraction.numerator, factor);
  }
}

}  // namespace

ModalForm exact_partial_fractions(ExactFraction fraction, const DrivePath& drive, const PoleLabels& labels,
                                  KnownPoles& known) {
  pass(fraction, drive);
  // What numerator and denominator have in common the path does not see.
  ExactFraction seen = fraction;
  IntegerPolynomial common;
  fmpz_poly_gcd(common, fraction.numerator, fraction.denominator);
  if (fmpz_poly_degree(common) > 0) {
    fmpz_poly_div(seen.numerator, fraction.numerator, common);
    fmpz_poly_div(seen.denominator, fraction.denominator, common);
  }
  for (slong precision = first_precision; precision <= most_precision; precision *= 2) {
    std::optional<ModalForm> form = expand(fraction, seen, drive, labels, precision, known);
    if (!form) continue;
    partial_fractions::share_drive(*form, drive);
    return *form;
  }
  throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::modes_not_told_apart});
}

}  // namespace zwidth::internal

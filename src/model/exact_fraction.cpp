#include "model/exact_fraction.hpp"

#include <flint/fmpz_poly_mat.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "counted.hpp"
#include "model/device_matrices.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

// The exact determinant grows like the fourth power of their number: seconds beyond it.
constexpr std::size_t max_exact_bodies = 40;

using Integer = FlintValue<fmpz, fmpz_init, fmpz_clear, fmpz_set>;

// value = mantissa 2^exponent, mantissa odd or zero.
struct Binary {
  std::int64_t mantissa = 0;
  long exponent = 0;
};

Binary binary(double value) {
  if (value == 0.0) return {};
  int exponent = 0;
  Binary result{static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53)), 0};
  result.exponent = exponent - 53;
  while (result.mantissa % 2 == 0) {
    result.mantissa /= 2;
    ++result.exponent;
  }
  return result;
}

// A sum of doubles without rounding, as device_matrices() needs it.
class ExactSum {
 public:
  explicit ExactSum(double value) { *this += value; }
  ExactSum& operator+=(const ExactSum& other) {
    arf_add(arb_midref(sum_), arb_midref(sum_), arb_midref(other.sum_), ARF_PREC_EXACT, ARF_RND_DOWN);
    return *this;
  }

  friend ExactSum operator*(const ExactSum& a, const ExactSum& b) {
    ExactSum product(0.0);
    arf_mul(arb_midref(product.sum_), arb_midref(a.sum_), arb_midref(b.sum_), ARF_PREC_EXACT, ARF_RND_DOWN);
    return product;
  }

  // Exponent of the last bit.
  [[nodiscard]] long last_bit() const {
    if (arf_is_zero(arb_midref(sum_))) return std::numeric_limits<long>::max();
    Integer mantissa;
    Integer exponent;
    arf_get_fmpz_2exp(mantissa, exponent, arb_midref(sum_));
    return fmpz_get_si(exponent);
  }
  // times 2^-shift, an integer
  void get(fmpz* integer, long shift) const {
    RealBall scaled;
    arf_mul_2exp_si(arb_midref(scaled), arb_midref(sum_), -shift);
    arf_get_fmpz(integer, arb_midref(scaled), ARF_RND_DOWN);
  }

 private:
  ExactSum& operator+=(double value) {
    RealBall ball;
    arf_set_d(arb_midref(ball), value);
    arf_add(arb_midref(sum_), arb_midref(sum_), arb_midref(ball), ARF_PREC_EXACT, ARF_RND_DOWN);
    return *this;
  }

  RealBall sum_;
};

// Coefficients by descending powers; returns the exponent of two that was divided out.
long set_polynomial(IntegerPolynomial& p, const std::vector<double>& coefficients) {
  long lowest = std::numeric_limits<long>::max();
  for (const double c : coefficients) {
    if (c != 0.0) lowest = std::min(lowest, binary(c).exponent);
  }
  if (lowest == std::numeric_limits<long>::max()) return 0;
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const Binary c = binary(coefficients[i]);
    if (c.mantissa == 0) continue;
    Integer integer;
    fmpz_set_si(integer, c.mantissa);
    fmpz_mul_2exp(integer, integer, static_cast<ulong>(c.exponent - lowest));
    fmpz_poly_set_coeff_fmpz(p, static_cast<slong>(coefficients.size() - 1 - i), integer);
  }
  return lowest;
}

class PolynomialMatrix {
 public:
  explicit PolynomialMatrix(std::size_t size) {
    fmpz_poly_mat_init(matrix_, static_cast<slong>(size), static_cast<slong>(size));
  }
  PolynomialMatrix(const PolynomialMatrix&) = delete;
  PolynomialMatrix& operator=(const PolynomialMatrix&) = delete;
  ~PolynomialMatrix() { fmpz_poly_mat_clear(matrix_); }
  fmpz_poly_struct* operator()(std::size_t i, std::size_t j) {
    return fmpz_poly_mat_entry(matrix_, static_cast<slong>(i), static_cast<slong>(j));
  }
  void determinant(IntegerPolynomial& result) const { fmpz_poly_mat_det(result, matrix_); }

 private:
  fmpz_poly_mat_t matrix_ = {};
};

// Weights times 2^-e into a row or column of integers; returns e.
template <typename Border>
long set_border(const Weights& weights, const Border& border) {
  long lowest = std::numeric_limits<long>::max();
  for (const auto& [of, weight] : weights) lowest = std::min(lowest, ExactSum(weight).last_bit());
  Integer integer;
  for (const auto& [of, weight] : weights) {
    ExactSum(weight).get(integer, lowest);
    fmpz_poly_set_coeff_fmpz(border(of), 0, integer);
  }
  return lowest;
}

}  // namespace

ExactFraction exact_fraction(const TransferFunction& transfer_function) {
  ExactFraction result;
  const long above = set_polynomial(result.numerator, transfer_function.numerator);
  const long below = set_polynomial(result.denominator, transfer_function.denominator);
  result.exponent = above - below;
  return result;
}

// Q(s) = M s² + D s + K: G = -det [Q w_force; w_position' 0] / det Q.
ExactFraction exact_fraction(const Device& device, const WeightedPath& path, IntegerPolynomial& denominator) {
  const std::size_t n = device.degrees_of_freedom();
  if (n > max_exact_bodies) {
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::modes_too_close_for_digits,
                                              .evidence = {counted("bodies", n), counted("most", max_exact_bodies)}});
  }
  const DeviceMatrices<ExactSum> m = device_matrices<ExactSum>(device);
  long lowest = std::numeric_limits<long>::max();
  for (const auto* entries : {&m.mass, &m.coupling, &m.damping, &m.stiffness}) {
    for (const ExactSum& entry : *entries) lowest = std::min(lowest, entry.last_bit());
  }
  PolynomialMatrix dynamic(n);
  PolynomialMatrix bordered(n + 1);
  Integer integer;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      m.stiffness[i * n + j].get(integer, lowest);
      fmpz_poly_set_coeff_fmpz(dynamic(i, j), 0, integer);
      m.damping[i * n + j].get(integer, lowest);
      fmpz_poly_set_coeff_fmpz(dynamic(i, j), 1, integer);
    }
    m.mass[i].get(integer, lowest);
    fmpz_poly_set_coeff_fmpz(dynamic(i, i), 2, integer);
  }
  for (std::size_t i = 0; i < m.coupling.size(); ++i) {
    if (i % (n + 1) == 0) continue;
    m.coupling[i].get(integer, lowest);
    fmpz_poly_set_coeff_fmpz(dynamic(i / n, i % n), 2, integer);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) fmpz_poly_set(bordered(i, j), dynamic(i, j));
  }
  const long of_force = set_border(path.force_at, [&](std::size_t i) { return bordered(i, n); });
  const long of_position = set_border(path.position_of, [&](std::size_t j) { return bordered(n, j); });
  ExactFraction result;
  if (fmpz_poly_degree(denominator) < 0) dynamic.determinant(denominator);
  result.denominator = denominator;
  bordered.determinant(result.numerator);
  fmpz_poly_neg(result.numerator, result.numerator);
  result.exponent = of_force + of_position - lowest;
  return result;
}

}  // namespace zwidth::internal

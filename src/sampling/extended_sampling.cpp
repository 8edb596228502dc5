#include "sampling/extended_sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace zwidth::internal {
namespace {

// Terms of higher degree are sampled in balls (exact_sampling.hpp).
constexpr std::size_t max_size = 3;

// A small square matrix of double-doubles.
struct Matrix {
  std::size_t size = 0;
  std::array<Extended, max_size * max_size> entries{};
  Extended& operator()(std::size_t i, std::size_t j) { return entries[i * size + j]; }
  const Extended& operator()(std::size_t i, std::size_t j) const { return entries[i * size + j]; }
};

Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix c{a.size, {}};
  for (std::size_t i = 0; i < a.size; ++i) {
    for (std::size_t k = 0; k < a.size; ++k) {
      if (leading(a(i, k)) == 0.0) continue;  // companion forms are sparse
      for (std::size_t j = 0; j < a.size; ++j) {
        if (leading(b(k, j)) != 0.0) c(i, j) += a(i, k) * b(k, j);
      }
    }
  }
  return c;
}

// e^M - I by Taylor series and E <- 2 E + E² for each halving of M.
Matrix exponential_minus_one(Matrix m) {
  double norm = 0.0;
  for (std::size_t i = 0; i < m.size; ++i) {
    double row = 0.0;
    for (std::size_t j = 0; j < m.size; ++j) row += std::abs(leading(m(i, j)));
    norm = std::max(norm, row);
  }
  const int halvings = norm > 0.25 ? static_cast<int>(std::ceil(std::log2(norm / 0.25))) : 0;
  for (Extended& entry : m.entries) entry *= Extended(std::ldexp(1.0, -halvings));
  constexpr int terms = 20;  // 0.25^20 / 20! < 1e-30
  Matrix sum = m;
  Matrix power = m;
  for (int k = 2; k <= terms; ++k) {
    power = power * m;
    for (std::size_t i = 0; i < m.size * m.size; ++i) {
      if (leading(power.entries[i]) == 0.0) continue;
      power.entries[i] = power.entries[i] / static_cast<double>(k);
      sum.entries[i] += power.entries[i];
    }
  }
  for (int i = 0; i < halvings; ++i) {
    const Matrix squared = sum * sum;
    for (std::size_t k = 0; k < m.size * m.size; ++k)
      sum.entries[k] = Extended(2.0) * sum.entries[k] + squared.entries[k];
  }
  return sum;
}

}  // namespace

ExtendedTerm sample_extended(const ModalTerm& term, const SamplingInstants& instants) {
  const double with_new = instants.with_new;
  const double with_old = instants.with_old;
  const std::size_t n = term.degree;
  const auto coefficient = [](double value, double rest) { return Extended(value) + Extended(rest); };
  // Companion form in time units of 1/unit, so that its entries are of order one: state i is scaled by unit^i.
  double unit = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    unit = std::max(unit, std::pow(std::abs(term.denominator[i]), 1.0 / static_cast<double>(n - i)));
  if (unit == 0.0) unit = 1.0 / (with_new + with_old);
  std::array<Extended, max_size> output{};
  const auto generator = [&](double time) {
    Matrix m{n + 1, {}};
    const Extended step = Extended(unit) * Extended(time);
    for (std::size_t i = 0; i + 1 < n; ++i) m(i, i + 1) = step;
    Extended scale = step;
    for (std::size_t i = n; i-- > 0;) {
      scale = scale / Extended(unit);
      m(n - 1, i) = Extended(-1.0) * coefficient(term.denominator[i], term.denominator_rest[i]) * scale;
    }
    m(n - 1, n) = step;  // the input, scaled by unit^n in all
    return m;
  };
  Extended scale(1.0);
  for (std::size_t i = 0; i < n; ++i) scale = scale / Extended(unit);
  for (std::size_t i = 0; i < n; ++i) {  // y = sum n_i x_i, x_i = unit^i (scaled state), input scaled by unit^-n
    output[i] = coefficient(term.numerator[i], term.numerator_rest[i]) * scale;
    scale = scale * Extended(unit);
  }
  const Matrix whole = exponential_minus_one(generator(with_new + with_old));
  const Matrix first = with_old == 0.0 ? whole : exponential_minus_one(generator(with_new));
  Matrix phi{n, {}};
  std::array<Extended, max_size> gamma_new{};
  std::array<Extended, max_size> gamma_old{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) phi(i, j) = whole(i, j);
    gamma_new[i] = first(i, n);
    gamma_old[i] = whole(i, n) - first(i, n);
  }
  ExtendedTerm sampled;
  sampled.numerator.assign(n + 1, Extended(0.0));
  sampled.denominator.assign(n + 1, Extended(1.0));
  // Faddeev-LeVerrier: adj(delta I - Phi) = sum B_k delta^k, B_{n-1} = I, c_{n-k} = -tr(Phi B_{n-k}) / k,
  // B_{n-k-1} = Phi B_{n-k} + c_{n-k} I.
  Matrix b{n, {}};
  for (std::size_t i = 0; i < n; ++i) b(i, i) = Extended(1.0);
  std::array<Extended, max_size> from_new{};
  std::array<Extended, max_size> from_old{};
  for (std::size_t k = 1; k <= n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        from_new[n - k] += output[i] * b(i, j) * gamma_new[j];
        from_old[n - k] += output[i] * b(i, j) * gamma_old[j];
      }
    }
    b = phi * b;
    Extended trace(0.0);
    for (std::size_t i = 0; i < n; ++i) trace += b(i, i);
    const Extended c = Extended(0.0) - trace / Extended(static_cast<double>(k));
    sampled.denominator[n - k] = c;
    for (std::size_t i = 0; i < n; ++i) b(i, i) += c;
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (with_old == 0.0) {
      sampled.numerator[i] = from_new[i];
    } else {  // (1 + delta) N_new + N_old
      sampled.numerator[i] = from_new[i] + from_old[i] + (i > 0 ? from_new[i - 1] : Extended(0.0));
    }
  }
  if (with_old > 0.0) sampled.numerator[n] = from_new[n - 1];
  return sampled;
}

double response_at_nyquist(const std::vector<ExtendedTerm>& terms, std::size_t delay_samples) {
  // What the double-double poles and residues resolve of a sum.
  constexpr double resolution = 1e-19;
  Extended sum(0.0);
  double size = 0.0;
  for (const ExtendedTerm& term : terms) {
    Extended numerator(0.0);
    double numerator_size = 0.0;
    Extended denominator(0.0);
    for (std::size_t i = term.denominator.size(); i-- > 0;) {
      numerator = Extended(-2.0) * numerator + term.numerator[i];
      numerator_size = 2.0 * numerator_size + std::abs(leading(term.numerator[i]));
      denominator = Extended(-2.0) * denominator + term.denominator[i];
    }
    sum += numerator / denominator;
    size += std::abs(numerator_size / leading(denominator));
  }
  if (std::abs(leading(sum)) <= resolution * size) return 0.0;
  return delay_samples % 2 == 0 ? leading(sum) : -leading(sum);
}

std::vector<Extended> extended_common_numerator(const std::vector<ExtendedTerm>& terms) {
  const auto multiply = [](const std::vector<Extended>& a, const std::vector<Extended>& b) {
    std::vector<Extended> product(a.size() + b.size() - 1, Extended(0.0));
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
    return product;
  };
  std::vector<Extended> numerator{Extended(0.0)};
  std::vector<Extended> denominator{Extended(1.0)};
  for (const ExtendedTerm& term : terms) {
    std::vector<Extended> sum = multiply(numerator, term.denominator);
    const std::vector<Extended> added = multiply(term.numerator, denominator);
    sum.resize(std::max(sum.size(), added.size()), Extended(0.0));
    for (std::size_t i = 0; i < added.size(); ++i) sum[i] += added[i];
    numerator = std::move(sum);
    denominator = multiply(denominator, term.denominator);
  }
  return numerator;
}

std::vector<double> common_numerator(const std::vector<ExtendedTerm>& terms) {
  const std::vector<Extended> numerator = extended_common_numerator(terms);
  std::vector<double> rounded(numerator.size());
  std::transform(numerator.begin(), numerator.end(), rounded.begin(), [](const Extended& c) { return leading(c); });
  return rounded;
}

}  // namespace zwidth::internal

#include "stability/users/solved_motions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace zwidth::internal {
namespace {

// std::complex asks after every product for infinities, and Eigen takes a hypot of every entry for its pivots: longer than
// all else here.
struct Number {
  long double real;
  long double imaginary;
};

Number operator*(const Number& a, const Number& b) {
  return {a.real * b.real - a.imaginary * b.imaginary, a.real * b.imaginary + a.imaginary * b.real};
}

void subtract(Number& a, const Number& b) {
  a.real -= b.real;
  a.imaginary -= b.imaginary;
}

bool is_zero(const Number& a) { return a.real == 0.0L && a.imaginary == 0.0L; }

Number inverse(const Number& a) {
  const long double one_over = 1.0L / (a.real * a.real + a.imaginary * a.imaginary);
  return {a.real * one_over, -a.imaginary * one_over};
}

// (K - w² M + jw D) x = f by elimination with row pivots; most of a chain's entries are zero. `rows` has room for n rows
// of n + 1; x is left in their last column.
void solve(const DeviceMatrices<long double>& matrices, const Weights& forced, long double w, Number* rows) {
  const std::size_t n = matrices.mass.size();
  const std::size_t width = n + 1;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      rows[i * width + j] = {matrices.stiffness[i * n + j], w * matrices.damping[i * n + j]};
    }
    rows[i * width + i].real -= w * w * matrices.mass[i];
    rows[i * width + n] = {0.0L, 0.0L};
  }
  for (std::size_t i = 0; i < matrices.coupling.size(); ++i)
    rows[i / n * width + i % n].real -= w * w * matrices.coupling[i];
  for (const auto& [i, weight] : forced) rows[i * width + n].real = weight;
  const auto size = [&](std::size_t i, std::size_t j) {
    return std::abs(rows[i * width + j].real) + std::abs(rows[i * width + j].imaginary);
  };
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (size(i, k) > size(pivot, k)) pivot = i;
    }
    if (pivot != k) std::swap_ranges(rows + pivot * width, rows + (pivot + 1) * width, rows + k * width);
    const Number* upper = rows + k * width;
    const Number one_over = inverse(upper[k]);
    for (std::size_t i = k + 1; i < n; ++i) {
      Number* row = rows + i * width;
      if (is_zero(row[k])) continue;
      const Number factor = row[k] * one_over;
      for (std::size_t j = k + 1; j < width; ++j) {
        if (!is_zero(upper[j])) subtract(row[j], factor * upper[j]);
      }
    }
    rows[k * width + k] = one_over;
  }
  for (std::size_t k = n; k-- > 0;) {
    Number& x = rows[k * width + n];
    for (std::size_t j = k + 1; j < n; ++j) subtract(x, rows[k * width + j] * rows[j * width + n]);
    x = x * rows[k * width + k];
  }
}

}  // namespace

SolvedMotions::SolvedMotions(const Device& device, Weights forced)
    : matrices_(device_matrices<long double>(device)), forced_(std::move(forced)) {}

void SolvedMotions::responses(double frequency, std::complex<double>* values) const {
  constexpr std::size_t few = 6;  // bodies, for which there is room without the heap
  const std::size_t n = matrices_.mass.size();
  const std::size_t width = n + 1;
  std::array<Number, few*(few + 1)> room;  // NOLINT(cppcoreguidelines-pro-type-member-init): solve() fills it
  std::vector<Number> more(n > few ? n * width : 0);
  Number* rows = more.empty() ? room.data() : more.data();
  solve(matrices_, forced_, static_cast<long double>(frequency), rows);
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    Number motion = {0.0L, 0.0L};
    for (const auto& [body, weight] : motions_[i]) {
      const Number& own = rows[body * width + n];
      subtract(motion, {-weight * own.real, -weight * own.imaginary});
    }
    values[i] = {static_cast<double>(motion.real), static_cast<double>(motion.imaginary)};
  }
}

}  // namespace zwidth::internal

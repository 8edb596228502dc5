#include "stability/users/motion_polynomials.hpp"

#include <algorithm>
#include <cmath>

#include "model/device_matrices.hpp"

namespace zwidth::internal {
namespace {

using Digits = ManyDigits;

constexpr double speed_ratio = 1.5;  // of neighbouring nodes
constexpr double digits_lost = 1e8;  // besides those of the interpolation

/// Positive s around the mean of the bodies' own speeds.
std::vector<Digits> interpolation_speeds(const DeviceMatrices<Digits>& matrices) {
  const std::size_t n = matrices.mass.size();
  double sum = 0.0;
  double count = 0.0;
  const auto take = [&](double speed) {
    if (!(speed > 0.0) || !std::isfinite(speed)) return;
    sum += std::log(speed);
    count += 1.0;
  };
  for (std::size_t i = 0; i < n; ++i) {
    take(std::sqrt(ManyDigits(matrices.stiffness[i * n + i] / matrices.mass[i]).convert_to<double>()));
  }
  for (std::size_t i = 0; i < n && sum == 0.0; ++i) {
    take(ManyDigits(matrices.damping[i * n + i] / matrices.mass[i]).convert_to<double>());
  }
  double speed = std::exp(count > 0.0 ? sum / count : 0.0) * std::pow(speed_ratio, -static_cast<double>(n));
  std::vector<Digits> speeds;
  for (std::size_t i = 0; i <= 2 * n; ++i, speed *= speed_ratio) speeds.emplace_back(speed);
  return speeds;
}

struct Solved {
  Digits determinant;
  std::vector<Digits> numerators;
};

/// det Z and x det Z of Z x = w_forced, Z = L D L^T; most of a chain's entries are zero.
Solved solved_at(const DeviceMatrices<Digits>& matrices, const Weights& forced, const Digits& s) {
  const std::size_t n = matrices.mass.size();
  std::vector<Digits> z(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const std::size_t at = i * n + j;
      if (!matrices.coupling.empty() && !matrices.coupling[at].is_zero()) z[at] = s * s * matrices.coupling[at];
      if (matrices.stiffness[at].is_zero() && matrices.damping[at].is_zero()) continue;
      z[at] += matrices.stiffness[at] + s * matrices.damping[at];
    }
    z[i * n + i] += s * s * matrices.mass[i];
  }
  Solved solved{Digits(1.0), std::vector<Digits>(n)};
  std::vector<Digits>& x = solved.numerators;
  for (const auto& [i, weight] : forced) x[i] = weight;
  std::vector<Digits> inverse(n);
  for (std::size_t k = 0; k < n; ++k) {
    solved.determinant *= z[k * n + k];
    inverse[k] = Digits(1.0) / z[k * n + k];
    for (std::size_t i = k + 1; i < n; ++i) {
      if (z[i * n + k].is_zero()) continue;
      const Digits factor = z[i * n + k] * inverse[k];
      for (std::size_t j = k + 1; j <= i; ++j) {
        if (!z[j * n + k].is_zero()) z[i * n + j] -= factor * z[j * n + k];
      }
      x[i] -= factor * x[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t i = k + 1; i < n; ++i) {
      if (!z[i * n + k].is_zero()) x[k] -= z[i * n + k] * x[i];
    }
    x[k] *= inverse[k];
  }
  for (Digits& each : x) each *= solved.determinant;
  return solved;
}

/// Coefficients that are rounding at both ends of the speeds set to 0, and those at the top left out.
void trim(Polynomial<Digits>& p, const Digits& lowest, const Digits& highest) {
  const auto size_at = [&](const Digits& speed) {
    Digits size = 0.0;
    Digits power = 1.0;
    for (const Digits& each : p) {
      size = std::max<Digits>(size, abs(each) * power);
      power *= speed;
    }
    return size;
  };
  const auto n = 0.5 * static_cast<double>(p.size() - 1);
  const double rounding = digits_lost * std::pow(speed_ratio, n * n) * 1e-100;
  const Digits low = rounding * size_at(lowest);
  const Digits high = rounding * size_at(highest);
  Digits of_low = 1.0;
  Digits of_high = 1.0;
  std::size_t used = 0;
  for (std::size_t i = 0; i < p.size(); ++i, of_low *= lowest, of_high *= highest) {
    if (abs(p[i]) * of_low <= low && abs(p[i]) * of_high <= high) {
      p[i] = 0.0;
    } else {
      used = i + 1;
    }
  }
  p.resize(std::max<std::size_t>(used, 1));
}

}  // namespace

MotionPolynomials motion_polynomials(const Device& device, const Weights& forced) {
  const DeviceMatrices<Digits> matrices = device_matrices<Digits>(device);
  const std::size_t n = matrices.mass.size();
  const std::vector<Digits> speeds = interpolation_speeds(matrices);
  const std::size_t count = speeds.size();
  std::vector<std::vector<Digits>> values(n + 1);  // the last: the determinant
  for (const Digits& speed : speeds) {
    Solved solved = solved_at(matrices, forced, speed);
    for (std::size_t i = 0; i < n; ++i) values[i].push_back(std::move(solved.numerators[i]));
    values[n].push_back(std::move(solved.determinant));
  }
  std::vector<Digits> inverse(count * count);  // of the speeds' differences
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) inverse[i * count + j] = Digits(1.0) / (speeds[i] - speeds[j]);
  }
  MotionPolynomials result;
  for (std::vector<Digits>& f : values) {
    for (std::size_t order = 1; order < count; ++order) {
      for (std::size_t i = count - 1; i >= order; --i) f[i] = (f[i] - f[i - 1]) * inverse[i * count + i - order];
    }
    Polynomial<Digits> p{f[count - 1]};
    for (std::size_t i = count - 1; i-- > 0;) {
      multiply<Digits>(p, -speeds[i], Digits(1.0));
      p[0] += f[i];
    }
    trim(p, speeds.front(), speeds.back());
    result.numerators.push_back(std::move(p));
  }
  result.determinant = std::move(result.numerators.back());
  result.numerators.pop_back();
  return result;
}

}  // namespace zwidth::internal

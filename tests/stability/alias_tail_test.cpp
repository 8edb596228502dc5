#include "stability/users/alias_tail.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace zwidth {
using namespace internal;
namespace {

// The same sum term by term in long double; what is left beyond the last term by the midpoint rule (angle 0) or below
// one term (otherwise).
std::complex<double> direct_sum(int first, double x, double angle, int power) {
  constexpr int last = 20000;
  std::complex<long double> sum = 0.0L;
  for (int k = last - 1; k >= first; --k) {
    sum += std::polar(1.0L, -static_cast<long double>(angle) * k) * std::pow(static_cast<long double>(k + x), -power);
  }
  if (angle == 0.0) sum += std::pow(last - 0.5L + static_cast<long double>(x), 1 - power) / (power - 1.0L);
  return {static_cast<double>(sum.real()), static_cast<double>(sum.imag())};
}

// As the docstring of alias_tail() states it.
double alias_tail_error(double first, double angle) {
  if (angle == 0.0) return 1e-13;
  return std::max(2e-9, 0.05 * std::exp(-3.0 * first * std::abs(angle)));
}

TEST(AliasTail, EqualsTheDirectSumWithinItsStatedError) {
  for (const int first : {6, 32}) {
    for (const double angle : {0.0, 0.02, 0.1, -0.5, 1.57, 3.1}) {
      for (const int power : {2, 4}) {
        const double x = 0.37;
        const double untwisted = std::pow(first + x - 0.5, 1 - power) / (power - 1);
        EXPECT_LE(std::abs(alias_tail(first, x, angle, power) - direct_sum(first, x, angle, power)),
                  alias_tail_error(first, angle) * untwisted +
                      2.0 * std::pow(20000.0, -power) * (angle == 0.0 ? 1e-4 : 1.0 / std::abs(angle)))
            << first << " " << angle << " " << power;
      }
    }
  }
}

}  // namespace
}  // namespace zwidth

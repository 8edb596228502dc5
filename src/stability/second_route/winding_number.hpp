#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>

namespace zwidth::internal {

/// The change of a function's phase along an arc, halving the step until it is unambiguous.
template <typename Function>
class PhaseChange {
 public:
  /// `evaluations`: of f, at most; a function that is nothing but rounding would take all halvings everywhere.
  PhaseChange(Function& f, std::size_t evaluations) : f_(f), left_(evaluations) {}

  double operator()(double begin, std::complex<double> at_begin, double end, std::complex<double> at_end,
                    int halvings = most_halvings) {
    if (halvings == 0 || left_ == 0) return std::arg(at_end / at_begin);
    --left_;
    const double middle = 0.5 * (begin + end);
    const std::complex<double> at_middle = f_(middle);
    const double first = std::arg(at_middle / at_begin);
    const double second = std::arg(at_end / at_middle);
    if (std::abs(first) + std::abs(second) < std::numbers::pi / 3.0) return first + second;
    return (*this)(begin, at_begin, middle, at_middle, halvings - 1) +
           (*this)(middle, at_middle, end, at_end, halvings - 1);
  }

  [[nodiscard]] bool gave_up() const { return left_ == 0; }

 private:
  static constexpr int most_halvings = 40;

  Function& f_;
  std::size_t left_;
};

/// Half the turns that f makes over angles 0..pi, in units of pi: the zeros less the poles that it encloses, for a
/// function that is real on the real axis. `steps`: at least a few per zero and pole. None where f is too rough to tell.
template <typename Function>
std::optional<double> winding_number(Function& f, std::size_t steps) {
  PhaseChange change(f, 4 * steps + 4000);  // one a step, and some forty for every zero beside the arc
  double total = 0.0;
  double begin = 0.0;
  std::complex<double> at_begin = f(0.0);
  for (std::size_t i = 1; i <= steps; ++i) {
    const double end = std::numbers::pi * static_cast<double>(i) / static_cast<double>(steps);
    const std::complex<double> at_end = f(end);
    total += change(begin, at_begin, end, at_end);
    begin = end;
    at_begin = at_end;
  }
  if (change.gave_up()) return std::nullopt;
  return total / std::numbers::pi;
}

}  // namespace zwidth::internal

#pragma once

// All poles of a plant that can be evaluated in double and in double-double.

#include <cmath>
#include <cstddef>
#include <vector>

#include "model/extended_precision.hpp"
#include "model/pole_search.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {

// Sweeps in double bring the roots near; sweeps in double-double finish. A simple root converges cubically, so a last
// step of `last_step` leaves an error below last_step² times the root's condition; multiple roots converge linearly
// and are refined by contour integrals (partial_fractions).
inline constexpr int max_sweeps_in_double = 12;
inline constexpr int max_sweeps_in_extended = 80;
inline constexpr double last_step = 1e-13;
inline constexpr double unresolved_step = 1e-3;

// All non-zero roots of both pencils (the same function in two precisions) from starting values.
template <typename Pencil, typename PencilX>
std::vector<Complex<Extended>> find_poles(const Pencil& pencil, const PencilX& extended,
                                          std::vector<Complex<double>> start) {
  // Off the real axis, which the iteration would never leave, and distinct: coincident values would move together.
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (start[i].im == 0.0) start[i].im = (i % 2 == 0 ? 1e-3 : -1e-3) * start[i].re;
    for (std::size_t j = 0; j < i; ++j) {
      if (magnitude(start[i] - start[j]) <= 1e-6 * magnitude(start[i])) {
        start[i] *= Complex<double>(1.0 + 1e-3 * static_cast<double>(i + 1), 2e-3 * static_cast<double>(i + 1));
      }
    }
  }
  std::vector<Complex<double>> rough = start;
  improve_roots(pencil, rough, 1e-9, max_sweeps_in_double);
  std::vector<Complex<Extended>> roots;
  roots.reserve(rough.size());
  for (std::size_t i = 0; i < rough.size(); ++i) {
    const double size = magnitude(rough[i]);
    roots.emplace_back(std::isfinite(size) && size > 0.0 ? rough[i] : start[i]);
  }
  const double step = improve_roots(extended, roots, last_step, max_sweeps_in_extended);
  if (!(step <= unresolved_step)) {
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::poles_not_found});
  }
  return roots;
}

}  // namespace zwidth::internal

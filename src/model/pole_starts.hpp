#pragma once

// Where the search for poles begins: values, not results.

#include <utility>
#include <vector>

#include "model/device_matrices.hpp"
#include "model/extended_precision.hpp"

namespace zwidth::internal {

// Roots of s² + c1 s + c0 in double, without cancellation.
std::pair<Complex<double>, Complex<double>> quadratic_roots(double c1, double c0);

struct UndampedModes {
  std::vector<double> stiffness;  // w², ascending
  std::vector<double> damping;    // phi' D phi
  bool lowest_mode_is_rigid = false;
  std::size_t damped_free = 0;  // of coordinates: motions that dampers alone hold
};

// Real modes of M, K (mass-normalised) with the diagonal of the modal damping.
UndampedModes undamped_modes(const Device& device, const DeviceMatrices<double>& matrices);

// Starting values on circles whose radii come from the upper convex hull of log |coefficients| (D. Bini 1996).
std::vector<Complex<double>> newton_polygon_start(const std::vector<double>& p);

}  // namespace zwidth::internal

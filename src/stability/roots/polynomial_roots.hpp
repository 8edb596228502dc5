#pragma once

#include <complex>
#include <vector>

namespace zwidth::internal {

// All roots of a real polynomial of at least degree 1, coefficients by rising powers, the first and the last not 0: by
// Ehrlich-Aberth iteration in long double, started on the radii of Newton's polygon. A root of multiplicity m comes as
// m of them around it, as far as the m-th root of rounding.
[[nodiscard]] std::vector<std::complex<long double>> polynomial_roots(const std::vector<long double>& coefficients);

}  // namespace zwidth::internal

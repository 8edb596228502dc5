#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace zwidth::internal {

/// How to sum a function of the alias number over all of them: sum over k >= 0 of e^{-j angle k} f(k).
struct AliasSumQuadrature {
  struct Node {
    double number = 0.0;           ///< k; not whole beyond the first ones
    std::complex<double> turning;  ///< weight of f(k) in the sum above
    double still = 0.0;            ///< weight in the sum without its factor e^{-j angle k}
  };
  std::vector<Node> nodes;
};

/// The first `exact` aliases one by one (at least 1), then blocks [M, 2 M) up to `steady`, then [M, infinity): in each,
/// f is taken as k^-2 times a polynomial in 1/k through a few Chebyshev nodes, whose sums are made once, here.
///
/// For f that falls like k^-2 or faster, without resonances beyond `exact` and a power series in 1/k beyond `steady`.
[[nodiscard]] AliasSumQuadrature alias_sum_quadrature(std::size_t exact, double steady, double angle);

/// The same nodes with the derivatives of `turning` by the angle: sum over k >= 0 of -j k e^{-j angle k} f(k). At an
/// angle of 0 the derivative towards positive angles of the sum plus its mirror image, conj(sum of f(-k)); its
/// logarithmically infinite part, which cancels there, is left out. `still` is 0. f must fall like c k^-2 with a real
/// c, or faster.
[[nodiscard]] AliasSumQuadrature alias_sum_quadrature_derivative(std::size_t exact, double steady, double angle);

}  // namespace zwidth::internal

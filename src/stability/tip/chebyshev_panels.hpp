#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

namespace zwidth::internal {

// An interval on which a function is the polynomial through its values at Chebyshev's nodes.
struct Panel {
  double centre = 0.0;
  double half = 0.0;  // of its length
  [[nodiscard]] double first() const { return centre - half; }
  [[nodiscard]] double last() const { return centre + half; }
};

inline constexpr int panel_nodes = 14;
using NodeWeights = Eigen::Matrix<double, panel_nodes, 1>;

// Rising with i = 0 .. panel_nodes - 1; the ends are none.
[[nodiscard]] double panel_node(const Panel& panel, int i);

// What the values at the nodes are multiplied by: the polynomial's value at x.
[[nodiscard]] NodeWeights weights_at(const Panel& panel, double x);

// Panels that follow each other from `first` to `last`, none longer than 2 `widest`, each short enough for functions that have
// poles there alone: with M the largest size in the ellipse around a panel that has its ends as foci and half axes of the sum
// rho half, the polynomial errs by at most
//
//     4 M rho^-n / (rho - 1),   rho = 4, n = panel_nodes
//
// Source: Trefethen, Approximation Theory and Approximation Practice, theorem 8.2.
[[nodiscard]] std::vector<Panel> panels_clear_of(double first, double last,
                                                 const std::vector<std::complex<double>>& poles, double widest);

}  // namespace zwidth::internal

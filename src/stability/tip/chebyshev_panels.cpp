#include "stability/tip/chebyshev_panels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace zwidth::internal {
namespace {

constexpr double clear_of_poles = 4.0;   // rho
constexpr double shortest_panel = 1e-7;  // of the whole interval: poles on the axis itself

// Cosine and sine of (2 i + 1) pi/(2 n), from which nodes and their barycentric weights are.
struct UnitNodes {
  UnitNodes() {
    for (int i = 0; i < panel_nodes; ++i) {
      const double turn = std::numbers::pi * (i + 0.5) / panel_nodes;
      at[static_cast<std::size_t>(i)] = -std::cos(turn);
      weight[static_cast<std::size_t>(i)] = (i % 2 == 0 ? 1.0 : -1.0) * std::sin(turn);
    }
  }
  std::array<double, panel_nodes> at{};
  std::array<double, panel_nodes> weight{};
};

const UnitNodes& unit_nodes() {
  static const UnitNodes nodes;
  return nodes;
}

bool is_clear_of(const Panel& panel, std::complex<double> pole) {
  const std::complex<double> at = (pole - panel.centre) / panel.half;
  const std::complex<double> root = std::sqrt(at * at - 1.0);
  return std::max(std::abs(at + root), std::abs(at - root)) >= clear_of_poles;
}

}  // namespace

double panel_node(const Panel& panel, int i) {
  return panel.centre + panel.half * unit_nodes().at[static_cast<std::size_t>(i)];
}

NodeWeights weights_at(const Panel& panel, double x) {
  const double unit = (x - panel.centre) / panel.half;
  NodeWeights weights;
  for (int i = 0; i < panel_nodes; ++i) {
    const auto of = static_cast<std::size_t>(i);
    const double apart = unit - unit_nodes().at[of];
    if (apart == 0.0) return NodeWeights::Unit(i);
    weights[i] = unit_nodes().weight[of] / apart;
  }
  return weights / weights.sum();
}

std::vector<Panel> panels_clear_of(double first, double last, const std::vector<std::complex<double>>& poles,
                                   double widest) {
  const double shortest = shortest_panel * (last - first);
  std::vector<Panel> open{{0.5 * (first + last), 0.5 * (last - first)}};
  std::vector<Panel> panels;
  while (!open.empty()) {
    const Panel panel = open.back();
    open.pop_back();
    const bool is_short =
        panel.half <= widest && std::ranges::all_of(poles, [&](const auto& pole) { return is_clear_of(panel, pole); });
    if (is_short || panel.half <= shortest) {
      panels.push_back(panel);
      continue;
    }
    const double quarter = 0.5 * panel.half;
    open.push_back({panel.centre + quarter, quarter});
    open.push_back({panel.centre - quarter, quarter});
  }
  return panels;
}

}  // namespace zwidth::internal

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "design/region/region_structure.hpp"
#include "design/region/two_rate_curve.hpp"
#include "design/region/two_rate_slices.hpp"
#include "design/region/two_rate_tracer.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// Levels of B nearer than this share of the greatest are one.
inline constexpr double same_level_of_two_rates = 1e-10;
inline constexpr std::uintmax_t most_root_steps_of_two_rates = 100;

// The walls of a device whose damper runs in a loop of its own. Slices of one gain inside have every crossing; the chains
// through them, divided where B turns, are the branches. Between two levels of B, at which branches end or cross, the cells
// are told by slices; and every slice is asked whether it tells the same.
// Throws Error (did_not_converge) where a slice contradicts, also among thrice as many, and where a chain cannot be followed.
class TwoRateStructure final : public RegionStructure {
 public:
  TwoRateStructure(const Device& device, const Progress& progress);

  [[nodiscard]] EdgePoint edge_at(const RegionEdge& edge, double damping) const override;
  [[nodiscard]] bool is_curved(const RegionEdge& edge) const override;
  [[nodiscard]] BoundaryKind kind_of(std::size_t branch) const override { return kinds_[branch]; }
  [[nodiscard]] Node between(const Node& from, const Node& to, double part) const override;
  [[nodiscard]] std::vector<Node> nodes_between(std::size_t branch, const Node& first, const Node& last) const override;
  [[nodiscard]] BoundaryPoint stiffest_between(const BoundaryPoint& first, const BoundaryPoint& last) const override;
  [[nodiscard]] WallPoint rounding_at(double, double) const override { return {}; }
  [[nodiscard]] BoundaryPoint seen_at(const WallPoint& wall, double angle) const override;
  [[nodiscard]] double period() const override { return curve_.period(); }
  [[nodiscard]] double velocity_filter_hz() const override { return curve_.velocity_filter_hz(); }

 private:
  void build(int density, const Progress& progress);
  void add_branches(TwoRateChain chain);
  void add_branch(std::vector<Node> nodes, BoundaryKind kind);
  void add_monotonic(std::vector<Node> nodes, BoundaryKind kind);
  [[nodiscard]] Node on_curve(const Node& from, const Node& to, double part) const;
  [[nodiscard]] double rise(const Node& first, const Node& last, double part) const;
  [[nodiscard]] Node turn_between(const Node& first, const Node& last) const;
  [[nodiscard]] std::optional<Node> turn_beside(const Node& end, const Node& next) const;
  [[nodiscard]] Node at_damping(std::size_t branch, double damping) const;
  [[nodiscard]] std::vector<double> levels() const;
  void add_crossings(std::size_t first, std::size_t second, std::vector<double>& found) const;
  [[nodiscard]] std::vector<RegionCell> cells_at(double damping) const;
  [[nodiscard]] bool holds(const RegionSlice& slice) const;
  [[nodiscard]] Node node_of(const BoundaryPoint& point) const;

  TwoRateCurve curve_;
  RegionSlices slices_;
  WallPoint most_;
  std::vector<BoundaryKind> kinds_;  // of the branches
};

}  // namespace zwidth::internal

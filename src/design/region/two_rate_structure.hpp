#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "design/region/branch_structure.hpp"
#include "design/region/two_rate_curve.hpp"
#include "design/region/two_rate_slices.hpp"
#include "design/region/two_rate_tracer.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// The walls of a device whose damper runs in a loop of its own. Slices of one gain inside have every crossing; the chains
// through them, divided where B turns, are the branches. Between two levels of B, at which branches end or cross, the cells
// are told by slices; and every slice is asked whether it tells the same.
// Throws Error (did_not_converge) where a slice contradicts, also among thrice as many, and where a chain cannot be followed.
class TwoRateStructure final : public BranchStructure {
 public:
  TwoRateStructure(const Device& device, const Progress& progress);

  [[nodiscard]] Node between(const Node& from, const Node& to, double part) const override;
  [[nodiscard]] WallPoint rounding_at(double, double) const override { return {}; }
  [[nodiscard]] BoundaryPoint seen_at(const WallPoint& wall, double angle) const override;
  [[nodiscard]] double period() const override { return curve_.period(); }
  [[nodiscard]] double velocity_filter_hz() const override { return curve_.velocity_filter_hz(); }

 private:
  void build(int density, const Progress& progress);
  void add_branches(TwoRateChain chain);
  void add_monotonic(std::vector<Node> nodes, BoundaryKind kind);
  [[nodiscard]] Node on_curve(const Node& from, const Node& to, double part) const;
  [[nodiscard]] double rise(const Node& first, const Node& last, double part) const;
  [[nodiscard]] Node turn_between(const Node& first, const Node& last) const;
  [[nodiscard]] std::optional<Node> turn_beside(const Node& end, const Node& next) const;
  [[nodiscard]] std::optional<Node> found_between(const Node& a, const Node& b, double damping) const override;
  [[nodiscard]] StableAt stable_at(double damping) const override;
  [[nodiscard]] bool holds(const RegionSlice& slice) const;
  [[nodiscard]] Node node_of(const BoundaryPoint& point) const override;

  TwoRateCurve curve_;
  RegionSlices slices_;
};

}  // namespace zwidth::internal

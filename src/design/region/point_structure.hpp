#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "design/region/branch_structure.hpp"
#include "design/region/point_curve.hpp"
#include "stability/tip/tip_states.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// The walls of a point, which acts in every direction that the tip can move. Its curves are sampled over the angle; at B of
// every slab, closed-loop eigenvalues tell which cells are stable. From K = 0, and from the middle of each cell, intervals that
// are certain by the small-gain theorem then go to the crossings that end it; where they meet one that no curve has, curves are
// sampled there too. Refused (FindingCode::poles_along_circle) where those intervals become too short.
class PointStructure final : public BranchStructure {
 public:
  // Throws Error (invalid_argument) as tip_of_point_wall(), (did_not_converge) where crossings stay without a curve.
  PointStructure(const Device& device, const Progress& progress);

  [[nodiscard]] Node between(const Node& from, const Node& to, double part) const override;
  [[nodiscard]] WallPoint rounding_at(double damping, double stiffest) const override;
  [[nodiscard]] BoundaryPoint seen_at(const WallPoint& wall, double angle) const override;
  [[nodiscard]] double period() const override { return plant_.period; }
  [[nodiscard]] double velocity_filter_hz() const override { return wall_.velocity_filter_hz; }

 private:
  [[nodiscard]] StableAt stable_at(double damping) const override;
  [[nodiscard]] std::optional<Node> found_between(const Node& a, const Node& b, double damping) const override;
  [[nodiscard]] Node node_of(const BoundaryPoint& point) const override;

  [[nodiscard]] Node at_angle(const Node& a, const Node& b, double angle) const;
  void find_extent(const std::vector<PointCurve::Curve>& curves, const Progress& progress);
  [[nodiscard]] double within(const Node& node) const;
  [[nodiscard]] Node at_bound(const Node& inside, const Node& outside) const;
  [[nodiscard]] Node cleared(Node node) const;
  void add_within(const PointCurve::Curve& curve);
  void add_monotonic(const std::vector<Node>& nodes);
  [[nodiscard]] Node turn_between(const Node& first, const Node& middle, const Node& last) const;
  void add_straight();
  void build(const std::vector<double>& angles, const Progress& progress);
  [[nodiscard]] std::vector<double> missed_angles(const Progress& progress);
  void compare(double damping, const std::vector<RegionCell>& cells, std::vector<double>& missed);

  SampledTip plant_;
  Wall wall_;
  PointCurve curve_;
};

}  // namespace zwidth::internal

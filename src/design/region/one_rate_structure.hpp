#pragma once

#include <optional>
#include <vector>

#include "design/region/boundary_segment.hpp"
#include "design/region/region_structure.hpp"
#include "stability/limit/gain_crossings.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// The walls of a loop of one rate, whose curve is known by its angle.
class OneRateStructure final : public RegionStructure {
 public:
  // Of ranges of B into slabs.
  static constexpr std::size_t max_divisions = 600;

  // The cells are told by the branches at each B; those of every slab are confirmed by critical_stiffness(), which
  // knows no branch. Where it contradicts, it tells the cells everywhere.
  // Throws Error (did_not_converge) at the cap, and as boundary_segments() and critical_stiffness() do.
  OneRateStructure(FilteredPlant plant, double velocity_filter_hz, const Progress& progress);

  [[nodiscard]] EdgePoint edge_at(const RegionEdge& edge, double damping) const override;
  [[nodiscard]] bool is_curved(const RegionEdge& edge) const override;
  [[nodiscard]] Node between(const Node& from, const Node& to, double part) const override;
  [[nodiscard]] std::vector<Node> nodes_between(std::size_t branch, const Node& first, const Node& last) const override;
  [[nodiscard]] BoundaryPoint stiffest_between(const BoundaryPoint& first, const BoundaryPoint& last) const override;
  [[nodiscard]] WallPoint rounding_at(double damping, double stiffest) const override;
  [[nodiscard]] BoundaryPoint seen_at(const WallPoint& wall, double angle) const override;
  [[nodiscard]] double period() const override { return curve_.plant().period; }
  [[nodiscard]] double velocity_filter_hz() const override { return curve_.velocity_filter_hz(); }

 private:
  [[nodiscard]] std::vector<BoundarySegment> straight_segments(double top) const;
  [[nodiscard]] std::vector<double> levels(const std::vector<BoundarySegment>& segments, const Progress& progress);
  [[nodiscard]] std::vector<RegionCell> cells_at(double damping) const;
  [[nodiscard]] std::vector<RegionCell> cells_by_branches(double damping) const;
  [[nodiscard]] std::vector<RegionCell> cells_by_isolation(double damping) const;
  [[nodiscard]] bool agree(const std::vector<RegionCell>& cells, const std::vector<RegionCell>& others,
                           double damping) const;
  [[nodiscard]] bool agree_within(const std::vector<RegionCell>& cells, double lower, double upper) const;
  [[nodiscard]] double stiffest_of(const std::vector<RegionCell>& cells, double damping) const;
  void add_below(double lower, double upper, std::vector<RegionCell> cells);
  void add_slabs(double bottom, double top, const Progress& progress);
  void find_slabs(const std::vector<double>& found, const Progress& progress);
  [[nodiscard]] bool are_slabs_confirmed(const Progress& progress) const;

  BoundaryCurve curve_;
  std::optional<double> nyquist_;  // K of the Nyquist line at B = 0, where > 0
  std::optional<double> drift_;    // K at which a pole passes z = 1, where > 0
  GainCrossings by_damping_;       // of the damper alone
  bool by_branches_ = true;
  bool told_apart_ = true;  // no two pieces of boundary lie on one another
  std::size_t divisions_left_ = max_divisions;
};

}  // namespace zwidth::internal

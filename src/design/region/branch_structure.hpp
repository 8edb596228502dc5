#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "design/region/region_structure.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

inline constexpr std::uintmax_t most_root_steps_on_branch = 100;
// Levels of B nearer than this share of the greatest are one.
inline constexpr double same_level_of_branches = 1e-10;

// The walls of a loop whose boundary is known as branches, along each of which B rises or falls: between two levels of B at
// which branches end or cross, the cells are told at one B.
class BranchStructure : public RegionStructure {
 public:
  [[nodiscard]] EdgePoint edge_at(const RegionEdge& edge, double damping) const override;
  [[nodiscard]] bool is_curved(const RegionEdge& edge) const override;
  [[nodiscard]] BoundaryKind kind_of(std::size_t branch) const override { return kinds_[branch]; }
  [[nodiscard]] std::vector<Node> nodes_between(std::size_t branch, const Node& first, const Node& last) const override;
  [[nodiscard]] BoundaryPoint stiffest_between(const BoundaryPoint& first, const BoundaryPoint& last) const override;

 protected:
  // Whether walls of this K are stable, at one B.
  using StableAt = std::function<bool(double stiffness)>;
  [[nodiscard]] virtual StableAt stable_at(double damping) const = 0;
  // Where the curve has this B between two neighbouring nodes; nothing where it is left to bisection.
  [[nodiscard]] virtual std::optional<Node> found_between(const Node& a, const Node& b, double damping) const = 0;
  // The node of an oscillation that seen_at() told of.
  [[nodiscard]] virtual Node node_of(const BoundaryPoint& point) const = 0;

  void add_branch(std::vector<Node> nodes, BoundaryKind kind);
  // From the branches. Throws Error (did_not_converge) where walls of `most` are stable.
  void find_slabs(const Progress& progress);

  // Where the branch has this B; its nearer end where it has not.
  [[nodiscard]] Node at_damping(std::size_t branch, double damping) const;

  WallPoint most_;                   // beyond it no wall is stable
  std::vector<BoundaryKind> kinds_;  // of the branches

 private:
  [[nodiscard]] std::vector<double> levels() const;
  void add_crossings(std::size_t first, std::size_t second, std::vector<double>& found) const;
  [[nodiscard]] std::vector<RegionCell> cells_at(double damping) const;
};

}  // namespace zwidth::internal

#pragma once

#include <cstddef>
#include <vector>

#include "design/region/region_structure.hpp"

namespace zwidth::internal {

// Where a side of a cell ends: at the bottom or the top of its slab.
struct EdgeEnd {
  std::size_t slab = 0;
  std::size_t cell = 0;
  bool right = false;
  bool top = false;
  friend bool operator==(const EdgeEnd&, const EdgeEnd&) = default;
};

// How the cells of neighbouring slabs join into boundaries and components. No cell may be unbounded.
class CellAdjacency {
 public:
  explicit CellAdjacency(const RegionStructure& structure);

  // The end that the boundary goes on with.
  [[nodiscard]] const EdgeEnd& partner(const EdgeEnd& end) const { return partners_[index(end)]; }
  // The same number for all cells of a connected component.
  [[nodiscard]] std::size_t component(const EdgeEnd& end) const { return root(cell_index(end)); }

  [[nodiscard]] const RegionEdge& edge(const EdgeEnd& end) const;
  [[nodiscard]] double damping(const EdgeEnd& end) const;
  [[nodiscard]] RegionStructure::EdgePoint point(const EdgeEnd& end) const;

 private:
  struct Placed {
    EdgeEnd end;
    double stiffness = 0.0;
    std::size_t cluster = 0;  // ends at the same K, to rounding
  };
  [[nodiscard]] std::size_t cell_index(const EdgeEnd& end) const { return first_cell_[end.slab] + end.cell; }
  [[nodiscard]] std::size_t index(const EdgeEnd& end) const {
    return 4 * cell_index(end) + (end.right ? 2U : 0U) + (end.top ? 1U : 0U);
  }
  [[nodiscard]] std::size_t root(std::size_t cell) const;
  [[nodiscard]] std::vector<Placed> ends_at_bottom_of(std::size_t slab) const;
  [[nodiscard]] static std::vector<Placed> open_ends(std::vector<Placed>& ends, double tolerance);
  void link_bottom_of(std::size_t slab);
  void join(std::size_t upper_slab, double tolerance);
  void pair(const EdgeEnd& a, const EdgeEnd& b);

  const RegionStructure& structure_;
  std::vector<std::size_t> first_cell_;  // of each slab, counted through
  std::vector<EdgeEnd> partners_;
  std::vector<std::size_t> parents_;
};

}  // namespace zwidth::internal

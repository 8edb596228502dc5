#include "design/region/cell_adjacency.hpp"

#include <algorithm>
#include <numeric>

namespace zwidth::internal {
namespace {

// Ends this close, as a share of the greatest |K| + |B|/T of the level, meet. The least that leaves every place with an
// even number of open ends: beside a pole that is hardly damped K is known to fewer digits.
constexpr double same_place[] = {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4};
constexpr double usual_place = 1e-7;  // where none does: a boundary runs along the level

}  // namespace

CellAdjacency::CellAdjacency(const RegionStructure& structure) : structure_(structure) {
  std::size_t cells = 0;
  for (const RegionSlab& slab : structure.slabs) {
    first_cell_.push_back(cells);
    cells += slab.cells.size();
  }
  partners_.resize(4 * cells);
  parents_.resize(cells);
  std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  for (std::size_t slab = 0; slab <= structure.slabs.size(); ++slab) link_bottom_of(slab);
}

const RegionEdge& CellAdjacency::edge(const EdgeEnd& end) const {
  const RegionCell& cell = structure_.slabs[end.slab].cells[end.cell];
  return end.right ? *cell.right : cell.left;
}

double CellAdjacency::damping(const EdgeEnd& end) const {
  const RegionSlab& slab = structure_.slabs[end.slab];
  return end.top ? slab.upper : slab.lower;
}

RegionStructure::EdgePoint CellAdjacency::point(const EdgeEnd& end) const {
  return structure_.edge_at(edge(end), damping(end));
}

std::size_t CellAdjacency::root(std::size_t cell) const {
  while (parents_[cell] != cell) cell = parents_[cell];
  return cell;
}

void CellAdjacency::pair(const EdgeEnd& a, const EdgeEnd& b) {
  partners_[index(a)] = b;
  partners_[index(b)] = a;
}

// The ends at one level: of the slab that begins there and of the one that ends there.
std::vector<CellAdjacency::Placed> CellAdjacency::ends_at_bottom_of(std::size_t slab) const {
  std::vector<Placed> ends;
  const auto add = [&](std::size_t of, bool top) {
    for (std::size_t cell = 0; cell < structure_.slabs[of].cells.size(); ++cell) {
      for (const bool right : {false, true}) {
        const EdgeEnd end{of, cell, right, top};
        ends.push_back({end, point(end).stiffness, 0});
      }
    }
  };
  if (slab > 0) add(slab - 1, true);
  if (slab < structure_.slabs.size()) add(slab, false);
  return ends;
}

// Numbers ends that are in the same place, which `ends` by rising K is sorted into, right sides first; answers those
// that stay open where a cell that is born or dies in one place closes on itself.
std::vector<CellAdjacency::Placed> CellAdjacency::open_ends(std::vector<Placed>& ends, double tolerance) {
  std::sort(ends.begin(), ends.end(), [](const Placed& a, const Placed& b) { return a.stiffness < b.stiffness; });
  for (std::size_t i = 1; i < ends.size(); ++i) {
    ends[i].cluster = ends[i - 1].cluster + (ends[i].stiffness - ends[i - 1].stiffness > tolerance ? 1 : 0);
  }
  std::stable_sort(ends.begin(), ends.end(), [](const Placed& a, const Placed& b) {
    if (a.cluster != b.cluster) return a.cluster < b.cluster;
    return a.end.right > b.end.right;
  });
  std::vector<Placed> open;
  for (const Placed& each : ends) {
    EdgeEnd other = each.end;
    other.right = !other.right;
    const auto same_cell =
        std::find_if(ends.begin(), ends.end(), [&](const Placed& placed) { return placed.end == other; });
    if (same_cell->cluster != each.cluster) open.push_back(each);
  }
  return open;
}

// By continuity the cells below and those above cover the same K at their common level. So an end is in the same place
// as its neighbour by rising K. Where more than two meet, a cell that is born or dies there closes on itself, and of
// the others right sides go on as right sides. Where a boundary runs along the level its ends are left over: they are
// joined along it.
void CellAdjacency::link_bottom_of(std::size_t slab) {
  std::vector<Placed> ends = ends_at_bottom_of(slab);
  if (ends.empty()) return;
  const double damping = this->damping(ends.front().end);
  double greatest = 0.0;
  for (const Placed& each : ends) greatest = std::max(greatest, each.stiffness);
  const double extent = greatest + damping / structure_.period();
  const double rounding = structure_.rounding_at(damping, greatest).stiffness;
  const auto is_even = [](const std::vector<Placed>& open) {
    if (open.size() % 2 != 0) return false;
    for (std::size_t i = 0; i < open.size(); i += 2) {
      if (open[i].cluster != open[i + 1].cluster) return false;
    }
    return true;
  };
  double tolerance = usual_place * extent;
  if (damping > 0.0) {
    std::vector<double> tolerances;
    for (const double place : same_place) tolerances.push_back(place * extent);
    tolerances.push_back(std::max(tolerances.back(), rounding));
    const auto even =
        std::find_if(tolerances.begin(), tolerances.end(), [&](double each) { return is_even(open_ends(ends, each)); });
    if (even != tolerances.end()) tolerance = *even;
  }
  const std::vector<Placed> open = open_ends(ends, tolerance);
  for (const Placed& each : ends) {  // those that close on themselves
    EdgeEnd other = each.end;
    other.right = !other.right;
    pair(each.end, other);
  }
  std::vector<EdgeEnd> left_over;
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (i + 1 < open.size() && open[i].cluster == open[i + 1].cluster) {
      pair(open[i].end, open[i + 1].end);
      ++i;
    } else {
      left_over.push_back(open[i].end);
    }
  }
  for (std::size_t i = 0; i + 1 < left_over.size(); i += 2) pair(left_over[i], left_over[i + 1]);
  if (slab > 0 && slab < structure_.slabs.size()) join(slab, tolerance);
}

// Cells that share more than an end are connected.
void CellAdjacency::join(std::size_t upper_slab, double tolerance) {
  const auto range = [this](std::size_t slab, std::size_t cell, bool top) {
    return std::pair{point({slab, cell, false, top}).stiffness, point({slab, cell, true, top}).stiffness};
  };
  for (std::size_t below = 0; below < structure_.slabs[upper_slab - 1].cells.size(); ++below) {
    const auto [low, high] = range(upper_slab - 1, below, true);
    for (std::size_t above = 0; above < structure_.slabs[upper_slab].cells.size(); ++above) {
      const auto [first, last] = range(upper_slab, above, false);
      if (std::min(high, last) - std::max(low, first) <= tolerance) continue;
      parents_[root(first_cell_[upper_slab - 1] + below)] = root(first_cell_[upper_slab] + above);
    }
  }
}

}  // namespace zwidth::internal

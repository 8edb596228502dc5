#include "zwidth/design/shared_walls.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "design/region/region_structure.hpp"
#include "infinity.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double as_good = 1.0 - 2e-3;  // of the stiffest: worth refining, for between vertices K may be larger
constexpr double same_extreme = 1e-9;   // relative
constexpr int tip_halvings = 52;
constexpr std::uintmax_t most_refinements = 100;

/// An edge of an outline, straight, from lower to upper B.
struct Edge {
  double lower = 0.0;
  double upper = 0.0;
  double stiffness_at_lower = 0.0;
  double stiffness_at_upper = 0.0;

  [[nodiscard]] double at(double damping) const {
    return std::lerp(stiffness_at_lower, stiffness_at_upper, (damping - lower) / (upper - lower));
  }
};

std::vector<Edge> edges_of(const StableRegion& region) {
  std::vector<Edge> edges;
  for (const StableComponent& component : region.components) {
    for (const BoundaryArc& arc : component.outline.arcs) {
      for (std::size_t i = 1; i < arc.points.size(); ++i) {
        const BoundaryPoint& a = arc.points[i - 1];
        const BoundaryPoint& b = arc.points[i];
        if (a.damping < b.damping) edges.push_back({a.damping, b.damping, a.stiffness, b.stiffness});
        if (a.damping > b.damping) edges.push_back({b.damping, a.damping, b.stiffness, a.stiffness});
      }
    }
  }
  std::ranges::sort(edges, {}, &Edge::lower);
  return edges;
}

/// The edges that cross a strip of B that holds no vertex, by rising K: two by two they bound what is stable.
class Strips {
 public:
  explicit Strips(std::vector<Edge> edges) : edges_(std::move(edges)) {}

  /// Strips must be asked for by rising B.
  const std::vector<Edge>& between(double lower, double upper) {
    std::erase_if(here_, [&](const Edge& each) { return each.upper <= lower; });
    for (; next_ < edges_.size() && edges_[next_].lower <= lower; ++next_) {
      if (edges_[next_].upper > lower) here_.push_back(edges_[next_]);
    }
    const double middle = std::midpoint(lower, upper);
    std::ranges::sort(here_, {}, [&](const Edge& each) { return each.at(middle); });
    return here_;
  }

 private:
  std::vector<Edge> edges_;
  std::size_t next_ = 0;
  std::vector<Edge> here_;
};

void add_crossings(const std::vector<Edge>& first, const std::vector<Edge>& second, double lower, double upper,
                   std::vector<double>& crossings) {
  for (const Edge& a : first) {
    for (const Edge& b : second) {
      const double below = a.at(lower) - b.at(lower);
      const double above = a.at(upper) - b.at(upper);
      if (below * above >= 0.0) continue;
      const double crossing = std::lerp(lower, upper, below / (below - above));
      if (crossing > lower && crossing < upper) crossings.push_back(crossing);
    }
  }
}

/// Length of what is between edges of both at this B.
double shared_length(const std::vector<Edge>& first, const std::vector<Edge>& second, double damping) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < first.size(); i += 2) {
    for (std::size_t j = 0; j + 1 < second.size(); j += 2) {
      const double low = std::max(first[i].at(damping), second[j].at(damping));
      const double high = std::min(first[i + 1].at(damping), second[j + 1].at(damping));
      length += std::max(0.0, high - low);
    }
  }
  return length;
}

/// The area of both, and the levels of B between which nothing but straight edges runs, none across another.
std::pair<double, std::vector<double>> clipped(const StableRegion& first, const StableRegion& second) {
  std::vector<Edge> of_first = edges_of(first);
  std::vector<Edge> of_second = edges_of(second);
  std::vector<double> levels;
  for (const auto* edges : {&of_first, &of_second}) {
    for (const Edge& each : *edges) levels.insert(levels.end(), {each.lower, each.upper});
  }
  std::ranges::sort(levels);
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  Strips strips_of_first(std::move(of_first));
  Strips strips_of_second(std::move(of_second));
  double area = 0.0;
  std::vector<double> all;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const std::vector<Edge>& a = strips_of_first.between(levels[i - 1], levels[i]);
    const std::vector<Edge>& b = strips_of_second.between(levels[i - 1], levels[i]);
    std::vector<double> ends{levels[i - 1], levels[i]};
    add_crossings(a, b, levels[i - 1], levels[i], ends);
    std::ranges::sort(ends);
    for (std::size_t k = 1; k < ends.size(); ++k) {
      area += shared_length(a, b, std::midpoint(ends[k - 1], ends[k])) * (ends[k] - ends[k - 1]);
    }
    all.insert(all.end(), ends.begin(), ends.end() - 1);
  }
  if (!levels.empty()) all.push_back(levels.back());
  return {area, std::move(all)};
}

/// The exact walls of both at any B.
class BothWalls {
 public:
  BothWalls(const StableWalls& nobody, const StableWalls& user) : nobody_(nobody), user_(user) {}

  [[nodiscard]] std::vector<StableInterval> at(double damping) const {
    std::vector<StableInterval> both;
    const std::vector<StableInterval> users = user_.stable_stiffnesses(damping);
    for (const StableInterval& a : nobody_.stable_stiffnesses(damping)) {
      for (const StableInterval& b : users) {
        const double upper = std::min(a.upper.value_or(infinity), b.upper.value_or(infinity));
        const StableInterval shared{std::max(a.lower, b.lower),
                                    std::isfinite(upper) ? std::optional(upper) : std::nullopt};
        if (shared.lower < upper) both.push_back(shared);
      }
    }
    return both;
  }

  /// 0 where there is none.
  [[nodiscard]] double stiffest_at(double damping) const {
    double stiffest = 0.0;
    for (const StableInterval& each : at(damping)) stiffest = std::max(stiffest, each.upper.value_or(infinity));
    return stiffest;
  }

  /// The boundary that runs nearest to K at this B.
  [[nodiscard]] SharedPoint boundary_at(double stiffness, double damping) const {
    const auto [of_nobody, nobody_off] = nearest(nobody_, stiffness, damping);
    const auto [of_user, user_off] = nearest(user_, stiffness, damping);
    return nobody_off <= user_off ? SharedPoint{of_nobody, Holder::nobody} : SharedPoint{of_user, Holder::user};
  }

 private:
  static std::pair<BoundaryPoint, double> nearest(const StableWalls& walls, double stiffness, double damping) {
    const RegionStructure& structure = walls.structure();
    const auto slab = std::ranges::find_if(structure.slabs, [&](const RegionSlab& s) { return damping < s.upper; });
    BoundaryPoint best{stiffness, damping, std::nullopt, std::nullopt};
    double least = infinity;
    if (slab == structure.slabs.end()) return {best, least};
    const auto consider = [&](const RegionEdge& edge) {
      const RegionStructure::EdgePoint at = structure.edge_at(edge, damping);
      if (const double off = std::abs(at.stiffness - stiffness); off < least) {
        least = off;
        best = point_on(structure, edge, at, damping);
      }
    };
    for (const RegionCell& cell : slab->cells) {
      consider(cell.left);
      if (cell.right) consider(*cell.right);
    }
    return {best, least};
  }

  static BoundaryPoint point_on(const RegionStructure& structure, const RegionEdge& edge,
                                const RegionStructure::EdgePoint& at, double damping) {
    if (edge.kind == BoundaryKind::no_stiffness || edge.kind == BoundaryKind::no_damping) {
      return {at.stiffness, damping, std::nullopt, std::nullopt};
    }
    const double angle = edge.kind == BoundaryKind::oscillation ? at.angle
                         : edge.kind == BoundaryKind::nyquist   ? std::numbers::pi
                                                                : 0.0;
    return structure.seen_at({at.stiffness, damping}, angle);
  }

  const StableWalls& nobody_;
  const StableWalls& user_;
};

/// The B of the stiffest wall of both: at a level or refined beside it.
double damping_of_stiffest(const BothWalls& walls, const std::vector<double>& levels) {
  std::vector<double> dampings;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    dampings.push_back(levels[i]);
    if (i + 1 < levels.size()) dampings.push_back(std::midpoint(levels[i], levels[i + 1]));
  }
  std::vector<double> stiffest;
  stiffest.reserve(dampings.size());
  for (const double damping : dampings) stiffest.push_back(walls.stiffest_at(damping));
  const auto most = std::ranges::max_element(stiffest);
  double best = dampings[static_cast<std::size_t>(most - stiffest.begin())];
  double greatest = *most;
  const double worth_refining = as_good * greatest;
  const auto at = [&](std::size_t i) { return i < stiffest.size() ? stiffest[i] : -1.0; };
  for (std::size_t i = 0; i < dampings.size(); ++i) {
    if (stiffest[i] < worth_refining || stiffest[i] < at(i + 1) || (i > 0 && stiffest[i] < at(i - 1))) continue;
    std::uintmax_t steps = most_refinements;
    const double from = dampings[i > 0 ? i - 1 : 0];
    const double to = dampings[std::min(i + 1, dampings.size() - 1)];
    const auto [damping, negative] = boost::math::tools::brent_find_minima(
        [&](double b) { return -walls.stiffest_at(b); }, from, to, std::numeric_limits<double>::digits / 2, steps);
    if (-negative <= greatest) continue;
    greatest = -negative;
    best = damping;
  }
  return best;
}

/// The extreme of one region where it is that of both, so that it is told in the same digits.
std::optional<SharedPoint> extreme_of(const std::optional<BoundaryPoint>& nobodys,
                                      const std::optional<BoundaryPoint>& users, double BoundaryPoint::*member,
                                      double value) {
  const auto is_it = [&](const std::optional<BoundaryPoint>& point) {
    return point && std::abs((*point).*member - value) <= same_extreme * value;
  };
  if (is_it(nobodys)) return SharedPoint{*nobodys, Holder::nobody};
  if (is_it(users)) return SharedPoint{*users, Holder::user};
  return std::nullopt;
}

}  // namespace

SharedWalls shared_walls(const StableWalls& nobody, const StableRegion& nobodys_region, const StableWalls& user,
                         const StableRegion& users_region) {
  SharedWalls shared;
  shared.critical_stiffness = std::min(nobodys_region.critical_stiffness, users_region.critical_stiffness);
  if (!nobodys_region.bounded || !users_region.bounded) {  // every wall of one: those of the other are left
    const bool is_users = users_region.bounded;
    const StableRegion& left = is_users ? users_region : nobodys_region;
    const Holder holder = is_users ? Holder::user : Holder::nobody;
    shared.area = left.bounded ? left.area : infinity;
    if (left.stiffest) shared.stiffest = SharedPoint{*left.stiffest, holder};
    if (left.most_damped) shared.most_damped = SharedPoint{*left.most_damped, holder};
    return shared;
  }
  if (!nobodys_region.stiffest || !users_region.stiffest) return shared;
  auto [area, levels] = clipped(nobodys_region, users_region);
  const BothWalls walls(nobody, user);
  std::erase_if(levels, [&](double level) {
    return level > std::min(nobodys_region.most_damped->damping, users_region.most_damped->damping);
  });
  shared.area = area;
  const double damping = damping_of_stiffest(walls, levels);
  const double stiffness = walls.stiffest_at(damping);
  if (stiffness == 0.0) return shared;
  shared.stiffest = extreme_of(nobodys_region.stiffest, users_region.stiffest, &BoundaryPoint::stiffness, stiffness);
  if (!shared.stiffest) shared.stiffest = walls.boundary_at(stiffness, damping);

  // The last B with a wall of both lies above the last strip that has one, and not above the next end.
  double in = damping;
  double out = levels.back();
  for (std::size_t i = levels.size(); i-- > 1;) {
    const double middle = std::midpoint(levels[i - 1], levels[i]);
    if (walls.at(middle).empty()) continue;
    in = std::max(in, middle);
    out = levels[std::min(i + 1, levels.size() - 1)];
    break;
  }
  for (int i = 0; i < tip_halvings && in < out; ++i) {
    const double middle = std::midpoint(in, out);
    (walls.at(middle).empty() ? out : in) = middle;
  }
  shared.most_damped = extreme_of(nobodys_region.most_damped, users_region.most_damped, &BoundaryPoint::damping, in);
  if (!shared.most_damped) {
    const std::vector<StableInterval> last = walls.at(in);
    shared.most_damped = walls.boundary_at(last.empty() ? stiffness : last.back().upper.value_or(stiffness), in);
  }
  return shared;
}

}  // namespace zwidth

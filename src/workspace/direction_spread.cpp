#include "workspace/direction_spread.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <set>

#include "zwidth/model/tip_motion.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;

constexpr std::size_t usual_in_plane = 12;
constexpr std::size_t usual_in_space = 48;
constexpr double worth_refining_within = 1.3;  // times the least of those tried
constexpr std::size_t most_lows = 3;
constexpr std::size_t most_compared = 1000;  // beyond, the least alone is refined
constexpr double neighbours_within = 1.7;    // spacings
constexpr double neighbours_of_jump = 1.3;   // spacings
constexpr double jump_in_plane = 1.3;        // of neighbouring limits
constexpr double jump_in_space = 1.5;
constexpr int halvings_in_plane = 4;
constexpr int halvings_in_space = 2;
constexpr int plane_bits = 10;
constexpr std::uintmax_t most_plane_steps = 40;
constexpr double finest_step = 2e-3;  // rad
constexpr int most_sphere_steps = 16;
constexpr double shrunk = 0.3;
constexpr double axis_that_shows = 0.3;  // of a world's axis, in the plane
constexpr double same_wall = 1e-9;       // rad

double finite(double value) { return std::isfinite(value) ? value : std::numeric_limits<double>::max(); }

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(std::abs(a.dot(b)), 1.0));
}

double spacing_of(Eigen::Index moved, std::size_t count) {
  const auto number = static_cast<double>(count);
  return moved == 2 ? pi / number : std::sqrt(2.0 * pi / number);
}

// The numbers of those that are less than their neighbours, least first.
std::vector<std::size_t> lows(const std::vector<Eigen::Vector3d>& tried, const std::vector<double>& values,
                              double spacing) {
  const auto least = static_cast<std::size_t>(std::ranges::min_element(values) - values.begin());
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < tried.size() && tried.size() <= most_compared; ++i) {
    bool is_low = values[i] <= worth_refining_within * values[least];
    for (std::size_t j = 0; is_low && j < tried.size(); ++j) {
      const bool is_lower = values[j] < values[i] || (values[j] == values[i] && j < i);
      is_low = !is_lower || angle_between(tried[i], tried[j]) > neighbours_within * spacing;
    }
    if (is_low) found.push_back(i);
  }
  std::ranges::stable_sort(found, {}, [&](std::size_t i) { return values[i]; });
  if (found.empty()) found.push_back(least);
  if (found.size() > most_lows) found.resize(most_lows);
  return found;
}

using Function = std::function<double(const Eigen::Vector3d&)>;

// A limit jumps over directions where a crossover appears, and may be least in a few degrees beside the jump. Between neighbours that
// differ by more than a continuous limit would, halves are looked at; the least of them, and half of what they are apart.
class JumpSearch {
 public:
  JumpSearch(const Function& function, Eigen::Index moved, double spacing)
      : function_(function),
        jump_(moved == 2 ? jump_in_plane : jump_in_space),
        halvings_(moved == 2 ? halvings_in_plane : halvings_in_space),
        half_apart_(spacing / std::exp2(halvings_)) {}

  void look_between(const Eigen::Vector3d& a, double at_a, const Eigen::Vector3d& b, double at_b) {
    const Eigen::Vector3d same_side = a.dot(b) < 0.0 ? Eigen::Vector3d(-b) : b;
    look(a, at_a, same_side, at_b, halvings_);
  }

  [[nodiscard]] const LeastDirection& least() const { return least_; }
  [[nodiscard]] double half_apart() const { return half_apart_; }

 private:
  void look(const Eigen::Vector3d& a, double at_a, const Eigen::Vector3d& b, double at_b, int halvings) {
    const bool is_jump = std::max(at_a, at_b) > jump_ * std::min(at_a, at_b);
    if (halvings == 0 || !is_jump) return;
    const Eigen::Vector3d middle = (a + b).normalized();
    const double value = finite(function_(middle));
    if (value < least_.value) least_ = {middle, value};
    look(a, at_a, middle, value, halvings - 1);
    look(middle, value, b, at_b, halvings - 1);
  }

  const Function& function_;
  double jump_;
  int halvings_;
  double half_apart_;
  LeastDirection least_{Eigen::Vector3d::Zero(), std::numeric_limits<double>::max()};
};

LeastDirection least_in_plane(const Eigen::Vector3d& near, const Eigen::MatrixXd& moved, double spacing,
                              const Function& function) {
  const Eigen::Vector2d along = moved.transpose() * near;
  const double middle = std::atan2(along.y(), along.x());
  const auto normal_at = [&](double angle) -> Eigen::Vector3d {
    return moved * Eigen::Vector2d(std::cos(middle + angle), std::sin(middle + angle));
  };
  std::uintmax_t steps = most_plane_steps;
  // About 1, for its tolerance is relative.
  const auto found = boost::math::tools::brent_find_minima(
      [&](double shifted) { return finite(function(normal_at((shifted - 2.0) * spacing))); }, 1.0, 3.0, plane_bits,
      steps);
  return {normal_at((found.first - 2.0) * spacing), found.second};
}

// By parabolas through five normals about the best so far, and steps to them.
LeastDirection least_on_sphere(LeastDirection best, double spacing, const Function& function) {
  double h = 0.5 * spacing;
  for (int step = 0; step < most_sphere_steps && h > finest_step; ++step) {
    const Eigen::Vector3d centre = best.normal;
    const double at_centre = best.value;
    const Eigen::Vector3d e1 = centre.unitOrthogonal();
    const Eigen::Vector3d e2 = centre.cross(e1);
    const auto try_at = [&](double x, double y) {
      const Eigen::Vector3d normal = (centre + x * e1 + y * e2).normalized();
      const double value = finite(function(normal));
      if (value < best.value) best = {normal, value};
      return value;
    };
    const double right = try_at(h, 0.0);
    const double left = try_at(-h, 0.0);
    const double up = try_at(0.0, h);
    const double down = try_at(0.0, -h);
    const double corner = try_at(h, h);
    const Eigen::Vector2d slope((right - left) / (2.0 * h), (up - down) / (2.0 * h));
    Eigen::Matrix2d curvature;
    curvature(0, 0) = (right + left - 2.0 * at_centre) / (h * h);
    curvature(1, 1) = (up + down - 2.0 * at_centre) / (h * h);
    curvature(0, 1) = curvature(1, 0) = (corner - right - up + at_centre) / (h * h);
    const double determinant = curvature(0, 0) * curvature(1, 1) - curvature(0, 1) * curvature(1, 0);
    if (curvature(0, 0) > 0.0 && determinant > 0.0 && std::isfinite(determinant)) {
      Eigen::Vector2d to(-(curvature(1, 1) * slope(0) - curvature(0, 1) * slope(1)) / determinant,
                         -(curvature(0, 0) * slope(1) - curvature(1, 0) * slope(0)) / determinant);
      if (to.norm() > 2.0 * h) to *= 2.0 * h / to.norm();
      try_at(to(0), to(1));
    }
    const bool is_near = angle_between(best.normal, centre) < 0.7 * h;
    if (is_near) h *= shrunk;
  }
  return best;
}

}  // namespace

Eigen::MatrixXd moved_directions(const Eigen::MatrixXd& tip) {
  Eigen::MatrixXd moved = tip_directions(tip);
  if (moved.cols() == 3) return Eigen::Matrix3d::Identity();
  if (moved.cols() == 1) {
    Eigen::Index largest = 0;
    moved.col(0).cwiseAbs().maxCoeff(&largest);
    if (moved(largest, 0) < 0.0) moved = -moved;
  }
  if (moved.cols() != 2) return moved;
  const Eigen::Matrix3d onto = moved * moved.transpose();
  Eigen::Index axis = 0;
  while (axis < 2 && onto.col(axis).norm() < axis_that_shows) ++axis;
  const Eigen::Vector3d first = onto.col(axis).normalized();
  Eigen::Vector3d across = moved.col(0).head<3>().cross(moved.col(1).head<3>());
  Eigen::Index largest = 0;
  across.cwiseAbs().maxCoeff(&largest);
  if (across(largest) < 0.0) across = -across;
  moved.col(0) = first;
  moved.col(1) = across.cross(first);
  return moved;
}

std::vector<Eigen::Vector3d> distinct_walls(const std::vector<Eigen::Vector3d>& normals) {
  std::set<std::array<std::int64_t, 3>> seen;
  std::vector<Eigen::Vector3d> walls;
  for (const Eigen::Vector3d& each : normals) {
    const Eigen::Vector3d normal = each.stableNormalized();
    std::array<std::int64_t, 3> place{};
    std::ranges::transform(normal, place.begin(), [](double part) { return std::llround(part / same_wall); });
    const auto* const first = std::ranges::find_if(place, [](std::int64_t part) { return part != 0; });
    const bool is_turned = first != place.end() && *first < 0;
    if (is_turned) std::ranges::transform(place, place.begin(), std::negate{});
    if (seen.insert(place).second) walls.push_back(each);
  }
  return walls;
}

std::size_t usual_directions(Eigen::Index moved) {
  return moved == 3 ? usual_in_space : moved == 2 ? usual_in_plane : 1;
}

std::vector<Eigen::Vector3d> spread_directions(const Eigen::MatrixXd& moved, std::size_t count) {
  std::vector<Eigen::Vector3d> spread;
  if (moved.cols() == 1) return {moved.col(0)};
  const auto number = static_cast<double>(count);
  const double turn = pi * (3.0 - std::sqrt(5.0));
  for (std::size_t i = 0; moved.cols() > 0 && i < count; ++i) {
    const auto each = static_cast<double>(i);
    if (moved.cols() == 2) {
      spread.emplace_back(moved * Eigen::Vector2d(std::cos(pi * each / number), std::sin(pi * each / number)));
      continue;
    }
    const double z = 1.0 - (each + 0.5) / number;
    const double r = std::sqrt(1.0 - z * z);
    spread.emplace_back(r * std::cos(turn * each), r * std::sin(turn * each), z);
  }
  return spread;
}

std::vector<Eigen::Vector3d> directions_beside(const Eigen::MatrixXd& all, const Eigen::MatrixXd& left) {
  std::vector<Eigen::Vector3d> beside;
  Eigen::MatrixXd taken = left;
  for (Eigen::Index count = left.cols(); count < all.cols(); ++count) {
    const Eigen::MatrixXd rest = all - taken * (taken.transpose() * all);
    Eigen::Index largest = 0;
    rest.colwise().norm().maxCoeff(&largest);
    beside.emplace_back(rest.col(largest).normalized());
    taken.conservativeResize(3, taken.cols() + 1);
    taken.rightCols(1) = beside.back();
  }
  return beside;
}

LeastDirection least_direction(const std::vector<Eigen::Vector3d>& tried, const std::vector<double>& values,
                               const Eigen::MatrixXd& moved, const Function& function, bool may_jump) {
  std::vector<double> finite_values;
  finite_values.reserve(values.size());
  for (const double each : values) finite_values.push_back(finite(each));
  const double spacing = spacing_of(moved.cols(), tried.size());
  const std::vector<std::size_t> low = lows(tried, finite_values, spacing);
  LeastDirection least{tried[low.front()], values[low.front()]};
  if (moved.cols() < 2 || tried.size() < 2 || !std::isfinite(least.value)) return least;
  for (const std::size_t i : low) {
    const LeastDirection found = moved.cols() == 2 ? least_in_plane(tried[i], moved, spacing, function)
                                                   : least_on_sphere({tried[i], values[i]}, spacing, function);
    if (found.value < least.value) least = found;
  }
  if (!may_jump) return least;
  JumpSearch jumps(function, moved.cols(), spacing);
  for (std::size_t i = 0; i < tried.size() && tried.size() <= most_compared; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (angle_between(tried[i], tried[j]) > neighbours_of_jump * spacing) continue;
      jumps.look_between(tried[i], finite_values[i], tried[j], finite_values[j]);
    }
  }
  if (!(jumps.least().value < least.value)) return least;
  const LeastDirection found = moved.cols() == 2
                                   ? least_in_plane(jumps.least().normal, moved, jumps.half_apart(), function)
                                   : least_on_sphere(jumps.least(), jumps.half_apart(), function);
  return found.value < jumps.least().value ? found : jumps.least();
}

}  // namespace zwidth::internal

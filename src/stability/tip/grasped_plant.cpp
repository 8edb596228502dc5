#include <algorithm>
#include <cmath>
#include <complex>
#include <deque>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "stability/tip/grasp_discs.hpp"
#include "stability/tip/grasp_search.hpp"
#include "stability/tip/grasp_stiffness.hpp"
#include "stability/tip/tip_response.hpp"
#include "stability/tip/tip_states.hpp"
#include "zwidth/sampling/filter_section.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth {
namespace {

DeviceParameters nobody_holding(DeviceParameters loop) {
  loop.user = {};
  return loop;
}

// Of c[0] + c[1] delta + c[2] delta^2, in z.
void add_roots(const std::vector<double>& c, std::vector<std::complex<double>>& roots) {
  if (c.size() > 2 && c[2] != 0.0) {
    const std::complex<double> root = std::sqrt(std::complex<double>(c[1] * c[1] - 4.0 * c[2] * c[0]));
    for (const double sign : {1.0, -1.0}) roots.push_back(1.0 + (-c[1] + sign * root) / (2.0 * c[2]));
  } else if (c.size() > 1 && c[1] != 0.0) {
    roots.emplace_back(1.0 - c[0] / c[1]);
  }
}

std::vector<std::complex<double>> corners_of(const Wall& wall, double period) {
  std::vector<std::complex<double>> corners;
  for (const WallFilter& filter : wall.filters) {
    const FilterCoefficients coefficients = in_delta(filter_section(filter, period));
    add_roots(coefficients.numerator, corners);
    add_roots(coefficients.denominator, corners);
  }
  return corners;
}

// The plant whose tip is grasped in the directions of a motion.
struct GraspedMotion {
  GraspedMotion(const TipMotion& motion, const DeviceParameters& loop, const Eigen::Vector3d& normal)
      : directions(tip_directions(motion)),
        plant(internal::sampled_tip(internal::tip_coordinates(motion, directions), loop)),
        search(motion, loop, directions, plant, corners_of(loop.wall, loop.loop.sampling_period)) {
    along.head(directions.cols()) = directions.transpose() * normal.normalized();
    discs.emplace(search, along);
  }
  GraspedMotion(const GraspedMotion&) = delete;
  GraspedMotion& operator=(const GraspedMotion&) = delete;
  ~GraspedMotion() = default;

  [[nodiscard]] GraspedPlant::Disc at(double angle) const {
    if (search.discs().is_undamped()) {
      const Eigen::VectorXd wall = along.head(directions.cols());
      return {(wall.transpose() * internal::TipResponse(plant).at(angle) * wall).value(),
              std::numeric_limits<double>::infinity()};
    }
    const internal::TerminationDiscs::Disc disc = internal::disc_along(search.discs().at(angle), along);
    return {disc.centre, disc.radius};
  }

  Eigen::MatrixXd directions;
  internal::SampledTip plant;
  internal::GraspSearch search;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  // the normal in the tip's directions
  std::optional<internal::GraspSearch::Along> discs;
};

// The least disc that holds both.
GraspedPlant::Disc around(const GraspedPlant::Disc& a, const GraspedPlant::Disc& b) {
  const double apart = std::abs(b.centre - a.centre);
  if (!(apart + b.radius > a.radius)) return a;
  if (!(apart + a.radius > b.radius)) return b;
  const double radius = 0.5 * (apart + a.radius + b.radius);
  return {a.centre + (radius - a.radius) / apart * (b.centre - a.centre), radius};
}

}  // namespace

struct GraspedPlant::Parts {
  Parts(const TipMotion& motion, const DeviceParameters& with, const Eigen::Vector3d& normal)
      : period(with.loop.sampling_period) {
    internal::require_tip_moves_along(motion, normal);
    for (const TipMotion& each : internal::grasped_motions(motion)) {
      motions.emplace_back(each, nobody_holding(with), normal);
    }
  }

  double period;
  std::deque<GraspedMotion> motions;
};

GraspedPlant::GraspedPlant(const TipMotion& motion, const DeviceParameters& loop, const Eigen::Vector3d& normal)
    : parts_(std::make_shared<const Parts>(motion, loop, normal)) {}

GraspedPlant::Disc GraspedPlant::at(double frequency) const {
  const double angle = std::min(frequency * parts_->period, std::numbers::pi);
  Disc disc = parts_->motions.front().at(angle);
  for (std::size_t i = 1; i < parts_->motions.size(); ++i) disc = around(disc, parts_->motions[i].at(angle));
  return disc;
}

GraspLimit GraspedPlant::least_gain(const std::function<Wall(double frequency)>& wall) const {
  const double period = parts_->period;
  GraspLimit least{.stiffness = std::numeric_limits<double>::infinity()};
  for (const GraspedMotion& each : parts_->motions) {
    const internal::GraspSearch::Wall walls = each.search.wall([&](double angle) {
      const auto [unit, closed] = wall(angle / period);
      return internal::WallResponse{unit, closed};
    });
    const internal::GraspSearch::Least found = each.discs.value().least(walls);
    if (found.gain < least.stiffness || std::isnan(found.gain))
      least = {found.gain, internal::frequency_of(found, period)};
  }
  return least;
}

bool GraspedPlant::is_undamped() const {
  return std::ranges::any_of(parts_->motions,
                             [](const GraspedMotion& each) { return each.search.discs().is_undamped(); });
}

}  // namespace zwidth

#include <algorithm>
#include <cmath>
#include <complex>
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
#include "zwidth/error.hpp"
#include "zwidth/sampling/filter_section.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth {
namespace {

constexpr double tip_stands_below = 1e-9;  // what the tip moves of a normal

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

}  // namespace

struct GraspedPlant::Parts {
  Parts(const TipMotion& motion, const DeviceParameters& with, const Eigen::Vector3d& normal)
      : loop(nobody_holding(with)),
        directions(tip_directions(motion)),
        plant(internal::sampled_tip(internal::tip_coordinates(motion, directions), loop)),
        search(motion, loop, directions, plant, corners_of(loop.wall, loop.loop.sampling_period)) {
    along.head(directions.cols()) = directions.transpose() * normal.normalized();
    if (!(along.norm() > tip_stands_below))
      throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::tip_does_not_move,
                                                .evidence = {{"x", normal.x()}, {"y", normal.y()}, {"z", normal.z()}}});
    discs.emplace(search, along);
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
  ~Parts() = default;

  DeviceParameters loop;
  Eigen::MatrixXd directions;
  internal::SampledTip plant;
  internal::GraspSearch search;
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  // the normal in the tip's directions
  std::optional<internal::GraspSearch::Along> discs;
};

GraspedPlant::GraspedPlant(const TipMotion& motion, const DeviceParameters& loop, const Eigen::Vector3d& normal)
    : parts_(std::make_shared<const Parts>(motion, loop, normal)) {}

GraspedPlant::Disc GraspedPlant::at(double frequency) const {
  const Eigen::Vector3d& normal = parts_->along;
  const double angle = std::min(frequency * parts_->plant.period, std::numbers::pi);
  const internal::GraspDiscs& discs = parts_->search.discs();
  if (discs.is_undamped()) {
    const Eigen::VectorXd along = normal.head(parts_->directions.cols());
    return {(along.transpose() * internal::TipResponse(parts_->plant).at(angle) * along).value(),
            std::numeric_limits<double>::infinity()};
  }
  const internal::TerminationDiscs::Disc disc = internal::disc_along(discs.at(angle), normal);
  return {disc.centre, disc.radius};
}

GraspLimit GraspedPlant::least_gain(const std::function<Wall(double frequency)>& wall) const {
  const double period = parts_->plant.period;
  const internal::GraspSearch::Wall walls = parts_->search.wall([&](double angle) {
    const auto [unit, closed] = wall(angle / period);
    return internal::WallResponse{unit, closed};
  });
  const internal::GraspSearch::Least least = parts_->discs->least(walls);
  return {least.gain, internal::frequency_of(least, period)};
}

bool GraspedPlant::is_undamped() const { return parts_->search.discs().is_undamped(); }

}  // namespace zwidth

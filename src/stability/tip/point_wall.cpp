#include "zwidth/stability/point_wall.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "stability/tip/gain_march.hpp"
#include "stability/tip/loop_crossovers.hpp"
#include "stability/tip/tip_states.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using internal::GainLimit;

Eigen::MatrixXd all_directions(const TipMotion& motion) {
  Eigen::MatrixXd directions = tip_directions(motion);
  if (directions.cols() == 0) throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::tip_stands_still});
  return directions;
}

// Along which a motion a cos + b sin is largest.
Eigen::Vector3d largest_along(const Eigen::MatrixXd& directions, const Eigen::VectorXcd& motion) {
  const std::complex<double> square = (motion.transpose() * motion).value();
  const Eigen::VectorXd largest = (motion * std::polar(1.0, -0.5 * std::arg(square))).real();
  return (directions * largest).normalized();
}

PointWallLimit limit_along(const TipMotion& motion, const DeviceParameters& loop, const Eigen::MatrixXd& directions) {
  internal::require_plain_wall(loop);
  const internal::GainLoop closed = internal::stiffness_loop(
      internal::sampled_tip(internal::tip_coordinates(motion, directions, loop.user), loop), loop.wall);
  const GainLimit found = internal::first_crossing(closed);
  PointWallLimit limit;
  switch (found.kind) {
    case GainLimit::Kind::crossing:
      limit.status = StiffnessStatus::finite;
      limit.stiffness = found.gain * closed.unit;
      limit.frequency = found.angle / closed.period;
      limit.direction = largest_along(directions, found.motion);
      break;
    case GainLimit::Kind::none_stable:
      limit.status = StiffnessStatus::none_stable;
      break;
    case GainLimit::Kind::unbounded:
      limit.status = StiffnessStatus::unbounded;
      limit.stiffness = std::numeric_limits<double>::infinity();
      break;
    case GainLimit::Kind::not_determined:
      limit.stiffness = std::numeric_limits<double>::quiet_NaN();
      limit.trust.refuse({.code = FindingCode::poles_along_circle});
      break;
  }
  return limit;
}

// The factor at which a march from a gain ends.
std::optional<double> factor_of(const GainLimit& limit, double gain, PointWallMargins& margins) {
  if (limit.kind == GainLimit::Kind::not_determined) margins.margins_are_known = false;
  if (limit.kind != GainLimit::Kind::crossing) return std::nullopt;
  return limit.gain / gain;
}

// Of stiffness and damper together.
void add_gain_margins(const internal::GainLoop& loop, PointWallMargins& margins) {
  margins.gain_margin = factor_of(internal::crossing_above(loop, 1.0), 1.0, margins);
  margins.lower_gain_margin = factor_of(internal::crossing_below(loop, 1.0), 1.0, margins);
}

void add_crossovers(const internal::TipCoordinates& of, const internal::SampledTip& plant, const DeviceParameters& loop,
                    PointWallMargins& margins) {
  const auto points = internal::all_unit_gain_points(plant, loop.wall);
  if (!points) {
    margins.margins_are_known = false;
    return;
  }
  try {
    margins.delay_margin = internal::delay_margin_of_tip(of, loop);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    margins.margins_are_known = false;
    return;
  }
  for (const internal::UnitGainPoint& each : *points) {
    margins.gain_crossovers.push_back({each.angle / plant.period, each.phase});
    margins.phase_margin = std::min(margins.phase_margin.value_or(std::numbers::pi), std::abs(each.phase));
  }
}

}  // namespace

PointWallLimit point_wall_limit(const TipMotion& motion, const DeviceParameters& loop) {
  return limit_along(motion, loop, all_directions(motion));
}

PointWallLimit normal_wall_limit(const TipMotion& motion, const DeviceParameters& loop, const Eigen::Vector3d& normal) {
  return limit_along(motion, loop, normal.normalized());
}

PointWallMargins point_wall_margins(const TipMotion& motion, const DeviceParameters& loop) {
  if (!(loop.wall.stiffness.value_or(0.0) > 0.0)) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::no_wall_stiffness});
  }
  internal::require_plain_wall(loop);
  const internal::TipCoordinates of = internal::tip_coordinates(motion, all_directions(motion), loop.user);
  const internal::SampledTip plant = internal::sampled_tip(of, loop);
  const internal::GainLoop closed = internal::stiffness_loop(plant, loop.wall);
  const double excess = internal::stability_excess(closed, *loop.wall.stiffness / closed.unit);
  PointWallMargins margins;
  margins.stable = excess < 0.0;
  margins.spectral_radius = 1.0 + excess;
  if (!margins.stable) return margins;
  const double gain = *loop.wall.stiffness / closed.unit;
  margins.margins_are_known = true;
  margins.stiffness_margin = factor_of(internal::crossing_above(closed, gain), gain, margins);
  add_gain_margins(internal::wall_loop(plant, loop.wall), margins);
  add_crossovers(of, plant, loop, margins);
  return margins;
}

std::vector<PointWallLimit> point_wall_limits(const TipMotion& motion, const DeviceParameters& loop,
                                              const std::vector<double>& dampings) {
  std::vector<PointWallLimit> limits;
  DeviceParameters with = loop;
  for (const double damping : dampings) {
    with.wall.damping = damping;
    limits.push_back(point_wall_limit(motion, with));
  }
  return limits;
}

}  // namespace zwidth

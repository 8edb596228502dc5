#include "stability/tip/tip_states.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "model/normal_coordinates.hpp"
#include "sampling/matrix_exponential.hpp"
#include "sampling/sampling_instants.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth::internal {
namespace {

// Masses and elements as a device, whose checks and coordinates are known.
Device device_of(const TipMotion& motion, const User& user, const Eigen::MatrixXd& directions) {
  Coordinates coordinates;
  Eigen::MatrixXd mass = 0.5 * (motion.mass + motion.mass.transpose());
  coordinates.elements = motion.elements;
  for (Eigen::Index i = 0; i < directions.cols(); ++i) {
    const Eigen::VectorXd along = motion.tip.transpose() * directions.col(i);
    mass += user.mass * along * along.transpose();
    if (user.stiffness > 0.0 || user.damping > 0.0) {
      coordinates.elements.push_back({{along.begin(), along.end()}, user.stiffness, user.damping});
    }
    coordinates.points.push_back({"tip", {along.begin(), along.end()}});
  }
  coordinates.mass.assign(mass.data(), mass.data() + mass.size());
  DeviceParameters parameters;
  parameters.name = "tip";
  parameters.loop.sampling_period = 1.0;
  parameters.coordinates = std::move(coordinates);
  return Device(std::move(parameters));
}

// e^{At} - 1 and the integral of e^{As} B over 0..t.
struct Step {
  Eigen::MatrixXd Phi;
  Eigen::MatrixXd Gamma;
};
Step step(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double t) {
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(a.rows() + b.cols(), a.rows() + b.cols());
  both.topLeftCorner(a.rows(), a.cols()) = t * a;
  both.topRightCorner(b.rows(), b.cols()) = t * b;
  const Eigen::MatrixXd grown = exponential_minus_one(both);
  return {grown.topLeftCorner(a.rows(), a.cols()), grown.topRightCorner(b.rows(), b.cols())};
}

}  // namespace

void require_tip_moves_along(const TipMotion& motion, const Eigen::Vector3d& normal) {
  if (tip_moves_along(motion.tip, normal)) return;
  throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::tip_does_not_move,
                                            .evidence = {{"x", normal.x()}, {"y", normal.y()}, {"z", normal.z()}}});
}

std::vector<TipMotion> grasped_motions(const TipMotion& motion) {
  if (motion.tips_beside.empty()) return {motion};
  std::vector<TipMotion> beside;
  for (const Eigen::MatrixXd& each : motion.tips_beside) {
    beside.push_back(motion);
    beside.back().tip = each;
    beside.back().tips_beside.clear();
  }
  return beside;
}

TipCoordinates tip_coordinates(const TipMotion& motion, const Eigen::MatrixXd& directions, const User& user) {
  const NormalCoordinates normal = normal_coordinates(device_of(motion, user, directions));
  TipCoordinates of{normal.stiffness, normal.damping, directions.transpose() * motion.sensed * normal.shapes,
                    directions.transpose() * motion.pushed * normal.shapes,
                    directions.transpose() * motion.tip * normal.shapes};
  const UnseenFirst unseen = unseen_first(normal, of.sensed);
  const Eigen::MatrixXd& turn = unseen.turn;
  of.unseen = unseen.unseen;
  of.stiffness = turn.transpose() * of.stiffness * turn;
  of.damping = turn.transpose() * of.damping * turn;
  of.sensed = of.sensed * turn;
  of.pushed = of.pushed * turn;
  of.tip = of.tip * turn;
  return of;
}

// Positions and velocities times T, both times |sensed|; then the forces behind the actuator's lag times the motion that they
// make in T, and the two states of each tracked position, over `seen`: states are of one size, and eigenvalues keep their digits.
SampledTip sampled_tip(const TipCoordinates& of, const DeviceParameters& loop) {
  const double period = loop.loop.sampling_period;
  const double lag = loop.actuator.time_constant;
  const SamplingInstants instants = sampling_instants({period, loop.loop.delay});
  const double seen = of.sensed.norm() > 0.0 ? of.sensed.norm() : 1.0;
  const double moved = of.pushed.norm() > 0.0 ? period * period * of.pushed.norm() : 1.0;
  const Eigen::Index n = of.stiffness.rows();
  const Eigen::Index m = of.sensed.rows();
  const Eigen::Index positions = n - of.unseen;
  const Eigen::Index lags = lag > 0.0 ? m : 0;
  const double bandwidth = loop.sensor.tracking_bandwidth;
  const Eigen::Index tracked = bandwidth > 0.0 ? m : 0;
  const Eigen::Index mechanical = positions + n + lags;
  const Eigen::Index states = mechanical + 2 * tracked;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(states, states);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(states, m);
  a.block(0, positions + of.unseen, positions, positions).diagonal().setConstant(1.0 / period);
  a.block(positions, 0, n, positions) = -period * of.stiffness.rightCols(positions);
  a.block(positions, positions, n, n) = -of.damping;
  if (lags > 0) {
    a.block(positions, positions + n, n, lags) = period / moved * of.pushed.transpose();
    a.block(positions + n, positions + n, lags, lags).diagonal().setConstant(-1.0 / lag);
    b.middleRows(positions + n, lags).diagonal().setConstant(seen * moved / lag);
  } else {
    b.middleRows(positions, n) = seen * period * of.pushed.transpose();
  }
  SampledTip plant;
  plant.period = period;
  plant.delay_samples = static_cast<Eigen::Index>(instants.whole_samples);
  plant.C = Eigen::MatrixXd::Zero(m, states);
  const Eigen::MatrixXd read = of.sensed.rightCols(positions) / seen;
  if (tracked == 0) {
    plant.C.leftCols(positions) = read;
  } else {  // p' = w (2 (y - p) + q), q' = w (y - p)
    a.block(mechanical, 0, m, positions) = 2.0 * bandwidth * read;
    a.block(mechanical + m, 0, m, positions) = bandwidth * read;
    a.block(mechanical, mechanical, m, m).diagonal().setConstant(-2.0 * bandwidth);
    a.block(mechanical, mechanical + m, m, m).diagonal().setConstant(bandwidth);
    a.block(mechanical + m, mechanical, m, m).diagonal().setConstant(-bandwidth);
    plant.C.middleCols(mechanical, m).setIdentity();
  }
  plant.Phi = step(a, b, period).Phi;
  const Step with_new = step(a, b, instants.with_new);
  plant.Gamma1 = with_new.Gamma;
  if (instants.with_old > 0.0) {
    const Eigen::MatrixXd old = step(a, b, instants.with_old).Gamma;
    plant.Gamma2 = old + with_new.Phi * old;
  }
  return plant;
}

SampledTip tip_of_point_wall(const Device& device) {
  DeviceParameters loop = device.parameters();
  loop.wall.damping = 1.0;  // of any size: it varies
  require_plain_wall(loop);
  const TipMotion motion = tip_motion_of(device).value();
  return sampled_tip(tip_coordinates(motion, tip_directions(motion), loop.user), loop);
}

namespace {

// States: x, u[k-1] .. u[k-l-1], and of the damper y[k-1] and T v[k-1].
struct LoopStates {
  GainLoop loop;             // of the stiffness, without the damper
  Eigen::MatrixXd velocity;  // T v of the states; empty without a damper
};

LoopStates loop_states(const SampledTip& plant, const Wall& wall) {
  const Eigen::Index n = plant.Phi.rows();
  const Eigen::Index m = plant.C.rows();
  const Eigen::Index late = plant.delay_samples;
  const Eigen::Index kept = late + (plant.has_fraction() ? 1 : 0);
  const double pole = velocity_filter_pole(wall.velocity_filter_hz, plant.period);
  const Eigen::Index last = wall.damping > 0.0 ? m : 0;
  const Eigen::Index filtered = wall.damping > 0.0 && pole != 0.0 ? m : 0;
  const Eigen::Index states = n + kept * m + last + filtered;
  LoopStates result;
  GainLoop& loop = result.loop;
  loop.period = plant.period;
  const double size = plant.C.norm() * (plant.Gamma1.norm() + (plant.has_fraction() ? plant.Gamma2.norm() : 0.0));
  loop.unit = size > 0.0 ? 1.0 / size : 1.0;
  loop.state = Eigen::MatrixXd::Zero(states, states);
  loop.input = Eigen::MatrixXd::Zero(states, m);
  loop.output = Eigen::MatrixXd::Zero(m, states);
  loop.state.topLeftCorner(n, n) = plant.Phi;
  loop.output.leftCols(n) = plant.C;
  const auto add_force = [&](Eigen::Index samples, const Eigen::MatrixXd& gamma) {
    if (samples == 0) {
      loop.input.topRows(n) += loop.unit * gamma;
    } else {
      loop.state.block(0, n + (samples - 1) * m, n, m) += loop.unit * gamma;
    }
  };
  add_force(late, plant.Gamma1);
  if (plant.has_fraction()) add_force(late + 1, plant.Gamma2);
  for (Eigen::Index i = 0; i < kept; ++i) {
    loop.state.block(n + i * m, n + i * m, m, m).diagonal().setConstant(-1.0);
    if (i > 0) loop.state.block(n + i * m, n + (i - 1) * m, m, m).setIdentity();
  }
  if (kept > 0) loop.input.middleRows(n, m).setIdentity();
  if (last == 0) return result;
  const Eigen::Index at_last = n + kept * m;
  loop.state.block(at_last, 0, m, n) = plant.C;
  loop.state.block(at_last, at_last, m, m).diagonal().setConstant(-1.0);
  Eigen::MatrixXd& velocity = result.velocity;
  velocity = Eigen::MatrixXd::Zero(m, states);
  velocity.leftCols(n) = (1.0 - pole) * plant.C;
  velocity.middleCols(at_last, m).diagonal().setConstant(-(1.0 - pole));
  if (filtered > 0) {
    velocity.rightCols(m).diagonal().setConstant(pole);
    loop.state.bottomRows(m) = velocity;
    loop.state.bottomRightCorner(m, m).diagonal().array() -= 1.0;
  }
  return result;
}

}  // namespace

GainLoop stiffness_loop(const SampledTip& plant, const Wall& wall) {
  auto [loop, velocity] = loop_states(plant, wall);
  if (velocity.size() > 0) loop.state -= wall.damping / plant.period / loop.unit * loop.input * velocity;
  return loop;
}

GainLoop wall_loop(const SampledTip& plant, const Wall& wall) {
  auto [loop, velocity] = loop_states(plant, wall);
  loop.output *= wall.stiffness.value_or(0.0) / loop.unit;
  if (velocity.size() > 0) loop.output += wall.damping / plant.period / loop.unit * velocity;
  return loop;
}

void require_plain_wall(const DeviceParameters& loop) {
  if (!loop.wall.filters.empty() || runs_damper_apart(loop)) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::one_direction_alone});
  }
}

}  // namespace zwidth::internal

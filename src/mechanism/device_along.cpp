#include <cmath>
#include <utility>
#include <vector>

#include "linear_systems.hpp"
#include "mechanism/transmissions.hpp"
#include "model/mechanism_coordinates.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using internal::dependent_below;
using internal::rank_of;
namespace {

// Relative to the largest: what rounding leaves of a weight that is 0.
constexpr double no_weight_below = 1e-14;

[[noreturn]] void refuse_normal(ProblemCode code, const Eigen::Vector3d& normal) {
  refuse_key("mechanism.normal", {.code = code, .evidence = {{"x", normal.x()}, {"y", normal.y()}, {"z", normal.z()}}});
}

// g' A of the motion along q that is g' A where T q = 0: along = t' T + g' A.
Eigen::VectorXd through_cables(const Eigen::VectorXd& along, const Eigen::MatrixXd& cables, const Eigen::MatrixXd& rows,
                               ProblemCode not_determined, const Eigen::Vector3d& normal) {
  if (rows.rows() == 0) refuse_normal(not_determined, normal);
  Eigen::MatrixXd all(cables.rows() + rows.rows(), along.size());
  all << cables, rows;
  if (rank_of(all) < rank_of(cables) + rows.rows()) refuse_normal(ProblemCode::motor_or_encoder_depends, normal);
  const Eigen::MatrixXd columns = all.rowwise().normalized().transpose();
  const Eigen::VectorXd shares = internal::shortest_solutions(columns, along, dependent_below);
  const Eigen::VectorXd of_rows = shares.tail(rows.rows());
  const bool is_along = (columns * shares - along).norm() <= dependent_below * along.norm();
  if (!is_along || !(of_rows.norm() > no_weight_below * shares.norm())) refuse_normal(not_determined, normal);
  return columns.rightCols(rows.rows()) * of_rows;
}

std::vector<double> weights(const Eigen::VectorXd& values) {
  const double least = no_weight_below * values.cwiseAbs().maxCoeff();
  std::vector<double> result;
  for (const double value : values) result.push_back(std::abs(value) > least ? value : 0.0);
  return result;
}

// The index of a point that moves by these weights, a new one where there is none.
std::size_t point(std::vector<Coordinates::Point>& points, const char* name, const Eigen::VectorXd& values) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Map<const Eigen::VectorXd> there(points[i].weights.data(), values.size());
    if ((there - values).norm() <= no_weight_below * values.norm()) return i;
  }
  points.push_back({name, weights(values)});
  return points.size() - 1;
}

Coordinates coordinates_of(const MechanismAtPose& mechanism) {
  Coordinates coordinates;
  const Eigen::MatrixXd mass = 0.5 * (mechanism.mass + mechanism.mass.transpose());
  coordinates.mass.assign(mass.data(), mass.data() + mass.size());
  coordinates.elements = mechanism.elements;
  coordinates.frictions = mechanism.frictions;
  return coordinates;
}

std::vector<double> row_by_row(const Eigen::MatrixXd& matrix) {
  const auto row_major = matrix.transpose().reshaped();
  return {row_major.begin(), row_major.end()};
}

// Of the pose, and of those beside.
std::vector<double> moved_tip(const MechanismAtPose& mechanism) {
  std::vector<double> rows = row_by_row(mechanism.tip);
  for (const Eigen::MatrixXd& each : mechanism.tips_beside) {
    const std::vector<double> beside = row_by_row(each);
    rows.insert(rows.end(), beside.begin(), beside.end());
  }
  return rows;
}

Device point_device(const MechanismAtPose& mechanism, DeviceParameters parameters) {
  Eigen::Index row = 0;
  if (!(mechanism.tip.rowwise().norm().maxCoeff(&row) > 0.0)) {
    refuse_key("mechanism.pose", {.code = ProblemCode::tip_stands_still});
  }
  const TipMotion motion = tip_motion(mechanism);
  Coordinates coordinates = coordinates_of(mechanism);
  coordinates.points = {{"tip", weights(mechanism.tip.row(row).transpose())}};
  coordinates.tip = {moved_tip(mechanism), row_by_row(motion.sensed), row_by_row(motion.pushed)};
  parameters.loop.held = parameters.loop.sensed = parameters.loop.actuated = 0;
  parameters.coordinates = std::move(coordinates);
  return Device(std::move(parameters));
}

void put_coordinates(DeviceParameters& parameters) {
  const MechanismDirection along = *parameters.mechanism;
  const MechanismModel model(along.mechanism);
  const MechanismAtPose at = model.at();
  parameters.mechanism->mechanism.file_numbers = model.file_numbers();
  if (along.is_point) {
    parameters = point_device(at, std::move(parameters)).parameters();
  } else {
    parameters = device_along(at, Eigen::Vector3d(along.normal.data()), std::move(parameters)).parameters();
  }
}

const internal::PutToPoseRegistration registration(put_coordinates);

}  // namespace

Device device_of_mechanism(DeviceParameters parameters) {
  if (!parameters.mechanism) refuse_key("mechanism", {.code = ProblemCode::no_mechanism_at_pose});
  parameters.coordinates.reset();
  return Device(std::move(parameters));
}

TipMotion tip_motion(const MechanismAtPose& mechanism) {
  const Eigen::MatrixXd directions = tip_directions(mechanism.tip);
  TipMotion motion{.mass = 0.5 * (mechanism.mass + mechanism.mass.transpose()),
                   .elements = mechanism.elements,
                   .sensed = Eigen::MatrixXd::Zero(3, mechanism.tip.cols()),
                   .pushed = Eigen::MatrixXd::Zero(3, mechanism.tip.cols()),
                   .tip = mechanism.tip,
                   .tips_beside = mechanism.tips_beside};
  for (Eigen::Index i = 0; i < directions.cols(); ++i) {
    const Eigen::Vector3d normal = directions.col(i);
    const Eigen::VectorXd along = mechanism.tip.transpose() * normal;
    motion.sensed += normal * through_cables(along, mechanism.cables, mechanism.encoders,
                                             ProblemCode::tip_not_determined_by_encoders, normal)
                                  .transpose();
    motion.pushed +=
        normal * through_cables(along, mechanism.cables, mechanism.motors, ProblemCode::tip_not_moved_by_motors, normal)
                     .transpose();
  }
  return motion;
}

Device device_along(const MechanismAtPose& mechanism, const Eigen::Vector3d& normal, DeviceParameters parameters) {
  if (!(normal.norm() > 0.0) || !normal.allFinite()) refuse_normal(ProblemCode::no_direction, normal);
  const Eigen::VectorXd along = mechanism.tip.transpose() * normal.normalized();
  if (!tip_moves_along(mechanism.tip, normal)) refuse_normal(ProblemCode::tip_does_not_move, normal);
  const Eigen::VectorXd sensed =
      through_cables(along, mechanism.cables, mechanism.encoders, ProblemCode::tip_not_determined_by_encoders, normal);
  const Eigen::VectorXd actuated =
      through_cables(along, mechanism.cables, mechanism.motors, ProblemCode::tip_not_moved_by_motors, normal);
  Coordinates coordinates = coordinates_of(mechanism);
  parameters.loop.held = point(coordinates.points, "tip", along);
  parameters.loop.sensed = point(coordinates.points, "encoders", sensed);
  parameters.loop.actuated = point(coordinates.points, "motors", actuated);
  // Along n where that is no direction in which the tip can move: of its part p that is, p c'/(p p') senses along n as c.
  const Eigen::Vector3d part = internal::shortest_solutions(mechanism.tip.transpose(), along, tip_stands_below);
  coordinates.tip = {moved_tip(mechanism),
                     row_by_row(part * sensed.transpose() / part.squaredNorm()),
                     row_by_row(part * actuated.transpose() / part.squaredNorm()),
                     {normal.x(), normal.y(), normal.z()}};
  parameters.bodies.clear();
  parameters.links.clear();
  parameters.coordinates = std::move(coordinates);
  return Device(std::move(parameters));
}

}  // namespace zwidth

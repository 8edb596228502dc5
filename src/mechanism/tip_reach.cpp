#include "mechanism/tip_reach.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "linear_systems.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

constexpr double reached_to = 1e-9;    // m
constexpr double settled_to = 1e-13;   // m, from the point
constexpr double no_closer_by = 1e-9;  // relative, of a step: the tip comes no closer
constexpr int most_steps_of_reach = 200;
constexpr double first_damping = 1e-3;  // of the steps, relative to the largest slope
constexpr double least_damping = 1e-12;
constexpr double greatest_damping = 1e9;
constexpr double eased = 0.2;
constexpr double stiffened = 4.0;
constexpr double past_range = 1e-9;                  // m or rad, that rounding leaves
constexpr double shifts[] = {0.4, -0.4, 0.9, -0.9};  // rad, of further starts; of a slide in tenths of a metre

struct There {
  Eigen::VectorXd position;  // of the joints
  Eigen::Vector3d off;       // from the point to the tip, m
  Eigen::MatrixXd slope;     // of the tip with the joints
  bool in_range = false;
};

class Reach {
 public:
  Reach(const MechanismModel& model, const std::vector<std::size_t>& joints, Eigen::Vector3d point)
      : model_(model), joints_(joints), point_(std::move(point)) {}

  // Levenberg-Marquardt: the least of |off|^2, joints at an end of their range staying there as long as they push outwards.
  [[nodiscard]] std::optional<There> from(Eigen::VectorXd start) const {
    std::optional<There> there = at(kept(std::move(start)));
    if (!there) return std::nullopt;
    double damping = first_damping;
    for (int step = 0; step < most_steps_of_reach && there->off.norm() > settled_to; ++step) {
      const std::optional<There> next = at(kept(there->position - move(*there, damping)));
      if (next && next->off.norm() < there->off.norm()) {
        const bool is_least = there->off.norm() - next->off.norm() < no_closer_by * there->off.norm();
        there = next;
        if (is_least) break;
        damping = std::max(damping * eased, least_damping);
      } else if ((damping *= stiffened) > greatest_damping) {
        break;
      }
    }
    return there;
  }

  [[nodiscard]] Eigen::VectorXd file_pose() const {
    const Eigen::VectorXd all = model_.at().joints;
    Eigen::VectorXd position(size());
    for (Eigen::Index i = 0; i < size(); ++i) position(i) = all(static_cast<Eigen::Index>(joint_of(i)));
    return position;
  }

  [[nodiscard]] Eigen::VectorXd shifted(const Eigen::VectorXd& start, std::size_t number) const {
    Eigen::VectorXd position = start;
    for (Eigen::Index i = 0; i < size(); ++i) {
      const double shift = shifts[(number + static_cast<std::size_t>(i) * (number / std::size(shifts) + 1)) % 4];
      position(i) += joint(i).motion == Motion::rotary ? shift : 0.1 * shift;
    }
    return position;
  }

  [[nodiscard]] JointPositions pose_of(const Eigen::VectorXd& position) const {
    JointPositions pose;
    for (Eigen::Index i = 0; i < size(); ++i) pose[joint(i).name] = position(i);
    return pose;
  }

 private:
  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(joints_.size()); }
  [[nodiscard]] std::size_t joint_of(Eigen::Index i) const { return joints_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const MechanismJoint& joint(Eigen::Index i) const { return model_.joints()[joint_of(i)]; }

  [[nodiscard]] Eigen::VectorXd kept(Eigen::VectorXd position) const {
    for (Eigen::Index i = 0; i < size(); ++i) {
      const std::optional<JointRange>& range = joint(i).range;
      if (range) position(i) = std::clamp(position(i), range->least, range->greatest);
    }
    return position;
  }

  // Nothing where loops do not close.
  [[nodiscard]] std::optional<There> at(const Eigen::VectorXd& position) const try {
    const MechanismAtPose mechanism = model_.at(pose_of(position));
    There there{position, mechanism.tip_position - point_, {}};
    // Motions of one joint each, cables not stretched: [T; E] N = [0; 1].
    const Eigen::Index cables = mechanism.cables.rows();
    Eigen::MatrixXd rows(cables + size(), mechanism.mass.cols());
    rows.topRows(cables) = mechanism.cables;
    for (Eigen::Index i = 0; i < size(); ++i) {
      rows.row(cables + i) = mechanism.joint_motions.row(static_cast<Eigen::Index>(joint_of(i)));
    }
    Eigen::MatrixXd ones = Eigen::MatrixXd::Zero(rows.rows(), size());
    ones.bottomRows(size()).setIdentity();
    there.slope = mechanism.tip * shortest_solutions(rows, ones, smallest_pivot);
    there.in_range = is_within_ranges(model_.joints(), mechanism.joints);
    return there;
  } catch (const Error&) {
    return std::nullopt;
  }

  // (S'S + d |S|^2) step = S' off, of the joints that may move.
  [[nodiscard]] Eigen::VectorXd move(const There& there, double damping) const {
    Eigen::MatrixXd slope = there.slope;
    const Eigen::VectorXd downhill = there.slope.transpose() * there.off;
    for (Eigen::Index i = 0; i < size(); ++i) {
      const std::optional<JointRange>& range = joint(i).range;
      const bool at_end = range && ((there.position(i) <= range->least && downhill(i) > 0.0) ||
                                    (there.position(i) >= range->greatest && downhill(i) < 0.0));
      if (at_end) slope.col(i).setZero();
    }
    Eigen::MatrixXd normal = slope.transpose() * slope;
    const double size_of_slope = normal.diagonal().maxCoeff();
    normal.diagonal().array() += damping * (size_of_slope > 0.0 ? size_of_slope : 1.0);
    return solve_symmetric(normal, slope.transpose() * there.off);
  }

  const MechanismModel& model_;
  const std::vector<std::size_t>& joints_;
  Eigen::Vector3d point_;
};

}  // namespace

bool is_within_ranges(const std::vector<MechanismJoint>& joints, const Eigen::VectorXd& positions) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::optional<JointRange>& range = joints[i].range;
    const double position = positions(static_cast<Eigen::Index>(i));
    if (range && (position < range->least - past_range || position > range->greatest + past_range)) return false;
  }
  return true;
}

MechanismModel::Reached reached_by(const MechanismModel& model, const std::vector<std::size_t>& joints,
                                   const Eigen::Vector3d& point) {
  const Reach reach(model, joints, point);
  const Eigen::VectorXd start = reach.file_pose();
  MechanismModel::Reached closest{.pose = reach.pose_of(start), .short_of = std::numeric_limits<double>::infinity()};
  constexpr std::size_t starts = 1 + 2 * std::size(shifts);
  for (std::size_t i = 0; i < starts && !closest.reached; ++i) {
    const std::optional<There> found = reach.from(i == 0 ? start : reach.shifted(start, i - 1));
    if (!found) continue;
    const double off = found->off.norm();
    const bool is_reached = found->in_range && off <= reached_to;
    if (is_reached || off < closest.short_of) closest = {reach.pose_of(found->position), off, is_reached};
  }
  return closest;
}

}  // namespace zwidth::internal

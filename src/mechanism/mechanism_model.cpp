#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mechanism/mechanism_text.hpp"
#include "mechanism/mujoco_file.hpp"
#include "mechanism/singular_pose.hpp"
#include "mechanism/tip_reach.hpp"
#include "mechanism/transmissions.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
namespace {

constexpr double share_of_next = 0.618;                      // of the way of one joint, of the next one's
constexpr double steps_around[] = {0.01, -0.01, 0.1, -0.1};  // rad or m, from the file's pose

JointPositions with(JointPositions pose, const JointPositions& given) {
  for (const auto& [joint, position] : given) pose[joint] = position;
  return pose;
}

// The numbers of joints whose motions are independent of each other where no cable is stretched, in the order given.
std::vector<std::size_t> independent(const MechanismAtPose& at, const std::vector<std::size_t>& in_order) {
  std::vector<std::size_t> found;
  Eigen::MatrixXd rows = at.cables;
  for (const std::size_t joint : in_order) {
    Eigen::MatrixXd more(rows.rows() + 1, at.mass.cols());
    more << rows, at.joint_motions.row(static_cast<Eigen::Index>(joint));
    if (more.bottomRows(1).isZero(0.0) || internal::rank_of(more) < more.rows()) continue;
    rows = std::move(more);
    found.push_back(joint);
  }
  return found;
}

}  // namespace

class MechanismModel::Read {
 public:
  explicit Read(const MechanismFile& file)
      : of_(file),
        mujoco_(internal::open_mujoco_file(file)),
        joints_(mujoco_->joints()),
        at_file_pose_(linearised(file.pose)) {
    std::vector<std::size_t> in_order;
    for (const int kind : {0, 1, 2, 3}) {
      for (std::size_t i = 0; i < joints_.size(); ++i) {
        if (order_of(i) == kind) in_order.push_back(i);
      }
    }
    pose_joints_ = independent(at_file_pose_, in_order);
    std::ranges::sort(pose_joints_);
    for (const std::size_t each : pose_joints_) joints_[each].is_of_pose = true;
    find_directions_around();
    at_file_pose_ = with_tips_beside(std::move(at_file_pose_), of_.pose);
  }

  // At that pose, with what is known of it beside where it is singular.
  [[nodiscard]] MechanismAtPose at(const JointPositions& pose) const {
    return with_tips_beside(linearised(pose), pose);
  }

  [[nodiscard]] MechanismAtPose linearised(const JointPositions& pose) const {
    auto [at, of_joints] = mujoco_->at(pose);
    for (std::size_t i = 0; i < of_.transmissions.size(); ++i) {
      const Transmission& each = of_.transmissions[i];
      const int joint = mujoco_->joint(fmt::format("transmission.{}.joint", i), each.joint);
      internal::add_transmission(at, joint, each, of_.encoders.empty());
    }
    if (at.motors.rows() == 0) refuse_key(internal::source_key(of_), {.code = ProblemCode::no_motor});
    if (of_joints.cols() == of_joints.rows()) return internal::without_springs(std::move(at));  // no loops
    const Eigen::Index motors = at.mass.rows() - of_joints.rows();
    Eigen::MatrixXd free = Eigen::MatrixXd::Zero(at.mass.rows(), of_joints.cols() + motors);
    free.topLeftCorner(of_joints.rows(), of_joints.cols()) = of_joints;
    free.bottomRightCorner(motors, motors).setIdentity();
    return internal::without_springs(internal::with_loops(at, free));
  }

  [[nodiscard]] const MechanismFile& file() const { return of_; }
  [[nodiscard]] const internal::MujocoFile& mujoco() const { return *mujoco_; }
  [[nodiscard]] const std::vector<MechanismJoint>& joints() const { return joints_; }
  [[nodiscard]] const std::vector<std::size_t>& pose_joints() const { return pose_joints_; }
  [[nodiscard]] const MechanismAtPose& at_file_pose() const { return at_file_pose_; }

 private:
  // The pose with joints that give it moved by so many times a step, one number a joint; nothing where it is not reached.
  [[nodiscard]] std::optional<MechanismAtPose> moved_by(const MechanismAtPose& from, JointPositions pose,
                                                        const Eigen::VectorXd& shares, double step) const {
    for (std::size_t i = 0; i < pose_joints_.size(); ++i) {
      const std::size_t joint = pose_joints_[i];
      pose[joints_[joint].name] =
          from.joints(static_cast<Eigen::Index>(joint)) + step * shares(static_cast<Eigen::Index>(i));
    }
    try {
      return linearised(pose);
    } catch (const Error&) {
      return std::nullopt;  // loops do not close there
    }
  }

  // Ways that no relation of the joints' is likely to keep: each its own share.
  [[nodiscard]] Eigen::VectorXd all_joints() const {
    const auto count = static_cast<Eigen::Index>(pose_joints_.size());
    return Eigen::VectorXd::NullaryExpr(count,
                                        [](Eigen::Index i) { return std::pow(share_of_next, static_cast<double>(i)); });
  }

  void find_directions_around() {
    directions_around_ = tip_directions(at_file_pose_.tip).cols();
    for (const double step : steps_around) {
      const std::optional<MechanismAtPose> beside = moved_by(at_file_pose_, of_.pose, all_joints(), step);
      if (beside) directions_around_ = std::max(directions_around_, tip_directions(beside->tip).cols());
    }
  }

  [[nodiscard]] MechanismAtPose with_tips_beside(MechanismAtPose at, const JointPositions& pose) const {
    const Eigen::MatrixXd directions = tip_directions(at.tip);
    if (directions.cols() == directions_around_ || directions.cols() == 0) return at;
    const auto count = static_cast<Eigen::Index>(pose_joints_.size());
    for (Eigen::Index i = 0; i <= count; ++i) {
      const Eigen::VectorXd shares = i < count ? Eigen::VectorXd(Eigen::VectorXd::Unit(count, i)) : all_joints();
      const auto before = moved_by(at, pose, shares, -internal::step_beside);
      const auto after = moved_by(at, pose, shares, internal::step_beside);
      if (!before || !after) continue;
      internal::add_tip_beside(at, *before, *after);
    }
    return at;
  }

  // Which joints are asked first whether they give the pose.
  [[nodiscard]] int order_of(std::size_t joint) const {
    if (of_.pose.contains(joints_[joint].name)) return 0;
    if (!joints_[joint].is_driven) return 2;
    const Eigen::MatrixXd along = at_file_pose_.cables * at_file_pose_.joint_motions.transpose();
    return along.col(static_cast<Eigen::Index>(joint)).isZero(0.0) ? 1 : 3;
  }

  MechanismFile of_;
  std::shared_ptr<const internal::MujocoFile> mujoco_;
  std::vector<MechanismJoint> joints_;
  MechanismAtPose at_file_pose_;
  std::vector<std::size_t> pose_joints_;
  Eigen::Index directions_around_ = 0;  // along which the tip moves around the file's pose
};

MechanismModel::MechanismModel(const MechanismFile& file) : read_(std::make_shared<const Read>(file)) {}

const std::vector<MechanismJoint>& MechanismModel::joints() const { return read_->joints(); }

std::vector<std::string> MechanismModel::pose_joints() const {
  std::vector<std::string> names;
  for (const std::size_t each : read_->pose_joints()) names.push_back(joints()[each].name);
  return names;
}

const MechanismFile& MechanismModel::file() const { return read_->file(); }

const std::map<std::string, MechanismNumber>& MechanismModel::file_numbers() const { return read_->mujoco().numbers(); }

std::string MechanismModel::text() const { return read_->mujoco().text(); }

MechanismAtPose MechanismModel::at(const JointPositions& pose) const {
  if (pose.empty()) return read_->at_file_pose();
  return read_->at(with(file().pose, pose));
}

MechanismModel::Reached MechanismModel::reach(const Eigen::Vector3d& point) const {
  if (!point.allFinite()) refuse_key("mechanism.tip", {.code = ProblemCode::not_finite});
  return internal::reached_by(*this, read_->pose_joints(), point);
}

MechanismAtPose at_pose(const MechanismFile& file) { return MechanismModel(file).at(); }

}  // namespace zwidth

#include "results/workspace_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "results/csv.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"
#include "zwidth/words/problem_text.hpp"

namespace zwidth::results {
namespace {

Json vector_json(const Eigen::Vector3d& vector) { return Json::array({vector.x(), vector.y(), vector.z()}); }

/// Of a pose that is reached.
Json tip_json(const WorkspacePose& pose) { return pose.joints.empty() ? Json(nullptr) : vector_json(pose.tip); }

std::optional<double> oscillates_at(double frequency) {
  return frequency > 0.0 ? std::optional(frequency) : std::nullopt;
}

Json joints_json(const Workspace& workspace) {
  const std::vector<Motion> motions = pose_motions(workspace);
  Json list = Json::array();
  for (std::size_t j = 0; j < motions.size(); ++j) {
    list.push_back({{"name", workspace.pose_joints[j]}, {"unit", unit_of(Measure::position, motions[j])}});
  }
  return list;
}

/// A limit at a pose whose numbers stand beside it.
Json limit_json(double value, const Eigen::Vector3d& normal, double frequency) {
  const std::optional<double> at = oscillates_at(frequency);
  return {{"value", value}, {"normal", vector_json(normal)}, {"frequency_rad_s", at}, {"frequency_hz", hertz(at)}};
}

Json nobody_json(const std::optional<DirectionLimits>& limits) {
  return limits ? limit_json(limits->nobody, limits->normal, limits->nobody_frequency) : Json(nullptr);
}

Json any_user_json(const std::optional<DirectionLimits>& limits) {
  if (!limits || !limits->any_user) return nullptr;
  return limit_json(*limits->any_user, limits->normal, limits->any_user_frequency);
}

Json least_json(const Workspace& workspace, const std::optional<WorkspaceLimit>& least) {
  if (!least) return nullptr;
  const WorkspacePose& pose = workspace.poses[least->pose];
  const std::optional<double> at = oscillates_at(least->frequency);
  return {{"value", least->stiffness},      {"pose", pose_positions(workspace, pose)},
          {"tip", tip_json(pose)},          {"normal", vector_json(least->normal)},
          {"frequency_rad_s", at},          {"frequency_hz", hertz(at)},
          {"limited_by", least->limited_by}};
}

Json workspace_quantiles_json(const std::vector<WorkspaceQuantile>& quantiles) {
  Json list = Json::array();
  for (const WorkspaceQuantile& each : quantiles) {
    list.push_back({{"probability", each.probability}, {"nobody", each.nobody}, {"any_user", each.any_user}});
  }
  return list;
}

Json share_json(const std::optional<WorkspaceShare>& share) {
  if (!share) return nullptr;
  return {{"stiffness", share->stiffness}, {"nobody", share->nobody}, {"any_user", share->any_user}};
}

Json problem_json(const std::optional<Problem>& problem) {
  if (!problem) return nullptr;
  const ProblemWords words = words_of(*problem);
  return {{"code", name_of(problem->code)}, {"what", words.what}, {"allowed", words.allowed}};
}

Json refused_directions_json(const WorkspacePose& pose) {
  Json list = Json::array();
  for (const RefusedDirection& each : pose.refused) {
    list.push_back({{"normal", vector_json(each.normal)}, {"problem", problem_json(each.problem)}});
  }
  return list;
}

Json directions_json(const WorkspacePose& pose) {
  Json list = Json::array();
  for (const DirectionLimits& each : pose.directions) {
    list.push_back({{"normal", vector_json(each.normal)},
                    {"status", each.status},
                    {"nobody", each.nobody},
                    {"any_user", each.any_user}});
  }
  return list;
}

Json pose_json(const Workspace& workspace, const WorkspacePose& pose, DirectionsInJson directions) {
  Json json = {{"pose", pose_positions(workspace, pose)},
               {"tip", tip_json(pose)},
               {"point", pose.point},
               {"problem", problem_json(pose.problem)},
               {"least", nobody_json(pose.least)},
               {"greatest", nobody_json(pose.greatest)},
               {"least_any_user", any_user_json(pose.least_any_user)},
               {"refused_directions", refused_directions_json(pose)}};
  if (directions == DirectionsInJson::included) json["directions"] = directions_json(pose);
  return json;
}

Json unreached_json(const std::vector<UnreachedPoint>& unreached) {
  Json list = Json::array();
  for (const UnreachedPoint& each : unreached) {
    list.push_back({{"point", each.point}, {"at", vector_json(each.at)}, {"short_of", each.short_of}});
  }
  return list;
}

void add_vector(Csv& csv, const std::optional<Eigen::Vector3d>& vector) {
  for (Eigen::Index i = 0; i < 3; ++i) csv.cell(vector ? std::optional((*vector)(i)) : std::nullopt);
}

/// The rows of one pose.
class WorkspaceRows {
 public:
  WorkspaceRows(Csv& csv, const Workspace& workspace, std::size_t index)
      : csv_(csv),
        pose_(workspace.poses[index]),
        trust_(workspace.trust),
        number_(index + 1),
        positions_(pose_positions(workspace, pose_)) {}

  void add(const DirectionLimits& limits) {
    begin();
    add_vector(csv_, limits.normal);
    csv_.row(name_of(limits.status), limits.nobody, oscillates_at(limits.nobody_frequency), limits.any_user,
             oscillates_at(limits.any_user_frequency), "", trust_);
  }
  void add(const std::optional<Eigen::Vector3d>& normal, std::string_view problem) {
    begin();
    end_without_limit(csv_, normal, problem, trust_);
  }

  static void end_without_limit(Csv& csv, const std::optional<Eigen::Vector3d>& normal, std::string_view problem,
                                const Trust& trust) {
    add_vector(csv, normal);
    csv.row(name_of(StiffnessStatus::refused), "", "", "", "", problem, trust);
  }

 private:
  void begin() {
    csv_.cell(number_);
    for (const double position : positions_) csv_.cell(position);
    add_vector(csv_, pose_.joints.empty() ? std::nullopt : std::optional(pose_.tip));
  }

  Csv& csv_;
  const WorkspacePose& pose_;
  const Trust& trust_;
  std::size_t number_;
  std::vector<double> positions_;
};

}  // namespace

std::vector<double> pose_positions(const Workspace& workspace, const WorkspacePose& pose) {
  std::vector<double> positions;
  for (const std::string& name : workspace.pose_joints) {
    const auto given = pose.pose.find(name);
    const auto joint = std::ranges::find(workspace.joints, name, &MechanismJoint::name);
    const auto index = static_cast<std::size_t>(joint - workspace.joints.begin());
    positions.push_back(given != pose.pose.end()     ? given->second
                        : index < pose.joints.size() ? pose.joints[index]
                                                     : std::numeric_limits<double>::quiet_NaN());
  }
  return positions;
}

std::vector<Motion> pose_motions(const Workspace& workspace) {
  std::vector<Motion> motions;
  for (const std::string& name : workspace.pose_joints) {
    const auto joint = std::ranges::find(workspace.joints, name, &MechanismJoint::name);
    motions.push_back(joint == workspace.joints.end() ? Motion::rotary : joint->motion);
  }
  return motions;
}

Json workspace_json(const Device& device, const Workspace& workspace, DirectionsInJson directions) {
  Json json = document("zwidth.workspace/1");
  json["device"] = device.name();
  json["units"] = {{"stiffness", unit_of(Measure::stiffness, Motion::linear)},
                   {"length", unit_of(Measure::position, Motion::linear)}};
  json["joints"] = joints_json(workspace);
  json["tip_directions"] = workspace.tip_directions;
  json["least"] = least_json(workspace, workspace.least);
  json["least_any_user"] = least_json(workspace, workspace.least_any_user);
  json["quantiles"] = workspace_quantiles_json(workspace.quantiles);
  json["share_at_least"] = share_json(workspace.share_at_least);
  json["directions"] = workspace.directions;
  json["refused_directions"] = workspace.refused_directions;
  json["refused_poses"] = workspace.refused_poses;
  Json poses = Json::array();
  for (const WorkspacePose& each : workspace.poses) poses.push_back(pose_json(workspace, each, directions));
  json["poses"] = std::move(poses);
  json["unreached"] = unreached_json(workspace.unreached);
  add_findings(json, workspace);
  return json;
}

std::string workspace_csv(const Workspace& workspace) {
  Csv csv;
  csv.cell("pose");
  const std::vector<Motion> motions = pose_motions(workspace);
  for (std::size_t j = 0; j < motions.size(); ++j) {
    csv.cell(fmt::format("{} ({})", workspace.pose_joints[j], unit_of(Measure::position, motions[j])));
  }
  for (const char* name :
       {"tip_x_m", "tip_y_m", "tip_z_m", "normal_x", "normal_y", "normal_z", "status", "critical_stiffness",
        "frequency_rad_s", "any_user_critical_stiffness", "any_user_frequency_rad_s", "problem", "trust"}) {
    csv.cell(name);
  }
  csv.end_row();
  for (std::size_t i = 0; i < workspace.poses.size(); ++i) {
    WorkspaceRows rows(csv, workspace, i);
    const WorkspacePose& pose = workspace.poses[i];
    for (const DirectionLimits& each : pose.directions) rows.add(each);
    for (const RefusedDirection& each : pose.refused) rows.add(each.normal, name_of(each.problem.code));
    if (pose.problem) rows.add(std::nullopt, name_of(pose.problem->code));
  }
  for (const UnreachedPoint& each : workspace.unreached) {
    csv.cell("");
    for (std::size_t j = 0; j < motions.size(); ++j) csv.cell("");
    add_vector(csv, each.at);
    WorkspaceRows::end_without_limit(csv, std::nullopt, "not_reached", workspace.trust);
  }
  return csv.text();
}

}  // namespace zwidth::results

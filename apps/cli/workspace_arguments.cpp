#include "cli/workspace_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "cli/number_text.hpp"
#include "cli/option_units.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::cli {
namespace {

constexpr const char* poses_option = "--poses";
constexpr const char* points_option = "--points";
constexpr const char* normals_option = "--normals";

constexpr const char* pose_form =
    "write JOINT=FIRST:LAST:COUNT or JOINT=VALUE, for instance \"shoulder=0:90:19 deg,elbow=30 deg\"";
constexpr const char* point_form = "write X,Y,Z, for instance \"0.3,0.1,0\" or \"300,100,0 mm\"";
constexpr const char* normal_form =
    "write NX,NY,NZ, for instance \"1,0,0;0,1,0\", or a whole number of directions, for instance 24";

constexpr const char* list_form =
    "write one value for each joint of a list, for instance \"shoulder=0,elbow=30 deg;shoulder=1,elbow=2\"";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const std::size_t begin = std::min(text.find_first_not_of(blanks), text.size());
  return text.substr(begin, text.find_last_not_of(blanks) + 1 - begin);
}

[[noreturn]] void refuse_text(const char* option, std::string_view text, const std::string& why, const char* form) {
  throw BadInput(option, CommandText(fmt::format("{} {}", in_quotes(text), why)), CommandText(std::string(form)));
}

/// A position, and of which motion its unit is; none where it has none.
struct JointPosition {
  double value = 0.0;
  std::optional<Motion> unit = {};
};

/// Of hinges and of slides: which of them the joint is, the mechanism says.
JointPosition joint_position(std::string_view text) {
  if (const auto plain = number_in(text)) return {.value = *plain};
  const auto angle = measured_number(text, Measure::position, Motion::rotary);
  if (angle) return {*angle, Motion::rotary};
  const auto length = measured_number(text, Measure::position, Motion::linear);
  if (length) return {*length, Motion::linear};
  InputProblem problem = problem_of_value(poses_option, angle.error());
  problem.allowed = "must be a number of rad or m, or one with its unit such as \"30 deg\" or \"20 mm\"";
  throw BadInput(std::move(problem));
}

PoseAxis pose_axis(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos) refuse_text(poses_option, text, "has no JOINT=", pose_form);
  PoseAxis axis{.joint = std::string(trimmed(text.substr(0, equals)))};
  if (axis.joint.empty()) refuse_text(poses_option, text, "names no joint", pose_form);
  std::vector<std::string> parts = parts_of(text.substr(equals + 1), ':');
  for (std::string& part : parts) part = trimmed(part);
  if (parts.size() != 1 && parts.size() != 3) {
    refuse_text(poses_option, text, fmt::format("has {} numbers after JOINT=", parts.size()), pose_form);
  }
  if (parts.size() == 3) {
    const std::string& last = parts[2];
    const auto [end, error] = std::from_chars(last.data(), last.data() + last.size(), axis.count);
    const std::string unit(trimmed(std::string_view(last).substr(static_cast<std::size_t>(end - last.data()))));
    if (error != std::errc{} || (!unit.empty() && number_in(unit.substr(0, 1))) || unit.starts_with('.')) {
      refuse_text(poses_option, text, fmt::format("has the COUNT {}, no whole number", in_quotes(last)), pose_form);
    }
    if (!unit.empty()) {
      for (std::string& each : {std::ref(parts[0]), std::ref(parts[1])}) each += " " + unit;
    }
  }
  const JointPosition first = joint_position(parts[0]);
  const JointPosition end = parts.size() == 3 ? joint_position(parts[1]) : first;
  if (first.unit != end.unit) refuse_text(poses_option, text, "has ends of two units", pose_form);
  axis.first = first.value;
  axis.last = end.value;
  axis.unit = first.unit;
  return axis;
}

/// One of a list: a value for each joint, and of which motion their units are.
JointPositions listed_pose(std::string_view text, std::map<std::string, Motion>& units) {
  JointPositions pose;
  for (const std::string& part : parts_of(text, ',')) {
    const PoseAxis axis = pose_axis(trimmed(part));
    if (axis.count != 1 || axis.first != axis.last) refuse_text(poses_option, text, "is a grid in a list", list_form);
    if (!pose.emplace(axis.joint, axis.first).second) {
      refuse_text(poses_option, text, "has a joint twice", list_form);
    }
    if (axis.unit && units.emplace(axis.joint, *axis.unit).first->second != *axis.unit) {
      refuse_text(poses_option, text, "has a joint that turns in one pose and slides in another", list_form);
    }
  }
  return pose;
}

/// Texts that a semicolon parts, of all that were given.
std::vector<std::string> items_of(const std::vector<std::string>& given) {
  std::vector<std::string> items;
  for (const std::string& each : given) {
    for (const std::string& item : parts_of(each, ';')) items.emplace_back(trimmed(item));
  }
  return items;
}

std::array<std::string, 3> three_parts(const char* option, std::string_view text, const char* form) {
  const std::vector<std::string> parts = parts_of(text, ',');
  if (parts.size() != 3) {
    refuse_text(option, text, fmt::format("has {} number{}", parts.size(), parts.size() == 1 ? "" : "s"), form);
  }
  std::array<std::string, 3> three;
  std::ranges::transform(parts, three.begin(), [](const std::string& part) { return std::string(trimmed(part)); });
  return three;
}

Eigen::Vector3d point_of(std::string_view text) {
  std::array<std::string, 3> parts = three_parts(points_option, text, point_form);
  const std::size_t number_end = parts[2].find_first_not_of("0123456789.+-eE");
  if (number_end != std::string::npos && number_in(parts[0]) && number_in(parts[1])) {
    for (std::string& each : {std::ref(parts[0]), std::ref(parts[1])}) each += parts[2].substr(number_end);
  }
  Eigen::Vector3d point;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    auto length = measured_number(parts[i], Measure::position, Motion::linear);
    if (!length) {
      length.error().what = fmt::format("{}: {}", in_quotes(text), length.error().what);
      throw BadInput(problem_of_value(points_option, length.error()));
    }
    point(static_cast<Eigen::Index>(i)) = *length;
  }
  return point;
}

Eigen::Vector3d normal_of(std::string_view text) {
  const std::array<std::string, 3> parts = three_parts(normals_option, text, normal_form);
  Eigen::Vector3d normal;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto number = number_in(parts[i]);
    if (!number) {
      refuse_text(normals_option, text, fmt::format("has {}, no number", in_quotes(parts[i])), normal_form);
    }
    normal(static_cast<Eigen::Index>(i)) = *number;
  }
  return normal;
}

/// A number of directions; nothing where the text is none.
std::optional<std::size_t> count_in(std::string_view text) {
  const std::optional<double> number = number_in(text);
  if (!number) return std::nullopt;
  constexpr double largest = 9e15;
  if (std::trunc(*number) != *number || *number < 1.0 || *number > largest) {
    refuse_text(normals_option, text, "is no number of directions", normal_form);
  }
  return static_cast<std::size_t>(*number);
}

}  // namespace

void apply(const WorkspaceOptionTexts& texts, WorkspaceOptions& options) {
  for (const std::string& each : texts.poses) {
    if (each.find(';') != std::string::npos) {
      for (const std::string& pose : parts_of(each, ';')) {
        if (!trimmed(pose).empty()) options.poses.push_back(listed_pose(pose, options.units_of_poses));
      }
      continue;
    }
    for (const std::string& part : parts_of(each, ',')) options.grid.push_back(pose_axis(trimmed(part)));
  }
  for (const std::string& each : items_of(texts.points)) options.points.push_back(point_of(each));
  const std::vector<std::string> normals = items_of(texts.normals);
  if (normals.size() == 1) {
    if (const auto count = count_in(normals.front())) {
      options.directions = *count;
      return;
    }
  }
  for (const std::string& each : normals) options.normals.push_back(normal_of(each));
}

}  // namespace zwidth::cli

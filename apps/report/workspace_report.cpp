#include "report/workspace_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <optional>
#include <string_view>
#include <vector>

#include "report/document.hpp"
#include "report/figure/figures.hpp"
#include "report/page/html_page.hpp"
#include "report/text/explanation.hpp"
#include "report/text/markup.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "report/worst_device.hpp"
#include "results/workspace_json.hpp"
#include "zwidth/stability/holding.hpp"
#include "zwidth/words/problem_text.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t most_poses_shown = 8;
constexpr std::size_t most_poses_on_page = 25;
constexpr std::string_view tip_stiffness_unit = "N/m";

/// "(0.985, 0.174, 0)"
std::string vector_text(const Eigen::Vector3d& vector) {
  constexpr double steps = 1e3;  // a normal to 0.1 deg, a tip to 1 mm
  const auto rounded = [&](Eigen::Index i) { return std::round(vector(i) * steps) / steps + 0.0; };
  return fmt::format("({:g}, {:g}, {:g})", rounded(0), rounded(1), rounded(2));
}

std::string joint_text(double position, Motion motion) {
  if (std::isnan(position)) return "?";
  return motion == Motion::rotary ? fmt::format("{:.4g} deg", position * 180.0 / std::numbers::pi + 0.0)
                                  : quantity(position, "m");
}

class WorkspaceWriter {
 public:
  WorkspaceWriter(const Device& device, const Workspace& workspace)
      : device_(device), workspace_(workspace), motions_(results::pose_motions(workspace)) {}

  [[nodiscard]] std::string text(ShownFindings shown) const {
    const FindingsText findings = findings_text(workspace_.trust, workspace_.remarks, shown);
    std::string text = shortened(display_name(device_), line_width) + "\n" + wrap(extent(), line_width, 2);
    if (!findings.against.empty()) text += findings.against;
    if (!workspace_.least) return text + problem_lines() + findings.remarks;
    text += holder(Holder::nobody, *workspace_.least);
    if (workspace_.least_any_user) text += holder(Holder::any_user, *workspace_.least_any_user);
    text += "\nOver all poses and directions tried\n" + layout(quantile_table());
    if (workspace_.share_at_least) text += "\n" + wrap(share_sentence(*workspace_.share_at_least), line_width, 0);
    text += "\nPoses with the least limits\n" + layout(pose_table(worst_poses(most_poses_shown)));
    if (const std::string shown_poses = shown_of_all(most_poses_shown); !shown_poses.empty()) {
      text += fmt::format("  {}; --csv FILE or --json gives all\n", shown_poses);
    }
    return text + problem_lines() + findings.remarks;
  }

  [[nodiscard]] std::string page() const {
    Document document(Medium::page);
    document.verbatim(answer_element(workspace_.trust.verdict, answer()));
    if (workspace_.least) {
      document.figure("map", "The least limit at every place of the tip.",
                      [&] { return draw_workspace(device_, workspace_, FigureFormat::svg); });
      document.part("Over all poses and directions tried");
      document.table(quantile_table());
      if (workspace_.share_at_least) document.paragraph(share_sentence(*workspace_.share_at_least));
      document.part("Poses with the least limits");
      document.table(pose_table(worst_poses(most_poses_on_page)));
      document.paragraph(shown_of_all(most_poses_on_page));
    }
    document.part("Where no limit is known");
    document.list(problems());
    document.part("Remarks");
    std::vector<std::string> remarks;
    for (const Remark& each : workspace_.remarks) remarks.push_back(remark_line(each));
    document.list(remarks);
    return std::move(document).str();
  }

 private:
  [[nodiscard]] bool has_any_user() const { return workspace_.least_any_user.has_value(); }

  [[nodiscard]] std::string extent() const {
    const std::size_t poses = workspace_.poses.size();
    return fmt::format("{} pose{} and {} directions in all, {}", poses, poses == 1 ? "" : "s", workspace_.directions,
                       workspace_.trust.sound() ? "sound" : "see below");
  }

  [[nodiscard]] std::string pose_text(const WorkspacePose& pose) const {
    const std::vector<double> positions = results::pose_positions(workspace_, pose);
    std::vector<std::string> parts;
    for (std::size_t j = 0; j < positions.size(); ++j) {
      parts.push_back(fmt::format("{} {}", workspace_.pose_joints[j], joint_text(positions[j], motions_[j])));
    }
    return fmt::format("{}", fmt::join(parts, ", "));
  }

  [[nodiscard]] std::string limit_text(Holder who, const WorkspaceLimit& limit) const {
    if (std::isinf(limit.stiffness)) return "unbounded: every wall is stable";
    if (limit.stiffness == 0.0) return "none: every wall is unstable";
    std::string text = fmt::format("least {}", quantity(limit.stiffness, tip_stiffness_unit));
    if (who == Holder::any_user && !limit.limited_by) {
      if (limit.frequency > 0.0) text += fmt::format(", worst at {}", quantity(hertz(limit.frequency), "Hz"));
    } else if (limit.limited_by) {
      text += fmt::format(
          ", then {}: {}",
          limit.frequency > 0.0 ? fmt::format("shakes at {}", quantity(hertz(limit.frequency), "Hz")) : "drifts away",
          what_turns_unstable(device_, long_name(*limit.limited_by), limit.frequency));
    }
    return text;
  }

  /// "normal (1, 0, 0), tip (0.3, 0.2, 0) m"
  [[nodiscard]] std::string direction_text(const WorkspaceLimit& limit) const {
    return fmt::format("normal {}, tip {} m", vector_text(limit.normal), vector_text(workspace_.poses[limit.pose].tip));
  }

  [[nodiscard]] std::string place_text(const WorkspaceLimit& limit) const {
    return fmt::format("{}; {}", pose_text(workspace_.poses[limit.pose]), direction_text(limit));
  }

  [[nodiscard]] std::string holder(Holder who, const WorkspaceLimit& limit) const {
    return labelled(fmt::format("  {}", words_of(who)), limit_text(who, limit)) +
           labelled("", "at " + pose_text(workspace_.poses[limit.pose])) + labelled("", direction_text(limit));
  }

  [[nodiscard]] TextTable quantile_table() const {
    TextTable table{{Align::right, Align::right}, {{"share below", std::string(words_of(Holder::nobody))}}};
    if (has_any_user()) {
      table.alignment.push_back(Align::right);
      table.rows[0].emplace_back(words_of(Holder::any_user));
    }
    for (const WorkspaceQuantile& each : workspace_.quantiles) {
      const bool is_end = each.probability == 0.0 || each.probability == 1.0;
      table.rows.push_back({!is_end                   ? fmt::format("{:g} %", 100.0 * each.probability)
                            : each.probability == 0.0 ? std::string("least")
                                                      : std::string("greatest"),
                            limit_value_text(each.nobody, tip_stiffness_unit)});
      if (has_any_user()) {
        table.rows.back().push_back(each.any_user ? limit_value_text(*each.any_user, tip_stiffness_unit) : "?");
      }
    }
    return table;
  }

  [[nodiscard]] static std::string share_sentence(const WorkspaceShare& share) {
    std::string text =
        fmt::format("A wall of {} is stable in {} of them with {}", quantity(share.stiffness, tip_stiffness_unit),
                    share_of_all_text(share.nobody), words_of(Holder::nobody));
    if (share.any_user)
      text += fmt::format(", in {} with {}", share_of_all_text(*share.any_user), words_of(Holder::any_user));
    return text + ".";
  }

  /// Of any passive user where that is known of some pose: what is not known may be the least.
  [[nodiscard]] double worst_of(const WorkspacePose& pose) const {
    if (!has_any_user()) return pose.least->nobody;
    return pose.least_any_user ? pose.least_any_user->any_user.value_or(0.0) : 0.0;
  }

  [[nodiscard]] std::vector<const WorkspacePose*> worst_poses(std::size_t most) const {
    std::vector<const WorkspacePose*> poses;
    for (const WorkspacePose& each : workspace_.poses) {
      if (each.least) poses.push_back(&each);
    }
    const auto end = poses.begin() + static_cast<std::ptrdiff_t>(std::min(poses.size(), most));
    std::partial_sort(poses.begin(), end, poses.end(), [this](const WorkspacePose* one, const WorkspacePose* other) {
      const double a = worst_of(*one);
      const double b = worst_of(*other);
      return a != b ? a < b : one < other;
    });
    poses.erase(end, poses.end());
    return poses;
  }

  /// "8 of 14 poses"; empty where all are shown.
  [[nodiscard]] std::string shown_of_all(std::size_t most) const {
    const auto all = static_cast<std::size_t>(
        std::ranges::count_if(workspace_.poses, [](const WorkspacePose& pose) { return pose.least.has_value(); }));
    return most < all ? fmt::format("{} of {} poses", most, all) : std::string();
  }

  [[nodiscard]] TextTable pose_table(const std::vector<const WorkspacePose*>& poses) const {
    TextTable table;
    std::vector<std::string> heads = workspace_.pose_joints;
    heads.insert(heads.end(), {"tip (m)", "nobody: least", "greatest"});
    if (has_any_user()) heads.emplace_back("any user: least");
    heads.emplace_back("along");
    for (const std::string& head : heads) {
      const bool is_text = head == "along" || head == "tip (m)";
      table.alignment.push_back(is_text ? Align::left : Align::right);
    }
    table.rows.push_back(heads);
    for (const WorkspacePose* each : poses) table.rows.push_back(pose_row(*each));
    return table;
  }

  /// Of each kind the first, and how often there is one.
  [[nodiscard]] std::vector<std::string> problems() const {
    struct Met {
      const Problem* problem;
      std::size_t count;
    };
    std::vector<Met> all;
    const auto add = [&all](const Problem& problem) {
      const auto known = std::ranges::find_if(all, [&](const Met& each) { return each.problem->code == problem.code; });
      known == all.end() ? all.push_back({&problem, 1}) : void(++known->count);
    };
    for (const WorkspacePose& pose : workspace_.poses) {
      for (const RefusedDirection& each : pose.refused) add(each.problem);
      if (pose.problem && pose.refused.empty()) add(*pose.problem);
    }
    std::vector<std::string> items;
    for (const Met& each : all) {
      const ProblemWords words = words_of(*each.problem);
      const std::string alike = each.count > 1 ? fmt::format(" ({} alike)", each.count) : "";
      items.push_back(fmt::format("{}{}{}{}", words.what, words.allowed.empty() ? "" : "; ", words.allowed, alike));
    }
    return items;
  }

  [[nodiscard]] std::string problem_lines() const {
    std::string text;
    for (const std::string& each : problems()) text += bulleted(each);
    return text.empty() ? text : "\nWhere no limit is known\n" + text;
  }

  /// The first lines of a page.
  [[nodiscard]] std::string answer() const {
    const auto trust = trust_note(workspace_.trust);
    std::string text = (trust ? element("p", *trust) : "") + element("p", extent());
    const std::optional<WorkspaceLimit>& worst = has_any_user() ? workspace_.least_any_user : workspace_.least;
    if (!worst) return text;
    const Holder who = has_any_user() ? Holder::any_user : Holder::nobody;
    text += element("p", fmt::format("Least limit of all, {}", words_of(who)));
    text += fmt::format("<p class=\"value\">{}</p>\n",
                        escape_markup(limit_value_text(worst->stiffness, tip_stiffness_unit)));
    TextTable table{{Align::left, Align::left, Align::left}, {{"who holds", "limit", "where"}}};
    const auto add = [&](Holder holder, const std::optional<WorkspaceLimit>& limit) {
      if (limit) table.rows.push_back({std::string(words_of(holder)), limit_text(holder, *limit), place_text(*limit)});
    };
    add(Holder::nobody, workspace_.least);
    add(Holder::any_user, workspace_.least_any_user);
    return text + html_table(table);
  }

  [[nodiscard]] std::vector<std::string> pose_row(const WorkspacePose& pose) const {
    std::vector<std::string> row;
    const std::vector<double> positions = results::pose_positions(workspace_, pose);
    for (std::size_t j = 0; j < positions.size(); ++j) row.push_back(joint_text(positions[j], motions_[j]));
    row.push_back(vector_text(pose.tip));
    row.push_back(limit_value_text(pose.least->nobody, tip_stiffness_unit));
    row.push_back(pose.greatest ? limit_value_text(pose.greatest->nobody, tip_stiffness_unit) : "?");
    const std::optional<DirectionLimits>& worst = has_any_user() ? pose.least_any_user : pose.least;
    if (has_any_user()) {
      row.push_back(worst && worst->any_user ? limit_value_text(*worst->any_user, tip_stiffness_unit) : "?");
    }
    row.push_back(worst ? vector_text(worst->normal) : "");
    return row;
  }

  const Device& device_;
  const Workspace& workspace_;
  std::vector<Motion> motions_;
};

}  // namespace

std::string workspace_text(const Device& device, const Workspace& workspace, ShownFindings shown) {
  return WorkspaceWriter(device, workspace).text(shown);
}

std::string workspace_page(const Device& device, const Workspace& workspace) {
  const std::string title = fmt::format("{}: stiffest walls over its workspace", display_name(device));
  return html_page(title, element("h1", title) + WorkspaceWriter(device, workspace).page());
}

std::string worst_pose_file(const Device& device, const Workspace& workspace, const std::string& folder) {
  const WorkspaceLimit& worst = workspace.least_any_user ? *workspace.least_any_user : *workspace.least;
  DeviceParameters parameters = device_at(device, workspace.poses[worst.pose].pose, worst.normal).parameters();
  std::string& file = parameters.mechanism->mechanism.path;
  if (!file.empty()) {
    const std::filesystem::path within = std::filesystem::path(file).lexically_relative(folder);
    if (!within.empty() && *within.begin() != "..") file = within.string();
  }
  return worst_device_text(std::move(parameters), "worst pose of its workspace", workspace.trust);
}

}  // namespace zwidth::report

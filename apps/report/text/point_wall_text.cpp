#include "report/text/point_wall_text.hpp"

#include <fmt/format.h>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_note.hpp"

namespace zwidth::report {
namespace {

std::string limit_of_point(const HolderLimit& limit, std::string_view unit) {
  if (limit.critical_stiffness == 0.0) return "none: every wall is unstable";
  if (!limit.frequency) return "unbounded: every wall is stable";
  return fmt::format("{}, then shakes at {}", quantity(limit.critical_stiffness, unit),
                     quantity(hertz(*limit.frequency), "Hz"));
}

std::string bound_of_point(double stiffness, std::string_view unit) {
  return stiffness > 1e300 ? "unbounded" : quantity(stiffness, unit);
}

}  // namespace

std::string point_wall_text(const AnalysedDevice& analysed) {
  const Analysis& analysis = analysed.analysis;
  const PointWallAnswer& point = *analysis.point_wall;
  const std::string_view unit = units_of(analysed.device.parameters().motion).stiffness;
  std::string text =
      fmt::format("{}: a wall in every direction, {}\n", display_name(analysed.device), verdict_text(analysis.trust));
  if (analysis.trust.refused()) return text;
  const auto add = [&text](Holder holder, const std::string& answer) {
    text += labelled(fmt::format("  {}", words_of(holder)), answer);
  };
  add(Holder::nobody, limit_of_point(analysis.limits.nobody, unit));
  if (analysis.limits.user) add(Holder::user, limit_of_point(*analysis.limits.user, unit));
  if (point.any_user) {
    add(Holder::any_user, fmt::format("at least {}, at most {}", bound_of_point(point.any_user->at_least, unit),
                                      bound_of_point(point.any_user->at_most, unit)));
  }
  if (analysis.critical.status == StiffnessStatus::finite) {
    const Eigen::Vector3d& along = point.direction;
    text += labelled("  shakes along", fmt::format("{:.4f}, {:.4f}, {:.4f}", along.x(), along.y(), along.z()));
  }
  if (!analysis.wall) return text;
  text += labelled("  wall of the file",
                   fmt::format("{}: {}", quantity(analysis.wall->stiffness, unit), wall_verdict(analysis)));
  for (const std::string& note : wall_margin_notes(analysis)) text += fmt::format("  - {}\n", note);
  return text;
}

}  // namespace zwidth::report

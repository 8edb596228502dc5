#include <fmt/format.h>

#include <cmath>

#include "report/text/design_text.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t target_width = 30;

std::string limit_text(const DesignTargets& targets, std::string_view unit) {
  if (!targets.limit_now) return "refused";
  if (*targets.limit_now == 0.0) return "none: no wall is stable from K = 0 on";
  return std::isfinite(*targets.limit_now) ? quantity(*targets.limit_now, unit) : std::string("unbounded");
}

std::string change_text(const DesignTarget& target) {
  if (!target.value_needed || target.value_now == 0.0) return "";
  const double factor = *target.value_needed / target.value_now;
  return factor < 10.0 ? fmt::format("{:+.3g} %", 100.0 * (factor - 1.0)) : fmt::format("x {:.3g}", factor);
}

}  // namespace

std::string design_target_text(const Device& device, const DesignTargetOptions& options, const DesignTargets& targets) {
  const Motion motion = device.parameters().motion;
  const std::string_view unit = units_of(motion).stiffness;
  const bool any_user = options.goal == StiffnessGoal::any_user_limit;
  std::string text = shortened(display_name(device), line_width) + "\n";
  if (const auto trust = trust_note(targets.trust)) text += wrap(*trust, line_width, 22).replace(0, 7, "  trust");
  text += fmt::format("  {}  {}, asked for {}\n", any_user ? "any passive user  " : "critical stiffness",
                      limit_text(targets, unit), quantity(options.stiffness, unit));
  for (const Remark& remark : targets.remarks) text += wrap(remark_line(remark), line_width, 4).replace(0, 4, "  - ");
  TextTable table{{Align::left, Align::right, Align::right, Align::right},
                  {{"one number alone", "now", "needed", "change"}}};
  std::string notes;
  std::string without;
  for (const DesignTarget& each : targets.targets) {
    const std::string key = shortened(each.key, target_width);
    if (!each.value_needed) {
      without += wrap(fmt::format("{}: {}", key, each.why), line_width, 4).replace(0, 4, "  - ");
      continue;
    }
    table.rows.push_back({key, parameter_text(each.key, each.value_now, motion),
                          parameter_text(each.key, *each.value_needed, motion), change_text(each)});
    notes += wrap(fmt::format("{}: {}", key, each.why), line_width, 4).replace(0, 4, "  - ");
  }
  if (table.rows.size() > 1) {
    text += "\nWhat reaches it, the smallest change first; numbers that are 0 now at the end\n" + layout(table) + notes;
  }
  if (!without.empty()) text += "\nWhat does not\n" + without;
  return text;
}

}  // namespace zwidth::report

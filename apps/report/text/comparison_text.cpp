#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "report/text/design_text.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::report {
namespace {

std::string critical_cell(const CriticalStiffness& critical, std::string_view unit) {
  const std::string stiffness = limit_value_text(critical.stiffness, unit);
  if (!critical.limit) return stiffness;
  return fmt::format("{} ({}, {})", stiffness, quantity(hertz(critical.limit->frequency), "Hz"),
                     short_name(critical.limit->limited_by));
}

std::string short_key(const std::string& key) {
  return key.starts_with("loop.") ? key.substr(std::string_view("loop.").size()) : key;
}

/// "Free device: sensed = motor is better: 8.849 kN/m against 6.939 kN/m (+27.5 %)."
std::string sentence(std::string_view user, const DesignComparison& comparison, const std::optional<BestDesigns>& order,
                     double (*stiffness)(const ComparedDesign&), std::string_view unit) {
  if (!order) return {};
  const auto name = [&](std::size_t i) {
    return fmt::format("{} = {}", short_key(comparison.key), comparison.designs[i].value);
  };
  const double best = stiffness(comparison.designs[order->best]);
  const double next = stiffness(comparison.designs[order->second]);
  if (best == 0.0) return fmt::format("{}: no wall is stable with any of them.", user);
  if (order->as_good) {
    return fmt::format("{}: {} and {} are as good ({}).", user, name(order->best), name(order->second),
                       limit_value_text(best, unit));
  }
  const std::string gain =
      next > 0.0 && std::isfinite(best) ? fmt::format(" ({:+.3g} %)", 100.0 * (best / next - 1.0)) : std::string();
  return fmt::format("{}: {} is better, {} against {}{}.", user, name(order->best), limit_value_text(best, unit),
                     comparison.designs.size() > 2
                         ? fmt::format("{} of the next, {}", limit_value_text(next, unit), name(order->second))
                         : limit_value_text(next, unit),
                     gain);
}

std::string user_text(const User& user, Motion motion) {
  const Units units = units_of(motion);
  return fmt::format("{} {}, {} {}, {} {}", number(user.mass), units.mass, number(user.damping), units.damping,
                     number(user.stiffness), units.stiffness);
}

}  // namespace

std::string comparison_text(const DesignComparison& comparison) {
  const Device& device = comparison.designs.front().device;
  const Motion motion = device.parameters().motion;
  const std::string_view unit = units_of(motion).stiffness;
  const bool held = comparison.designs.front().held.has_value();
  const bool any_user = comparison.designs.front().any_user.has_value();
  TextTable table{{Align::left, Align::left}, {{short_key(comparison.key), "free"}}};
  const auto add_column = [&table](const char* heading) {
    table.alignment.push_back(Align::left);
    table.rows[0].emplace_back(heading);
  };
  if (any_user) add_column("any passive user");
  if (held) add_column("the given user");
  for (const ComparedDesign& each : comparison.designs) {
    std::vector<std::string> row = {shortened(each.value, 24), critical_cell(each.free, unit)};
    if (any_user) row.push_back(each.any_user ? limit_value_text(each.any_user->stiffness, unit) : "-");
    if (held) row.push_back(critical_cell(*each.held, unit));
    table.rows.push_back(std::move(row));
  }
  const auto trust = trust_note(comparison.trust);
  std::string text = shortened(display_name(device), line_width) + "\n" +
                     (trust ? wrap("  trust " + *trust, line_width, 8) : "") +
                     "Stiffest stable wall (frequency, what limits)\n" + layout(table) + "\n";
  std::vector<std::string> sentences = {sentence(
      "Free device", comparison, comparison.best_free, [](const ComparedDesign& each) { return each.free.stiffness; },
      unit)};
  if (any_user) {
    sentences.push_back(sentence(
        "Whoever holds it", comparison, comparison.best_any_user,
        [](const ComparedDesign& each) { return each.any_user->stiffness; }, unit));
  }
  if (held) {
    sentences.push_back(sentence(
        fmt::format("Held by {}", user_text(comparison.user, motion)), comparison, comparison.best_held,
        [](const ComparedDesign& each) { return each.held->stiffness; }, unit));
  }
  for (const std::string& each : sentences) {
    if (!each.empty()) text += wrap(each, line_width, 0);
  }
  if (!held && device.has_bodies()) {
    text += "For a user of your own: --operator MASS,DAMPING,STIFFNESS\n";
  }
  return text;
}

}  // namespace zwidth::report

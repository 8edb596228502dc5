#include "report/design_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/analysed_device.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"

namespace zwidth::report {
namespace {

using Align = TextTable::Align;

constexpr std::size_t width = 100;
constexpr double as_good = 1e-3;  // relative difference that is none

bool is_present(const Operator& user) { return user.mass > 0.0 || user.damping > 0.0 || user.stiffness > 0.0; }

CriticalStiffness critical_of(const Device& device) {
  const Wall& wall = device.parameters().wall;
  return critical_stiffness(filtered_plant(device), {wall.damping, wall.velocity_filter_hz});
}

Device with_user(const Device& device, const Operator& user) {
  DeviceParameters parameters = device.parameters();
  parameters.user = user;
  parameters.uncertainty.reset();
  return Device(std::move(parameters));
}

std::string stiffness_cell(double stiffness, std::string_view unit) {
  if (stiffness == 0.0) return "none";
  return std::isfinite(stiffness) ? quantity(stiffness, unit) : std::string("unbounded");
}

std::string critical_cell(const CriticalStiffness& critical, std::string_view unit) {
  const std::string stiffness = stiffness_cell(critical.stiffness, unit);
  if (!critical.limit) return stiffness;
  const std::string mechanism = critical.limit->limited_by.kind == Mechanism::Kind::rigid_body
                                    ? std::string("rigid body")
                                    : fmt::format("mode {}", critical.limit->limited_by.mode);
  return fmt::format("{} ({}, {})", stiffness, quantity(hertz(critical.limit->frequency), "Hz"), mechanism);
}

std::string short_key(const std::string& key) {
  return key.starts_with("loop.") ? key.substr(std::string_view("loop.").size()) : key;
}

/// "Free device: sensed = motor is better: 8.849 kN/m against 6.939 kN/m (+27.5 %)."
std::string sentence(std::string_view user, const DesignComparison& comparison,
                     const std::vector<std::optional<double>>& stiffness, std::string_view unit) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    if (stiffness[i]) order.push_back(i);
  }
  if (order.size() < 2) return {};
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return *stiffness[a] > *stiffness[b]; });
  const auto name = [&](std::size_t i) {
    return fmt::format("{} = {}", short_key(comparison.key), comparison.designs[i].value);
  };
  const double best = *stiffness[order[0]];
  const double next = *stiffness[order[1]];
  if (best == 0.0) return fmt::format("{}: no wall is stable with any of them.", user);
  if (best == next || std::abs(best - next) <= as_good * next) {
    return fmt::format("{}: {} and {} are as good ({}).", user, name(order[0]), name(order[1]),
                       stiffness_cell(best, unit));
  }
  const std::string gain =
      next > 0.0 && std::isfinite(best) ? fmt::format(" ({:+.3g} %)", 100.0 * (best / next - 1.0)) : std::string();
  return fmt::format("{}: {} is better, {} against {}{}.", user, name(order[0]), stiffness_cell(best, unit),
                     order.size() > 2 ? fmt::format("{} of the next, {}", stiffness_cell(next, unit), name(order[1]))
                                      : stiffness_cell(next, unit),
                     gain);
}

std::string user_text(const Operator& user, Motion motion) {
  const Units units = units_of(motion);
  return fmt::format("{} {}, {} {}, {} {}", number(user.mass), units.mass, number(user.damping), units.damping,
                     number(user.stiffness), units.stiffness);
}

/// K with each user, one per design.
struct Columns {
  std::vector<std::optional<double>> free;
  std::vector<std::optional<double>> any_user;
  std::vector<std::optional<double>> held;
};

Columns columns_of(const DesignComparison& comparison) {
  Columns columns;
  for (const ComparedDesign& each : comparison.designs) {
    columns.free.emplace_back(each.free.stiffness);
    columns.any_user.push_back(each.any_user ? std::optional(each.any_user->stiffness) : std::nullopt);
    columns.held.push_back(each.held ? std::optional(each.held->stiffness) : std::nullopt);
  }
  return columns;
}

}  // namespace

DesignComparison compare_designs(std::string key, const std::vector<Variant>& variants, const Operator& user) {
  DesignComparison comparison{std::move(key), user, {}};
  for (const Variant& variant : variants) {
    const Device free = with_user(variant.device, {});
    ComparedDesign design{variant.value, free, critical_of(free), std::nullopt, std::nullopt};
    if (free.has_bodies() && free.bodies().size() <= most_bodies_for_any_user) {
      const Wall& wall = free.parameters().wall;
      design.any_user = any_user_limit(free, {wall.damping, wall.velocity_filter_hz});
    }
    if (is_present(user)) design.held = critical_of(with_user(variant.device, user));
    comparison.designs.push_back(std::move(design));
  }
  return comparison;
}

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
    if (any_user) row.push_back(each.any_user ? stiffness_cell(each.any_user->stiffness, unit) : "-");
    if (held) row.push_back(critical_cell(*each.held, unit));
    table.rows.push_back(std::move(row));
  }
  const Columns columns = columns_of(comparison);
  std::string text = shortened(display_name(device), width) + "\nStiffest stable wall (frequency, what limits)\n" +
                     layout(table) + "\n";
  std::vector<std::string> sentences = {sentence("Free device", comparison, columns.free, unit)};
  if (any_user) sentences.push_back(sentence("Whoever holds it", comparison, columns.any_user, unit));
  if (held) {
    sentences.push_back(
        sentence(fmt::format("Held by {}", user_text(comparison.user, motion)), comparison, columns.held, unit));
  }
  for (const std::string& each : sentences) {
    if (!each.empty()) text += wrap(each, width, 0);
  }
  if (!held && device.has_bodies()) {
    text += "For a user of your own: --operator MASS,DAMPING,STIFFNESS\n";
  }
  return text;
}

}  // namespace zwidth::report

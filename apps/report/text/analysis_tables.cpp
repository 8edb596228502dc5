#include "report/text/analysis_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_note.hpp"

namespace zwidth::report {
namespace {

/// What the closed-loop poles do at the unit circle as K rises through a crossover.
std::string effect_of(int poles_leaving) {
  if (poles_leaving == 0) return "touches";
  const char* verb = poles_leaving > 0 ? "leave" : "return";
  const int count = std::abs(poles_leaving);
  return count == 1 ? fmt::format("1 pole {}s", verb) : fmt::format("{} poles {}", count, verb);
}

std::string rigid_cell(const AnalysedDevice& analysed) {
  const auto& rigid = analysed.analysis.rigid;
  if (!rigid) return "-";
  const CriticalStiffness& exact = analysed.analysis.critical;
  if (rigid->critical.status == StiffnessStatus::refused) return "-";
  if (rigid->critical.status == StiffnessStatus::none_stable) return "none";
  if (rigid->critical.status == StiffnessStatus::unbounded) return "unbounded";
  if (exact.status != StiffnessStatus::finite) {
    return quantity(rigid->critical.stiffness, units_of(analysed.device.parameters().motion).stiffness);
  }
  return fmt::format("{:+.2f} dB", decibels(rigid->critical.stiffness / exact.stiffness));
}

std::string limit_cell(const std::optional<HolderLimit>& limit, Motion motion) {
  return limit ? limit_value_text(limit->critical_stiffness, units_of(motion).stiffness) : "-";
}

bool has_user(std::span<const AnalysedDevice> devices) {
  return std::ranges::any_of(devices, [](const auto& each) { return each.analysis.limits.user.has_value(); });
}

}  // namespace

TextTable crossover_table(const AnalysedDevice& analysed, const Detail& detail) {
  const CriticalStiffness& critical = analysed.analysis.critical;
  const double nyquist = std::numbers::pi / analysed.device.loop().sampling_period;
  TextTable table{{Align::right, Align::right, Align::right, Align::right, Align::left, Align::left, Align::left},
                  {{"frequency", "rad/s", "stiffness", "dB", "belongs to", "as K rises", ""}}};
  for (const Crossover& crossover : critical.crossovers) {
    const bool is_limit = critical.limit && critical.limit->frequency == crossover.frequency;
    std::string remark = is_limit ? "<- limits" : crossover.frequency >= nyquist ? "Nyquist" : "";
    if (crossover.frequency == 0.0) remark += is_limit ? ", a real pole at rest" : "a real pole at rest";
    table.rows.push_back({quantity(hertz(crossover.frequency), "Hz"), number(crossover.frequency),
                          quantity(crossover.stiffness, units_of(analysed.device.parameters().motion).stiffness),
                          fmt::format("{:.2f}", decibels(crossover.stiffness)), short_name(crossover.limited_by),
                          effect_of(crossover.poles_leaving), remark});
  }
  if (!detail.decibels) {
    constexpr std::size_t column = 3;
    table.alignment.erase(table.alignment.begin() + column);
    for (auto& row : table.rows) row.erase(row.begin() + column);
  }
  return table;
}

TextTable mode_table(const AnalysedDevice& analysed) {
  const Analysis& analysis = analysed.analysis;
  const double nyquist = std::numbers::pi / analysed.device.loop().sampling_period;
  TextTable table{{Align::left, Align::right, Align::right, Align::right, Align::left},
                  {{"mode", "frequency", "rad/s", "damping ratio", ""}}};
  const auto add = [&](std::string name, const Mode& mode) {
    const char* remark = mode.damping_ratio > 1.0   ? "overdamped: two real poles"
                         : mode.frequency > nyquist ? "above the Nyquist frequency"
                                                    : "";
    table.rows.push_back({std::move(name), quantity(hertz(mode.frequency), "Hz"), number(mode.frequency),
                          number(mode.damping_ratio), remark});
  };
  if (analysis.suspended_rigid_body) add("rigid body", *analysis.suspended_rigid_body);
  for (std::size_t i = 0; i < analysis.modes.size(); ++i) add(fmt::format("{}", i + 1), analysis.modes[i]);
  return table;
}

TextTable comparison_table(std::span<const AnalysedDevice> devices, std::size_t name_width) {
  TextTable table{
      {Align::right, Align::left, Align::right, Align::right, Align::right, Align::left, Align::right, Align::left},
      {{"", "device", "nobody", "any user", "frequency", "limited by", "rigid model", "wall"}}};
  const bool shows_user = has_user(devices);
  if (shows_user) {
    table.alignment.insert(table.alignment.begin() + 3, Align::right);
    table.rows.front().insert(table.rows.front().begin() + 3, "user");
  }
  for (const AnalysedDevice& each : devices) {
    const Motion motion = each.device.parameters().motion;
    const HoldingLimits& limits = each.analysis.limits;
    const std::string_view mark = trust_mark(each.analysis.trust);
    const std::size_t room = name_width > mark.size() ? name_width - mark.size() : 1;
    std::vector<std::string> row = {std::to_string(table.rows.size()),
                                    shortened(display_name(each.device), room) + std::string(mark),
                                    limit_cell(limits.nobody, motion)};
    if (shows_user) row.push_back(limit_cell(limits.user, motion));
    row.push_back(limit_cell(limits.any_user, motion));
    const bool is_known = limits.nobody.frequency && limits.nobody.limited_by;
    row.push_back(is_known ? quantity(hertz(*limits.nobody.frequency), "Hz") : "-");
    row.push_back(is_known ? short_name(*limits.nobody.limited_by) : "-");
    row.push_back(rigid_cell(each));
    row.push_back(wall_verdict(each.analysis));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string comparison_legend(std::span<const AnalysedDevice> devices) {
  return fmt::format(
      "Stiffest stable spring with {}, {}with {}; frequency and mechanism are those with {}. Rigid model: how far off "
      "the same device with rigid links is; above 0 dB it is UNSAFE.",
      words_of(Holder::nobody), has_user(devices) ? fmt::format("with {}, ", words_of(Holder::user)) : "",
      words_of(Holder::any_user), words_of(Holder::nobody));
}

}  // namespace zwidth::report

#include "report/text/analysis_tables.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::report {
namespace {

/// What the closed-loop poles do at the unit circle as K rises through a crossover.
std::string effect_of(int poles_leaving) {
  if (poles_leaving == 0) return "touches";
  const char* verb = poles_leaving > 0 ? "leave" : "return";
  const int count = std::abs(poles_leaving);
  return count == 1 ? fmt::format("1 pole {}s", verb) : fmt::format("{} poles {}", count, verb);
}

std::string short_name(const Mechanism& mechanism) {
  return mechanism.kind == Mechanism::Kind::rigid_body ? "rigid body" : fmt::format("mode {}", mechanism.mode);
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

std::string any_user_cell(const AnalysedDevice& analysed) {
  const auto& limit = analysed.analysis.any_user;
  if (!limit) return "-";
  if (limit->stiffness == 0.0) return "none";
  if (!std::isfinite(limit->stiffness)) return "unbounded";
  return quantity(limit->stiffness, units_of(analysed.device.parameters().motion).stiffness);
}

}  // namespace

TextTable crossover_table(const AnalysedDevice& analysed) {
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
      {{"", "device", "K_CR", "any user", "frequency", "limited by", "rigid model", "wall"}}};
  for (const AnalysedDevice& each : devices) {
    const CriticalStiffness& critical = each.analysis.critical;
    const std::string_view mark = trust_mark(each.analysis.trust);
    const std::size_t room = name_width > mark.size() ? name_width - mark.size() : 1;
    std::vector<std::string> row = {std::to_string(table.rows.size()),
                                    shortened(display_name(each.device), room) + std::string(mark)};
    if (critical.limit) {
      row.insert(row.end(), {quantity(critical.stiffness, units_of(each.device.parameters().motion).stiffness),
                             quantity(hertz(critical.limit->frequency), "Hz"), short_name(critical.limit->limited_by)});
    } else {
      row.insert(row.end(), {critical.status == StiffnessStatus::refused       ? "refused"
                             : critical.status == StiffnessStatus::none_stable ? "none"
                                                                               : "unbounded",
                             "-", "-"});
    }
    row.insert(row.begin() + 3, any_user_cell(each));
    row.insert(row.end(), {rigid_cell(each), wall_verdict(each.analysis)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace zwidth::report

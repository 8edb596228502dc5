#include "report/analysis_text.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <numbers>
#include <optional>

#include "report/explanation.hpp"
#include "report/quantity.hpp"
#include "report/text_table.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t width = 100;
constexpr std::size_t column_name_width = 26;
using Align = TextTable::Align;

std::string paragraph(const std::optional<std::string>& text) { return text ? wrap(*text, width, 0) + "\n" : ""; }

/// Wrapped text that starts on the line of its label, all of it `indent` in.
std::string labelled(std::string_view label, std::string_view text, std::size_t indent = 22) {
  return wrap(text, width, indent).replace(0, label.size(), label);
}

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

std::string crossover_table(const AnalysedDevice& analysed) {
  const CriticalStiffness& critical = analysed.analysis.critical;
  const double period = analysed.device.loop().sampling_period;
  const double nyquist = std::numbers::pi / period;
  const std::string title =
      fmt::format("Phase crossovers (a closed-loop pole on the unit circle), all up to Nyquist at {}",
                  quantity(0.5 / period, "Hz"));
  if (critical.crossovers.empty()) return title + ": none\n\n";
  TextTable table{{Align::right, Align::right, Align::right, Align::right, Align::left, Align::left, Align::left},
                  {{"frequency", "rad/s", "stiffness", "dB", "belongs to", "as K rises", ""}}};
  for (const Crossover& crossover : critical.crossovers) {
    const bool is_limit = critical.limit && critical.limit->frequency == crossover.frequency;
    const char* remark = is_limit ? "<- limits" : crossover.frequency >= nyquist ? "Nyquist" : "";
    table.rows.push_back({quantity(hertz(crossover.frequency), "Hz"), number(crossover.frequency),
                          quantity(crossover.stiffness, units_of(analysed.device.parameters().motion).stiffness),
                          fmt::format("{:.2f}", decibels(crossover.stiffness)), short_name(crossover.limited_by),
                          effect_of(crossover.poles_leaving), remark});
  }
  return title + "\n" + layout(table) + "\n";
}

std::string mode_table(const AnalysedDevice& analysed) {
  const Analysis& analysis = analysed.analysis;
  if (analysis.modes.empty() && !analysis.suspended_rigid_body) return "";
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
  return "Vibration modes\n" + layout(table) + "\n";
}

std::string name_of(const AnalysedDevice& analysed, std::size_t longest) {
  const std::string& name = analysed.device.name();
  return name.empty() ? "(unnamed device)" : shortened(name, longest);
}

std::string answer_lines(const AnalysedDevice& analysed) {
  const CriticalStiffness& critical = analysed.analysis.critical;
  std::string text =
      name_of(analysed, width - 8) + "\n" +
      labelled("  critical stiffness", critical_stiffness_text(critical, analysed.device.parameters().motion));
  if (critical.limit) {
    text += labelled("  oscillates at", fmt::format("{} ({} rad/s)", quantity(hertz(critical.limit->frequency), "Hz"),
                                                    number(critical.limit->frequency)));
  }
  if (const auto limit = what_limits(analysed)) text += labelled("  limited by", *limit);
  return text + "\n";
}

std::string bullets(const std::vector<std::string>& texts) {
  std::string lines;
  for (const std::string& text : texts) lines += labelled("  - ", text, 4);
  return lines;
}

std::string wall_section(const AnalysedDevice& analysed) {
  const auto verdict = wall_note(analysed);
  return verdict ? wrap(*verdict, width, 0) + bullets(wall_margin_notes(analysed.analysis)) + "\n" : "";
}

std::string full_answer(const AnalysedDevice& analysed) {
  return answer_lines(analysed) + paragraph(meaning(analysed)) + wall_section(analysed) + crossover_table(analysed) +
         mode_table(analysed) + paragraph(rigid_model_note(analysed)) + paragraph(q_criterion_note(analysed)) +
         "What these numbers leave out\n" + bullets(caveats(analysed));
}

std::string rigid_cell(const AnalysedDevice& analysed) {
  const auto& rigid = analysed.analysis.rigid;
  if (!rigid) return "-";
  const CriticalStiffness& exact = analysed.analysis.critical;
  if (rigid->critical.status == StiffnessStatus::none_stable) return "none";
  if (rigid->critical.status == StiffnessStatus::unbounded) return "unbounded";
  if (exact.status != StiffnessStatus::finite) {
    return quantity(rigid->critical.stiffness, units_of(analysed.device.parameters().motion).stiffness);
  }
  return fmt::format("{:+.2f} dB", decibels(rigid->critical.stiffness / exact.stiffness));
}

std::string comparison_table(std::span<const AnalysedDevice> devices) {
  TextTable table{
      {Align::right, Align::left, Align::right, Align::right, Align::right, Align::left, Align::right, Align::left},
      {{"", "device", "K_CR", "dB", "frequency", "limited by", "rigid model", "wall"}}};
  for (const AnalysedDevice& each : devices) {
    const CriticalStiffness& critical = each.analysis.critical;
    std::vector<std::string> row = {std::to_string(table.rows.size()), name_of(each, column_name_width)};
    if (critical.limit) {
      row.insert(row.end(), {quantity(critical.stiffness, units_of(each.device.parameters().motion).stiffness),
                             fmt::format("{:.2f}", decibels(critical.stiffness)),
                             quantity(hertz(critical.limit->frequency), "Hz"), short_name(critical.limit->limited_by)});
    } else {
      row.insert(row.end(), {critical.status == StiffnessStatus::none_stable ? "none" : "unbounded", "-", "-", "-"});
    }
    row.insert(row.end(), {rigid_cell(each), wall_verdict(each.analysis)});
    table.rows.push_back(std::move(row));
  }
  return layout(table) +
         "  K_CR: stiffest stable wall. Rigid model: how far off the same device with rigid links is;\n"
         "  above 0 dB it is UNSAFE.\n\n";
}

std::string short_answer(const AnalysedDevice& analysed) {
  return answer_lines(analysed) + paragraph(meaning(analysed)) + wall_section(analysed) +
         paragraph(rigid_model_note(analysed));
}

}  // namespace

std::string analysis_text(std::span<const AnalysedDevice> devices) {
  if (devices.size() == 1) return full_answer(devices.front());
  std::string text = comparison_table(devices);
  for (std::size_t i = 0; i < devices.size(); ++i) text += fmt::format("{}. {}", i + 1, short_answer(devices[i]));
  text += "Each device alone (zwidth analyze FILE) gives its crossovers, modes and what the numbers leave out.\n";
  return text;
}

}  // namespace zwidth::report

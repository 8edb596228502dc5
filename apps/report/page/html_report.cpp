#include "report/page/html_report.hpp"

#include <fmt/format.h>

#include <numbers>
#include <optional>
#include <vector>

#include "report/figure/device_bode_figure.hpp"
#include "report/figure/stiffness_axis_figure.hpp"
#include "report/page/html_page.hpp"
#include "report/text/analysis_tables.hpp"
#include "report/text/explanation.hpp"
#include "report/text/limit_rows.hpp"
#include "report/text/markup.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_filter_text.hpp"
#include "report/text/wall_note.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t any_width = 1000;

std::string html_paragraph(const std::optional<std::string>& text) { return text ? element("p", *text) : ""; }

std::string list(const std::vector<std::string>& texts) {
  if (texts.empty()) return "";
  std::string items;
  for (const std::string& text : texts) items += element("li", text);
  return fmt::format("<ul>\n{}</ul>\n", items);
}

/// The stiffest spring that stays stable when the user lets go, too.
std::string headline(const AnalysedDevice& analysed) {
  const HoldingLimits& limits = analysed.analysis.limits;
  const bool user_limits = limits.user && limits.user->critical_stiffness < limits.nobody.critical_stiffness;
  const AnalysedDevice held = user_limits ? analysed : with_nobody_holding(analysed);
  return element("p",
                 fmt::format("Stiffest stable spring with {}", words_of(user_limits ? Holder::user : Holder::nobody))) +
         fmt::format("<p class=\"value\">{}</p>\n", escape_markup(critical_stiffness_text(
                                                        held.analysis.critical, analysed.device.parameters().motion)));
}

std::string limit_table(const AnalysedDevice& analysed) {
  const std::vector<LimitRow> rows = limit_rows(analysed);
  if (rows.empty()) return "";
  TextTable table{{Align::left, Align::left, Align::left}, {{"wall", "who holds", "stable"}}};
  for (const LimitRow& row : rows) {
    table.rows.push_back({row.what, row.holder, row.hint.empty() ? row.answer : row.answer + "; " + row.hint});
  }
  return html_table(table);
}

std::string answer(const AnalysedDevice& analysed) {
  std::string text = "<div class=\"answer\">\n";
  text += element("p", trust_note(analysed.analysis.trust).value_or("sound"));
  text += headline(analysed) + limit_table(analysed);
  if (const auto interval = interval_note(analysed)) text += element("p", "95 % interval: " + *interval + ".");
  return text + "</div>\n";
}

/// The table with a first column of numbers, which the figures use.
TextTable numbered(TextTable table) {
  table.alignment.insert(table.alignment.begin(), Align::right);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    table.rows[i].insert(table.rows[i].begin(), i == 0 ? "" : std::to_string(i));
  }
  return table;
}

std::string crossover_section(const AnalysedDevice& analysed) {
  if (analysed.analysis.critical.trust.refused()) return "";
  std::string text = element(
      "h2", fmt::format("Crossovers with {}", words_of(analysed.analysis.limits.user ? Holder::user : Holder::nobody)));
  text += element("p", fmt::format("Every wall stiffness that puts a closed-loop pole on the unit circle, up to the "
                                   "Nyquist frequency of {}, that frequency included.",
                                   quantity(0.5 / analysed.device.loop().sampling_period, "Hz")));
  if (analysed.analysis.critical.crossovers.empty()) return text + element("p", "There is none.");
  return text + html_table(numbered(crossover_table(analysed)));
}

std::string mode_section(const AnalysedDevice& analysed) {
  const TextTable table = mode_table(analysed);
  return table.rows.size() < 2 ? "" : element("h2", "Vibration modes") + html_table(table);
}

std::string figures(const AnalysedDevice& analysed, std::size_t index) {
  const std::string bode = draw(device_bode_figure({&analysed, 1}), FigureFormat::svg);
  const std::string device = fmt::format("{}, sampled every {}", display_name(analysed.device),
                                         quantity(analysed.device.loop().sampling_period, "s"));
  return html_figure(draw_stiffness_axis(analysed, FigureFormat::svg), fmt::format("axis{}", index),
                     device +
                         ": stiffness K of the virtual wall, logarithmic. Numbers are those of the table of "
                         "crossovers.") +
         html_figure(
             bode, fmt::format("bode{}", index),
             device +
                 ": response from the commanded force to the sensed position. Where the phase is an odd multiple "
                 "of 180° the loop oscillates when 1/K equals the magnitude: the numbered points, as in the table "
                 "of crossovers.");
}

std::string comparison(std::span<const AnalysedDevice> devices) {
  const auto sampled_curves = std::min(devices.size(), most_curves);
  std::string text = html_table(comparison_table(devices, any_width));
  text += element("p", comparison_legend(devices));
  const auto same_motion = [&](const AnalysedDevice& each) {
    return each.device.parameters().motion == devices.front().device.parameters().motion;
  };
  if (sampled_curves == devices.size() && std::all_of(devices.begin(), devices.end(), same_motion)) {
    text += html_figure(draw(device_bode_figure(devices), FigureFormat::svg), "comparison",
                        "What the sampled wall sees of each device, every crossover marked.");
  }
  return text;
}

/// What the file says, so that a printed report can be traced.
std::string parameters(const AnalysedDevice& analysed) {
  const DeviceParameters& device = analysed.device.parameters();
  const Units units = units_of(device.motion);
  TextTable table{{Align::left, Align::right}, {{"parameter", "value"}}};
  const auto add = [&](std::string name, double value, std::string_view unit) {
    table.rows.push_back({std::move(name), fmt::format("{:.9g} {}", value, unit)});
  };
  const auto add_if = [&](std::string name, double value, std::string_view unit) {
    if (value != 0.0) add(std::move(name), value, unit);
  };
  for (const Body& body : device.bodies) {
    add(body.name + ": mass", body.mass, units.mass);
    add(body.name + ": damping to ground", body.damping, units.damping);
    add_if(body.name + ": stiffness to ground", body.stiffness, units.stiffness);
    add_if(body.name + ": Coulomb friction (not in the analysis)", body.coulomb, units.force);
  }
  for (const Link& link : device.links) {
    const std::string name = fmt::format("{} to {}", device.bodies[link.first].name, device.bodies[link.second].name);
    add(name + ": stiffness", link.stiffness, units.stiffness);
    add(name + ": damping", link.damping, units.damping);
  }
  if (device.transfer_function) {
    table.rows.push_back({"numerator, descending powers of s",
                          fmt::format("{:.9g}", fmt::join(device.transfer_function->numerator, ", "))});
    table.rows.push_back(
        {"denominator", fmt::format("{:.9g}", fmt::join(device.transfer_function->denominator, ", "))});
  } else {
    table.rows.push_back({"actuated, sensed, held",
                          fmt::format("{}, {}, {}", device.bodies[device.loop.actuated].name,
                                      device.bodies[device.loop.sensed].name, device.bodies[device.loop.held].name)});
  }
  add("sampling period", device.loop.sampling_period, "s");
  add("delay besides the hold", device.loop.delay, "s");
  add_if("actuator time constant", device.actuator.time_constant, "s");
  if (device.actuator.force_limit) add("actuator force limit", *device.actuator.force_limit, units.force);
  add_if("encoder step", device.sensor.resolution, units.length);
  add_if("operator: mass", device.user.mass, units.mass);
  add_if("operator: damping", device.user.damping, units.damping);
  add_if("operator: stiffness", device.user.stiffness, units.stiffness);
  if (device.wall.stiffness) add("wall: stiffness", *device.wall.stiffness, units.stiffness);
  add_if("wall: damping", device.wall.damping, units.damping);
  add_if("wall: velocity filter", device.wall.velocity_filter_hz, "Hz");
  for (const WallFilter& filter : device.wall.filters) table.rows.push_back({"wall: filter", filter_text(filter)});
  return element("h2", "The device as given") + html_table(table);
}

std::string wall(const AnalysedDevice& analysed) {
  const auto verdict = wall_note(analysed);
  const auto filters = wall_filters_text(analysed.device.parameters().wall);
  if (!verdict && !filters) return "";
  std::string text = element("h2", "The wall of the file");
  if (filters) text += element("p", fmt::format("Filters in the wall, closed in every number here: {}.", *filters));
  if (verdict) text += element("p", *verdict) + list(wall_margin_notes(analysed.analysis));
  if (const std::vector<std::string> encoder = encoder_notes(analysed); !encoder.empty()) text += list(encoder);
  return text;
}

std::string why(const AnalysedDevice& analysed) {
  return element("h2", "What it means") + element("p", meaning(analysed)) + html_paragraph(rigid_model_note(analysed)) +
         html_paragraph(q_criterion_note(analysed));
}

std::string users(const AnalysedDevice& analysed) {
  TextTable table{{Align::left, Align::left}, {{"who holds it", "critical stiffness"}}};
  const auto add = [&](std::string who, const std::optional<std::string>& note) {
    if (note) table.rows.push_back({std::move(who), *note});
  };
  add("the worst one", worst_user_note(analysed));
  add("users as given", user_family_note(analysed));
  return table.rows.size() < 2 ? "" : element("h2", "Users asked for") + html_table(table);
}

std::string device_section(const AnalysedDevice& analysed, std::size_t index) {
  return answer(analysed) + why(analysed) + users(analysed) + wall(analysed) + figures(analysed, index) +
         crossover_section(analysed) + mode_section(analysed) + element("h2", "What these numbers leave out") +
         list(caveats(analysed)) + parameters(analysed);
}

constexpr std::string_view method =
    "The device is sampled exactly behind its zero-order hold, with the delay as it is, neither rounded to samples nor "
    "approximated. Every phase crossover up to and including the Nyquist frequency is found.";

}  // namespace

std::string html_report(std::span<const AnalysedDevice> devices) {
  std::string title;
  std::string body;
  if (devices.size() == 1) {
    title = display_name(devices.front().device);
    body = element("h1", title) + device_section(devices.front(), 1);
  } else {
    title = fmt::format("Critical stiffness of {} devices", devices.size());
    body = element("h1", title) + comparison(devices);
    for (std::size_t i = 0; i < devices.size(); ++i) {
      body += "<section class=\"device\">\n" +
              element("h1", fmt::format("{}. {}", i + 1, display_name(devices[i].device))) +
              device_section(devices[i], i + 1) + "</section>\n";
    }
  }
  body += fmt::format("<footer>{} Written by zwidth {}.</footer>\n", method, ZWIDTH_VERSION);
  return html_page(title, body);
}

}  // namespace zwidth::report

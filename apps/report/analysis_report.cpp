#include "report/analysis_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "report/document.hpp"
#include "report/figure/device_bode_figure.hpp"
#include "report/figure/figures.hpp"
#include "report/page/answer_box.hpp"
#include "report/page/html_page.hpp"
#include "report/text/analysis_tables.hpp"
#include "report/text/device_table.hpp"
#include "report/text/explanation.hpp"
#include "report/text/limit_rows.hpp"
#include "report/text/markup.hpp"
#include "report/text/point_wall_text.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_filter_text.hpp"
#include "report/text/wall_note.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t any_width = 1000;

std::string first_lines(const AnalysedDevice& analysed) {
  const auto trust = trust_note(analysed.analysis.trust);
  std::string text = limit_lines(analysed) + (trust ? labelled("  trust", *trust) : "");
  if (const auto interval = interval_note(analysed)) text += labelled("  95 % interval", *interval);
  if (const auto worst = worst_user_note(analysed)) text += labelled("  the worst one", *worst);
  if (const auto family = user_family_note(analysed)) text += labelled("  users as given", *family);
  return text;
}

void add_users(Document& document, const AnalysedDevice& analysed) {
  TextTable table{{Align::left, Align::left}, {{"who holds it", "critical stiffness"}}};
  const auto add = [&](std::string who, const std::optional<std::string>& note) {
    if (note) table.rows.push_back({std::move(who), *note});
  };
  add("the worst one", worst_user_note(analysed));
  add("users as given", user_family_note(analysed));
  document.part("Users asked for");
  document.table(table);
}

void add_wall(Document& document, const AnalysedDevice& analysed, const Detail& detail) {
  document.part("", "The wall of the file");
  if (const auto filters = wall_filters_text(analysed.device.parameters().wall)) {
    document.paragraph(fmt::format("Filters in the wall, closed in every number here: {}.", *filters));
  }
  if (const auto verdict = wall_note(analysed)) {
    document.paragraph(*verdict);
    document.list(wall_margin_notes(analysed.analysis));
  }
  document.list(encoder_notes(analysed, detail));
}

/// The wall to run, and what it keeps.
TextTable recommended_table(const RecommendedWall& found, Motion motion, Holder holder) {
  const Units units = units_of(motion);
  TextTable table{{Align::left, Align::right}, {{"the wall to run", ""}}};
  const auto add = [&](std::string what, std::string value) {
    table.rows.push_back({std::move(what), std::move(value)});
  };
  add("stiffness K", quantity(found.wall.stiffness.value_or(0.0), units.stiffness));
  add("damping B", fmt::format("{} {}", number(found.wall.damping), units.damping));
  if (found.wall.velocity_filter_hz > 0.0) add("velocity filter", quantity(found.wall.velocity_filter_hz, "Hz"));
  if (found.notch) add("notch", quantity(found.notch->frequency_hz, "Hz"));
  if (found.absolute_stability_limit) {
    add(fmt::format("with this damper and {}, stable up to", words_of(Holder::any_user)),
        limit_value_text(*found.absolute_stability_limit, units.stiffness));
  }
  const auto with_holder = [&](std::string_view what) { return fmt::format("{}, {}", what, words_of(holder)); };
  if (found.margins.phase_margin) {
    add(with_holder("phase margin"), fmt::format("{:.3g}°", degrees(*found.margins.phase_margin)));
  }
  if (found.margins.delay_margin) {
    add(with_holder("further delay allowed"), quantity(*found.margins.delay_margin, "s"));
  }
  if (found.force_per_count) add("force per encoder count", quantity(found.force_per_count->largest, units.force));
  return table;
}

const RecommendedWall* wall_to_run(const AnalysedDevice& analysed) {
  return analysed.walls && analysed.walls->with_margins ? &*analysed.walls->with_margins : nullptr;
}

/// The region of stable walls with the one to run, and what that keeps.
void add_walls(Document& document, const AnalysedDevice& analysed, std::size_t index) {
  if (!document.is_page() || !analysed.region) return;
  const RecommendedWall* const found = wall_to_run(analysed);
  document.part(found != nullptr ? "Stable walls, and the one to run" : "Stable walls");
  const Holder holder = holder_of(analysed.analysis.limits);
  if (found != nullptr) document.table(recommended_table(*found, analysed.device.parameters().motion, holder));
  const std::string_view filters = found != nullptr ? ", with the filters of the wall to run" : "";
  document.figure(
      fmt::format("region{}", index),
      fmt::format("Walls of stiffness K and virtual damping B{}: stable for anyone, and stable alone only.", filters),
      [&] {
        if (found == nullptr) return draw_region(analysed.device, *analysed.region, FigureFormat::svg);
        return draw_region(device_with_wall(analysed.device, found->wall), *analysed.region, FigureFormat::svg,
                           found->wall);
      });
}

void add_figures(Document& document, const AnalysedDevice& analysed, std::size_t index) {
  const std::string device = fmt::format("{}, sampled every {}", display_name(analysed.device),
                                         quantity(analysed.device.loop().sampling_period, "s"));
  document.part();
  document.figure(fmt::format("axis{}", index),
                  device +
                      ": stiffness K of the virtual wall, logarithmic. Numbers are those of the table of "
                      "crossovers.",
                  [&] { return draw_stiffness_axis(analysed, FigureFormat::svg); });
  document.figure(fmt::format("bode{}", index),
                  device +
                      ": response from the commanded force to the sensed position. Where the phase is an odd "
                      "multiple of 180° the loop oscillates when 1/K equals the magnitude: the numbered points, "
                      "as in the table of crossovers.",
                  [&] {
                    return draw(device_bode_figure({&analysed, 1}), FigureFormat::svg);
                  });
}

/// The device with only its crossovers of least stiffness, `most` of them.
AnalysedDevice with_softest_crossovers(AnalysedDevice analysed, std::size_t most) {
  auto& crossovers = analysed.analysis.critical.crossovers;
  std::vector<double> stiffnesses;
  for (const Crossover& crossover : crossovers) stiffnesses.push_back(crossover.stiffness);
  const auto last = stiffnesses.begin() + static_cast<std::ptrdiff_t>(most - 1);
  std::nth_element(stiffnesses.begin(), last, stiffnesses.end());
  std::erase_if(crossovers, [last](const Crossover& crossover) { return crossover.stiffness > *last; });
  return analysed;
}

/// The table with a first column of numbers, which the figures use.
TextTable numbered(TextTable table) {
  table.alignment.insert(table.alignment.begin(), Align::right);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    table.rows[i].insert(table.rows[i].begin(), i == 0 ? "" : std::to_string(i));
  }
  return table;
}

void add_phase_crossovers(Document& document, const AnalysedDevice& analysed, const Detail& detail) {
  // A long delay has hundreds.
  static constexpr std::size_t most = 20;
  if (analysed.analysis.critical.trust.refused()) return;
  const std::size_t count = analysed.analysis.critical.crossovers.size();
  const std::string_view holder = words_of(holder_of(analysed.analysis.limits));
  const std::string nyquist = quantity(0.5 / analysed.device.loop().sampling_period, "Hz");
  const std::string heading = fmt::format(
      "Phase crossovers with {} (a closed-loop pole on the unit circle), all up to Nyquist at {}", holder, nyquist);
  document.part(count > 0 ? heading : "", fmt::format("Crossovers with {}", holder));
  if (document.is_page()) {
    document.paragraph(
        fmt::format("Every wall stiffness that puts a closed-loop pole on the unit circle, up to the "
                    "Nyquist frequency of {}, that frequency included.",
                    nyquist));
    document.paragraph(count > 0 ? "" : "There is none.");
    document.table(numbered(crossover_table(analysed, detail)));
  } else if (count == 0) {
    document.paragraph(heading + ": none");
  } else {
    document.table(crossover_table(count > most ? with_softest_crossovers(analysed, most) : analysed, detail));
    if (count > most) document.verbatim(fmt::format("  ... the {} softest of {}; --json gives all\n", most, count));
  }
}

/// `number` from 1, where there are several.
void add_answer(Document& document, const AnalysedDevice& analysed, std::size_t number, bool is_alone,
                const Detail& detail) {
  document.part();
  if (document.is_page()) {
    document.verbatim(answer_box(analysed));
  } else {
    document.verbatim((is_alone ? "" : fmt::format("{}. ", number)) + first_lines(analysed));
  }
  document.part("", "What it means");
  document.paragraph(meaning(analysed));
  if (document.is_page()) add_users(document, analysed);
  add_walls(document, analysed, number);
  add_wall(document, analysed, detail);
  const bool is_full = is_alone || document.is_page();
  if (is_full) {
    add_figures(document, analysed, number);
    add_phase_crossovers(document, analysed, detail);
    document.part("Vibration modes");
    document.table(mode_table(analysed));
  }
  document.part("", "What simpler models say");
  document.paragraph(rigid_model_note(analysed, detail));
  if (!is_full) return;
  document.part();
  document.paragraph(q_criterion_note(analysed, detail));
  document.part("What these numbers leave out");
  document.list(caveats(analysed));
  document.part("The device as given");
  if (document.is_page()) document.table(device_table(analysed.device));
}

/// The comparison with device names as long as a line allows.
std::string fitted_comparison(std::span<const AnalysedDevice> devices) {
  static constexpr std::size_t shortest_name = 6;
  const std::size_t beside_names = width_of(layout(comparison_table(devices, shortest_name))) - shortest_name;
  return layout(comparison_table(devices, std::max(shortest_name, line_width - std::min(line_width, beside_names))));
}

void add_comparison(Document& document, std::span<const AnalysedDevice> devices) {
  if (!document.is_page()) {
    document.verbatim(fitted_comparison(devices) + wrap(comparison_legend(devices), line_width, 2));
    return;
  }
  document.table(comparison_table(devices, any_width));
  document.paragraph(comparison_legend(devices));
  const auto same_motion = [&](const AnalysedDevice& each) {
    return each.device.parameters().motion == devices.front().device.parameters().motion;
  };
  if (devices.size() <= most_curves && std::ranges::all_of(devices, same_motion)) {
    document.figure("comparison", "What the sampled wall sees of each device, every crossover marked.",
                    [&] { return draw(device_bode_figure(devices), FigureFormat::svg); });
  }
}

std::string analysis_report(std::span<const AnalysedDevice> devices, Medium medium, const Detail& detail = {}) {
  Document document(medium);
  const bool is_alone = devices.size() == 1;
  if (!is_alone) add_comparison(document, devices);
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const bool is_section = document.is_page() && !is_alone;
    document.part();
    if (is_section) {
      document.verbatim("<section class=\"device\">\n" +
                        element("h1", fmt::format("{}. {}", i + 1, display_name(devices[i].device))));
    }
    add_answer(document, devices[i], i + 1, is_alone, detail);
    if (is_section) document.verbatim("</section>\n");
  }
  if (!is_alone && !document.is_page()) {
    document.part();
    document.paragraph(
        "Each device alone (zwidth analyze FILE) gives its walls with a damper and with margins, its crossovers, modes "
        "and what the numbers leave out.");
  }
  return std::move(document).str();
}

}  // namespace

std::string analysis_text(std::span<const AnalysedDevice> devices, const Detail& detail) {
  const auto is_point = [](const AnalysedDevice& each) { return each.analysis.point_wall.has_value(); };
  if (std::ranges::none_of(devices, is_point)) return analysis_report(devices, Medium::text, detail);
  std::string text;
  for (const AnalysedDevice& each : devices) {
    if (!text.empty()) text += "\n";
    text += is_point(each) ? point_wall_text(each) : analysis_report({&each, 1}, Medium::text, detail);
  }
  return text;
}

std::optional<WallRegion> region_of_page(const AnalysedDevice& analysed, const Progress& progress) {
  const RecommendedWall* const found = wall_to_run(analysed);
  const Device device = found != nullptr ? device_with_wall(analysed.device, found->wall) : analysed.device;
  if (is_point_wall(device) || device.degrees_of_freedom() > most_bodies_for_wall_summary) return std::nullopt;
  WallRegion walls = region(device, {.approximations = false, .progress = progress});
  if (walls.trust.refused() || !walls.region.stiffest) return std::nullopt;
  return walls;
}

std::string html_report(std::span<const AnalysedDevice> devices) {
  const std::string title = devices.size() == 1 ? display_name(devices.front().device)
                                                : fmt::format("Critical stiffness of {} devices", devices.size());
  constexpr std::string_view method =
      "The device is sampled exactly behind its zero-order hold, with the delay as it is, neither rounded to samples "
      "nor approximated. Every phase crossover up to and including the Nyquist frequency is found.";
  return html_page(title, element("h1", title) + analysis_report(devices, Medium::page), method);
}

}  // namespace zwidth::report

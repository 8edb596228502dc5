#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ranges>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/analysed_device.hpp"
#include "report/figure/figures.hpp"
#include "report/figure/plot.hpp"
#include "report/text/quantity.hpp"

namespace zwidth::report {
namespace {

constexpr double bar_side = 40.0;  // px, left of the bar and right of it
constexpr double bar_height = 40.0;
constexpr double text_gap = 5.0;
constexpr std::string_view alone_colour = "#dbe7f6";
constexpr std::string_view anyone_colour = "#bfe3c5";
constexpr std::string_view unstable_colour = "#f6d5d0";
constexpr LineStyle leader{"#555555", 0.8, "1"};
constexpr LineStyle reference_leader{"#0b4f9e", 1.0, "(4,3)"};
constexpr LineStyle absolute_stability_leader{"#14532d", 1.4, "1"};
constexpr LineStyle critical_leader{"#b91c1c", 1.4, "1"};
/// More crossovers than these stand without a number, as in the Bode figure.
constexpr std::size_t most_numbered = 12;

struct Label {
  double stiffness = 0.0;
  std::string text;
  LineStyle style;
  double x = 0.0;         ///< of the leader
  std::size_t row = 0;    ///< from the bar upwards
  bool is_right = false;  ///< the text stands right of its leader
};

/// The walls that are stable with nobody holding and with the file's user, by rising K.
std::vector<StableInterval> stable_walls(const Analysis& analysis) {
  const std::vector<StableInterval>& held = analysis.critical.stable_intervals;
  if (!analysis.alone) return held;
  std::vector<StableInterval> both;
  for (const StableInterval& a : held) {
    for (const StableInterval& b : analysis.alone->critical.stable_intervals) {
      StableInterval shared{std::max(a.lower, b.lower), a.upper};
      if (b.upper && (!shared.upper || *b.upper < *shared.upper)) shared.upper = b.upper;
      if (!shared.upper || *shared.upper > shared.lower) both.push_back(shared);
    }
  }
  return both;
}

/// That can be drawn: some users destabilise some walls, not all.
bool has_absolute_stability_limit(const Analysis& analysis) {
  return analysis.any_user && analysis.any_user->stiffness > 0.0 && std::isfinite(analysis.any_user->stiffness);
}

/// Some wall, up to infinite stiffness.
bool is_stable_for_anyone(const Analysis& analysis) { return analysis.any_user && analysis.any_user->stiffness > 0.0; }

std::vector<Label> labels_of(const AnalysedDevice& analysed) {
  const Analysis& analysis = analysed.analysis;
  const std::string_view unit = units_of(analysed.device.parameters().motion).stiffness;
  const CriticalStiffness& critical = analysis.critical;
  std::vector<Label> labels;
  for (std::size_t i = 0; i < critical.crossovers.size(); ++i) {
    const Crossover& crossover = critical.crossovers[i];
    const std::string name = i < most_numbered ? std::to_string(i + 1) : "";
    if (critical.limit && critical.limit->frequency == crossover.frequency) {
      labels.push_back({crossover.stiffness,
                        fmt::format("{}: {}, {}", name.empty() ? "K" : name, words_of(holder_of(analysis.limits)),
                                    quantity(crossover.stiffness, unit)),
                        critical_leader});
    } else {
      labels.push_back({crossover.stiffness, name, leader});
    }
  }
  if (analysis.alone && analysis.alone->critical.limit) {
    const double stiffness = analysis.alone->critical.stiffness;
    labels.push_back(
        {stiffness, fmt::format("{}, {}", words_of(Holder::nobody), quantity(stiffness, unit)), critical_leader});
  }
  if (has_absolute_stability_limit(analysis)) {
    const double stiffness = analysis.any_user->stiffness;
    labels.push_back({stiffness, "any passive user, " + quantity(stiffness, unit), absolute_stability_leader});
  }
  if (analysis.rigid && analysis.rigid->critical.status == StiffnessStatus::finite &&
      analysed.device.bodies().size() > 1) {
    const double stiffness = analysis.rigid->critical.stiffness;
    labels.push_back({stiffness, "rigid model, " + quantity(stiffness, unit), reference_leader});
  }
  if (analysis.q_criterion && analysis.q_criterion->stiffness > 0.0) {
    const double stiffness = analysis.q_criterion->stiffness;
    labels.push_back({stiffness, "Q, " + quantity(stiffness, unit), reference_leader});
  }
  if (analysis.wall && analysis.wall->stiffness > 0.0) {
    labels.push_back({analysis.wall->stiffness, "the wall, " + quantity(analysis.wall->stiffness, unit),
                      LineStyle{"#1a1a1a", 1.4, "1"}});
  }
  return labels;
}

AxisRange axis_of(const std::vector<Label>& labels) {
  if (labels.empty()) return {1.0, 1e6};
  const auto [least, most] = std::ranges::minmax(labels, {}, &Label::stiffness);
  return {std::pow(10.0, std::floor(std::log10(least.stiffness) - 0.7)),
          std::pow(10.0, std::ceil(std::log10(most.stiffness) + 0.3))};
}

/// Each text stands left of its leader, like a flag, in the lowest row above every leader that it passes: so no leader
/// crosses a text. What has no room there, or would cross such a leader, stands right of it, above all others, the rightmost lowest. Returns whether all
/// stand left.
bool place(std::vector<Label>& labels, const AxisRange& axis, const Box& bar) {
  std::ranges::sort(labels, {}, &Label::stiffness);
  std::size_t rows = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    Label& label = labels[i];
    label.x = place_on_log_axis(bar, axis, label.stiffness);
    label.row = 0;
    const double left = label.x - text_gap - Canvas::text_width(label.text, text_size);
    label.is_right = left <= text_gap;
    for (std::size_t j = 0; j < i; ++j) {
      if (labels[j].x <= left - text_gap) continue;
      label.is_right = label.is_right || labels[j].is_right;
      label.row = std::max(label.row, labels[j].row + 1);
    }
    if (!label.is_right) rows = std::max(rows, label.row + 1);
  }
  for (Label& label : labels | std::views::reverse) {
    if (label.is_right) label.row = rows++;
  }
  return std::ranges::none_of(labels, &Label::is_right);
}

/// Lowers the axis until the leftmost texts have room, where that is soon.
AxisRange place_with_room(std::vector<Label>& labels, const Box& bar) {
  constexpr int most_decades = 4;
  const AxisRange least = axis_of(labels);
  for (AxisRange axis = least; axis.low > least.low * std::pow(10.0, -most_decades - 0.5); axis.low /= 10.0) {
    if (place(labels, axis, bar)) return axis;
  }
  place(labels, least, bar);
  return least;
}

constexpr std::pair<WallStability, std::string_view> colours[] = {{WallStability::unstable, unstable_colour},
                                                                  {WallStability::alone_only, alone_colour},
                                                                  {WallStability::anyone, anyone_colour}};
constexpr double swatch = 11.0;

void draw_entry(Canvas& canvas, double left, double y, std::string_view name, std::string_view colour) {
  canvas.text(left, y, name, {Anchor::left, text_size});
  canvas.rectangle({left - swatch - text_gap, left - text_gap, y - 0.5 * swatch, y + 0.5 * swatch}, colour);
}

/// The three words and their colours, at the right end of the title's line.
void draw_legend(Canvas& canvas, double right, double y) {
  constexpr double gap = 18.0;
  for (const auto& [stability, colour] : colours) {
    const std::string_view name = words_of(stability);
    const double left = right - Canvas::text_width(name, text_size);
    draw_entry(canvas, left, y, name, colour);
    right = left - swatch - text_gap - gap;
  }
}

/// One below the other, below y.
void draw_upright_legend(Canvas& canvas, double left, double y) {
  for (const auto& [stability, colour] : colours | std::views::reverse) {
    y += row_height;
    draw_entry(canvas, left + swatch + text_gap, y, words_of(stability), colour);
  }
}

}  // namespace

std::string draw_stiffness_axis(const AnalysedDevice& analysed, FigureFormat format) {
  constexpr double title_size = 15.0;
  constexpr double title_y = 16.0;
  const Page page = page_of(format);
  std::vector<Label> labels = labels_of(analysed);
  const AxisRange axis = place_with_room(labels, {bar_side, page.width - bar_side, 0.0, 0.0});
  const std::vector<std::string> title =
      Canvas::broken("Wall stiffness K: where the sampled loop is stable", title_size, page.width - 2.0 * bar_side, 3);
  const double title_bottom = title_y + row_height * (static_cast<double>(title.size()) - 1.0);
  const double legend_bottom =
      page.is_narrow() ? title_bottom + row_height * static_cast<double>(std::size(colours)) : title_y;
  std::size_t rows = 0;
  for (const Label& label : labels) rows = std::max(rows, label.row + 1);
  const double bar_top = legend_bottom + 32.0 + row_height * static_cast<double>(rows);
  const Box bar{bar_side, page.width - bar_side, bar_top, bar_top + bar_height};
  Canvas canvas("Stable wall stiffness", page.width, bar.bottom + 66.0);
  for (std::size_t i = 0; i < title.size(); ++i) {
    canvas.text(bar.left, title_y + row_height * static_cast<double>(i), title[i], {Anchor::left, title_size});
  }
  if (page.is_narrow()) {
    draw_upright_legend(canvas, bar.left, title_bottom);
  } else {
    draw_legend(canvas, bar.right, title_y);
  }
  canvas.rectangle(bar, unstable_colour);
  double unstable_from = bar.left;
  const auto name_segment = [&](double left, double right, std::string_view name) {
    if (right - left < Canvas::text_width(name, text_size) + 8.0) return;
    canvas.text(0.5 * (left + right), 0.5 * (bar.top + bar.bottom), name, {Anchor::centre, text_size});
  };
  for (const StableInterval& interval : stable_walls(analysed.analysis)) {
    const double left = interval.lower > 0.0 ? place_on_log_axis(bar, axis, interval.lower) : bar.left;
    const double right = interval.upper ? place_on_log_axis(bar, axis, *interval.upper) : bar.right;
    canvas.rectangle({left, right, bar.top, bar.bottom}, alone_colour);
    name_segment(unstable_from, left, words_of(WallStability::unstable));
    double safe = left;  // with every passive user
    if (interval.lower == 0.0 && is_stable_for_anyone(analysed.analysis)) {
      safe = std::min(place_on_log_axis(bar, axis, analysed.analysis.any_user->stiffness), right);
      canvas.rectangle({left, safe, bar.top, bar.bottom}, anyone_colour);
      name_segment(left, safe, words_of(WallStability::anyone));
    }
    name_segment(safe, right, words_of(WallStability::alone_only));
    unstable_from = right;
  }
  name_segment(unstable_from, bar.right, words_of(WallStability::unstable));

  for (const Label& label : labels) {
    const double text_y = bar.top - 16.0 - row_height * static_cast<double>(label.row);
    canvas.line(label.x, text_y - 6.0, label.x, bar.top + 8.0, label.style);
    const double last = page.width - text_gap - Canvas::text_width(label.text, text_size);
    const double left = std::max(std::min(label.x + text_gap, last), text_gap);
    canvas.text(label.is_right ? left : label.x - text_gap, text_y, label.text,
                {label.is_right ? Anchor::left : Anchor::right, text_size, label.style.colour});
  }
  canvas.text(0.5 * (bar.left + bar.right), bar.bottom + 48.0,
              fmt::format("K ({}), from 0 on the left", units_of(analysed.device.parameters().motion).stiffness),
              {Anchor::centre, text_size});
  constexpr double room_of_tick = 44.0;
  const double decades = std::log10(axis.high / axis.low);
  const double step = std::pow(10.0, std::ceil(decades * room_of_tick / (bar.right - bar.left)));
  canvas.commands(fmt::format(
      "set logscale x\nset xrange [{}:{}]\nset yrange [0:1]\nunset ytics\nset xtics {:g} nomirror out font ',12'\nset "
      "format x '%.0s%c'\nset border lw 0.8",
      axis.low, axis.high, step));
  canvas.plot(bar, "NaN notitle");
  return canvas.draw(format);
}

}  // namespace zwidth::report

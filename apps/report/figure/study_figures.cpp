#include "report/figure/study_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "report/figure/figure.hpp"
#include "report/study_report.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/model/mechanism_key.hpp"

namespace zwidth::report {
namespace {

constexpr double study_panel_height = 300.0;
constexpr double least_gain_shown = 0.001;  // of the yield: the axis where nothing is gained
constexpr std::string_view bar_colour = "#9db8dc";
constexpr std::string_view group_colours[] = {blue, orange, green, purple, red, grey};

/// The parameters by what they do to K_CR: by total index, or by how far off they are among the worst tenth.
std::vector<std::size_t> by_weight(const Study& study) {
  std::vector<double> weights(study.keys.size(), 0.0);
  if (study.sobol_indices) {
    for (std::size_t j = 0; j < weights.size(); ++j) weights[j] = (*study.sobol_indices)[j].total;
  } else if (study.points.size() > 1) {  // squared correlation with the answer
    for (std::size_t j = 0; j < weights.size(); ++j) {
      double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
      for (const StudyPoint& each : study.points) {
        if (!std::isfinite(each.stiffness)) continue;
        const double v = each.values[j], k = each.stiffness;
        n += 1, x += v, y += k, xx += v * v, yy += k * k, xy += v * k;
      }
      const double spread = (n * xx - x * x) * (n * yy - y * y);
      weights[j] = spread > 0.0 ? (n * xy - x * y) * (n * xy - x * y) / spread : 0.0;
    }
  }
  std::vector<std::size_t> order(weights.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t j) { return weights[j]; });
  return order;
}

/// What a parameter's values are drawn in; masses and inertias without a prefix.
AxisUnit value_axis(const StudyRun& run, const Study& study, std::size_t j) {
  const std::string unit =
      results::parameter_unit(study.keys[j], motion_of_key(run.device().parameters(), study.keys[j]));
  if (unit.empty() || unit.starts_with("k")) return {};
  double largest = 0.0;
  for (const StudyPoint& each : study.points) largest = std::max(largest, std::abs(each.values[j]));
  return axis_unit(largest);
}

/// How a contour is drawn, from the largest share to the least.
struct ContourLook {
  std::string_view line;
  std::string_view band;
};
constexpr ContourLook contour_looks[] = {{green, "#bfe3c8"}, {blue, "#c5d6ee"}, {orange, "#f5d3bf"}};

/// B, K and its interval, to where the contour ends; nothing of what is unbounded.
std::string contour_rows(const std::vector<double>& dampings, const RegionContour& contour, double stiffness_unit) {
  std::size_t size = dampings.size();
  while (size > 1 && contour.upper[size - 2] == 0.0) --size;
  std::string rows;
  for (std::size_t i = 0; i < size; ++i) {
    rows += fmt::format("{:.9g}", dampings[i]);
    for (const double value : {contour.stiffness[i], contour.lower[i], contour.upper[i]}) {
      rows += std::isfinite(value) ? fmt::format(" {:.9g}", value / stiffness_unit) : " NaN";
    }
    rows += "\n";
  }
  return rows;
}

}  // namespace

std::optional<std::string> draw_study_distribution(const StudyRun& run, const Study& study, FigureFormat format) {
  const StiffnessHistogram& histogram = study.histogram;
  if (histogram.counts.size() < 2) return std::nullopt;
  const std::string_view unit = units_of(run.device().parameters().motion).stiffness;
  const auto& wanted = run.options().specification.critical_stiffness;
  const std::string title = fmt::format("Critical stiffness of {} units of {}{}", study.samples,
                                        display_name(run.device()), trust_mark(study.trust));
  const double low = wanted ? std::min(histogram.edges.front(), 0.98 * *wanted) : histogram.edges.front();
  const double high = wanted ? std::max(histogram.edges.back(), 1.02 * *wanted) : histogram.edges.back();
  const AxisUnit axis = axis_unit(high);
  std::string bars;
  std::string curve;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    bars += fmt::format("{:.9g} {}\n", 0.5 * (histogram.edges[i] + histogram.edges[i + 1]) / axis.size,
                        histogram.counts[i]);
  }
  for (std::size_t i = 0; i < histogram.edges.size(); ++i) {
    curve += fmt::format("{:.9g} {:.9g}\n", histogram.edges[i] / axis.size, 100.0 * histogram.yields[i]);
  }
  constexpr const char* of_shares = "1:2 axes x1y2";
  Panel panel{
      .above = 16.0,
      .height = study_panel_height,
      .right = frame_right - 50.0,
      .axes = fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [0:*]\nset y2range [0:100]\nset y2tics 25 "
                          "format '%g %%'\nset ytics nomirror\nset boxwidth {:.9g}\nset style fill solid noborder",
                          low / axis.size, high / axis.size, (histogram.edges[1] - histogram.edges[0]) / axis.size),
      .x_label = fmt::format("Critical stiffness ({}{})", axis.prefix, unit),
      .y_label = "Units",
      .series = {{bars, fmt::format("boxes lc rgb '{}'", bar_colour)}, {curve, as_lines({blue, 2.0}), of_shares}}};
  Figure figure{.title = title,
                .legend = {{"units", {bar_colour, 8.0}, {}}, {"share of all units that reach K", {blue, 2.0}, {}}}};
  if (wanted) {
    constexpr LineStyle specified{red, 1.6, "(8,4)"};
    figure.legend.push_back({fmt::format("specified: {}", quantity(*wanted, unit)), specified, {}});
    panel.series.push_back(
        {fmt::format("{0:.9g} 0\n{0:.9g} 100\n", *wanted / axis.size), as_lines(specified), of_shares});
  }
  figure.panels = {panel};
  return draw(figure, format);
}

std::optional<std::string> draw_study_scatter(const StudyRun& run, const Study& study, FigureFormat format) {
  if (study.keys.size() < 2 || study.points.size() < 2) return std::nullopt;
  const std::vector<std::size_t> order = by_weight(study);
  const std::size_t x = order[0];
  const std::size_t y = order[1];
  const AxisUnit x_axis = value_axis(run, study, x);
  const AxisUnit y_axis = value_axis(run, study, y);
  const auto row_of = [&](const std::vector<double>& values) {
    return fmt::format("{:.9g} {:.9g}\n", values[x] / x_axis.size, values[y] / y_axis.size);
  };
  std::map<std::pair<int, int>, std::string> rows;  // by status and mode
  for (const StudyPoint& each : study.points) {
    rows[{static_cast<int>(each.status), each.mode}] += row_of(each.values);
  }
  const auto label = [&](std::size_t j, const AxisUnit& axis) {
    const std::string unit =
        results::parameter_unit(study.keys[j], motion_of_key(run.device().parameters(), study.keys[j]));
    return unit.empty() ? study.keys[j] : fmt::format("{} ({}{})", study.keys[j], axis.prefix, unit);
  };
  Figure figure{.title =
                    fmt::format("What limits the units: {} of them{}", study.points.size(), trust_mark(study.trust))};
  Panel panel{.above = 16.0,
              .height = study_panel_height,
              .left = frame_left + 20.0,
              .axes = "set offsets graph 0.03, graph 0.03, graph 0.03, graph 0.03",
              .x_label = label(x, x_axis),
              .y_label = label(y, y_axis)};
  const auto add = [&](const std::string& name, const std::string& points, const std::string& marker) {
    figure.legend.push_back({name, {}, {}, marker});
    panel.series.push_back({points, as_points(marker)});
  };
  std::size_t group = 0;
  for (const auto& [kind, points] : rows) {
    const std::string_view colour = group_colours[std::min(group++, std::size(group_colours) - 1)];
    add(oscillator_of(static_cast<StiffnessStatus>(kind.first), kind.second), points,
        fmt::format("pt 7 ps 0.3 lc rgb '{}'", colour));
  }
  if (study.worst) add("the worst unit", row_of(study.worst->values), ring_marker(ink));
  figure.panels = {panel};
  return draw(figure, format);
}

std::optional<std::string> draw_study_tornado(const Study& study, FigureFormat format) {
  const bool of_variance = study.sobol_indices.has_value();
  if (!of_variance && !study.tightening) return std::nullopt;
  constexpr std::size_t most_bars = 20;
  constexpr double row = 30.0;
  std::vector<std::size_t> order = by_weight(study);
  if (!of_variance) {
    std::ranges::stable_sort(order, std::ranges::greater{},
                             [&](std::size_t j) { return std::abs((*study.tightening)[j].yield_gain); });
  }
  order.resize(std::min(order.size(), most_bars));
  double low = 0.0;
  double high = of_variance ? 1.0 : least_gain_shown;
  for (const std::size_t j : order) {
    if (of_variance) continue;
    const TighteningGain& gain = (*study.tightening)[j];
    low = std::min(low, gain.yield_gain - gain.error);
    high = std::max(high, gain.yield_gain + gain.error);
  }
  const std::string title = fmt::format(
      "{}{}", of_variance ? "What K_CR depends on: share of its variance" : "Which tolerance to tighten: yield gained",
      trust_mark(study.trust));
  using Legend = std::vector<LegendEntry>;
  const auto draw_bars = [&](Canvas& canvas, const Box& frame) {
    const auto x = [&](double share) {
      return frame.left + (std::clamp(share, low, high) - low) / (high - low) * (frame.right - frame.left);
    };
    double middle = frame.top - 0.5 * row;
    for (const std::size_t j : order) {
      middle += row;
      if (of_variance) {
        const SobolIndex& index = (*study.sobol_indices)[j];
        canvas.rectangle({frame.left, x(index.total), middle - 9.0, middle + 9.0}, bar_colour);
        canvas.rectangle({frame.left, x(index.first), middle - 5.0, middle + 5.0}, blue);
      } else {
        const TighteningGain& gain = (*study.tightening)[j];
        canvas.rectangle(
            {x(std::min(gain.yield_gain, 0.0)), x(std::max(gain.yield_gain, 0.0)), middle - 9.0, middle + 9.0},
            bar_colour);
        canvas.line(x(gain.yield_gain - gain.error), middle, x(gain.yield_gain + gain.error), middle, {ink, 1.2});
      }
      canvas.text(frame.left - 8.0, middle, Canvas::fitted(study.keys[j], text_size, frame.left - 16.0),
                  {Anchor::right, text_size});
    }
  };
  return draw(Figure{.title = title,
                     .legend = of_variance ? Legend{{"a parameter alone", {blue, 8.0}, {}},
                                                    {"together with others", {bar_colour, 8.0}, {}}}
                                           : Legend{{"half the spread of one parameter", {bar_colour, 8.0}, {}},
                                                    {"standard error", {ink, 1.2}, {}}},
                     .panels = {{.above = 16.0,
                                 .height = row * static_cast<double>(order.size()),
                                 .left = frame_left + 180.0,
                                 .axes = fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [0:1]\nunset ytics",
                                                     100.0 * low, 100.0 * high),
                                 .x_label = of_variance ? "Share of the variance (%)" : "Yield gained (%)",
                                 .marks = draw_bars}}},
              format);
}

std::optional<std::string> draw_study_regions(const StudyRun& run, const Study& study, FigureFormat format) {
  if (!study.regions || study.regions->contours.empty()) return std::nullopt;
  const RegionContours& regions = *study.regions;
  const Units units = units_of(run.device().parameters().motion);
  double high = 0.0;
  for (const RegionContour& each : regions.contours) {
    for (const double value : each.upper) high = std::isfinite(value) ? std::max(high, value) : high;
  }
  if (high == 0.0) return std::nullopt;
  const AxisUnit axis = axis_unit(high, 3.0);
  const std::string title =
      fmt::format("Walls that shares of {} units of {} render{}", regions.units, display_name(run.device()),
                  trust_mark(regions.trust.sound() ? study.trust : regions.trust));
  Figure figure{.title = title,
                .subtitle = fmt::format("Exact every {} {}, with straight lines between; bands: 95 % intervals",
                                        number(regions.damping_step), units.damping)};
  Panel panel{.above = 16.0,
              .height = study_panel_height,
              .axes = fmt::format("set xrange [0:{:.9g}]\nset yrange [0:{:.9g}]", regions.dampings.back(),
                                  1.06 * high / axis.size),
              .x_label = fmt::format("Virtual damping B ({})", units.damping),
              .y_label = fmt::format("Stiffness K ({}{})", axis.prefix, units.stiffness)};
  std::vector<Series> curves;  // over the bands
  for (std::size_t i = 0; i < regions.contours.size(); ++i) {
    const ContourLook& look = contour_looks[std::min(i, std::size(contour_looks) - 1)];
    const std::string rows = contour_rows(regions.dampings, regions.contours[i], axis.size);
    figure.legend.push_back({fmt::format("stable for {:g} % of the units", 100.0 * regions.contours[i].share),
                             {look.line, 2.0},
                             look.band});
    panel.series.push_back({rows, as_area(look.band), "1:3:4"});
    curves.push_back({rows, as_lines({look.line, 2.0})});
  }
  panel.series.insert(panel.series.end(), curves.begin(), curves.end());
  figure.panels = {panel};
  return draw(figure, format);
}

}  // namespace zwidth::report

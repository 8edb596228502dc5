#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <vector>

#include "report/figure/figure.hpp"
#include "report/figure/figures.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/design/parameter_sweep.hpp"
#include "zwidth/model/mechanism_key.hpp"

namespace zwidth::report {
namespace {

constexpr double frame_height = 360.0;
constexpr double same_branch = 0.3;  // of log frequency, between neighbouring points
constexpr double room_above = 10.0;  // of the largest limit: branches higher up are left out
constexpr double room_below = 1.4;
constexpr double few_decades = 300.0;    // of an axis: powers of ten alone would be too few tics
constexpr std::size_t most_cells = 240;  // of the map, each way

constexpr LineStyle limit_style{"#1a1a1a", 3.4, "1"};  // in the legend; drawn in its mechanism's colour
constexpr LineStyle jump_style{"#1a1a1a", 1.0, "(2,3)"};
constexpr LineStyle branch_edge{"#1a1a1a", 1.3, "1"};
constexpr LineStyle contour_style{"#ffffff", 1.0, "1"};
constexpr LineStyle any_user_limit_style{"#15803d", 1.8, "(8,5)"};
constexpr std::array<std::string_view, 6> mode_colours = {"#0b4f9e", "#c2410c", "#7e22ce",
                                                          "#0e7490", "#a16207", "#9d174d"};

LineStyle branch_style(int mode) {
  return {mode_colours.at(static_cast<std::size_t>(mode) % mode_colours.size()), 1.3, "1"};
}

/// The unit of a parameter's axis: with a prefix where parameter_text() gives one.
AxisUnit parameter_axis_unit(const SweepAxis& axis, const Device& device) {
  const std::string unit = results::parameter_unit(axis.key, motion_of_key(device.parameters(), axis.key));
  if (unit != "s" && unit != "Hz" && !axis.key.ends_with(".stiffness")) return {};
  return axis_unit(std::max(std::abs(axis.first), std::abs(axis.last)));
}

/// What a key's number is: "Delay" of loop.delay, "Mass of motor" of body.motor.mass, "Stiffness of link 0". Of deeper keys the key.
std::string name_in_words(const std::string& key) {
  const std::size_t dot = key.rfind('.');
  if (dot == std::string::npos) return key;
  const std::string place = key.substr(0, dot);
  std::string name = key.substr(dot + 1);
  constexpr std::string_view unit_in_name = "_hz";
  if (name.ends_with(unit_in_name)) name.resize(name.size() - unit_in_name.size());
  std::ranges::replace(name, '_', ' ');
  name.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(name.front())));
  constexpr std::string_view of_body = "body.";
  constexpr std::string_view of_link = "link.";
  if (place == "loop") return name;
  if (place == "loop.damper") return name + " of the damper's loop";
  if (place.starts_with(of_body)) return name + " of " + place.substr(of_body.size());
  if (place.starts_with(of_link)) return name + " of link " + place.substr(of_link.size());
  return place.find('.') == std::string::npos ? fmt::format("{} of the {}", name, place) : key;
}

std::string axis_title(const SweepAxis& axis, const Device& device) {
  const std::string unit = results::parameter_unit(axis.key, motion_of_key(device.parameters(), axis.key));
  const std::string name = name_in_words(axis.key);
  return unit.empty() ? name : fmt::format("{} ({}{})", name, parameter_axis_unit(axis, device).prefix, unit);
}

bool is_logarithmic(const SweepAxis& axis) { return axis.spacing == SweepAxis::Spacing::logarithmic; }

/// How far apart two crossovers at neighbouring points are; at Nyquist both or none.
double distance(const Crossover& a, const Crossover& b) {
  if (a.frequency == b.frequency) return 0.0;
  if (a.frequency == 0.0 || b.frequency == 0.0 || (a.poles_leaving > 0) != (b.poles_leaving > 0) ||
      std::abs(a.poles_leaving) != std::abs(b.poles_leaving)) {
    return std::numeric_limits<double>::infinity();
  }
  return std::abs(std::log(a.frequency / b.frequency)) + 0.1 * std::abs(std::log(a.stiffness / b.stiffness));
}

/// Whether the limits of two neighbouring points are one branch.
bool goes_on(const SweepPoint& here, const SweepPoint& next) {
  return here.limit && next.limit && distance(*here.limit, *next.limit) < same_branch;
}

class CurveFigure {
 public:
  CurveFigure(const Device& device, const ParameterSweep& sweep)
      : device_(device),
        sweep_(sweep),
        values_(sweep.values[0]),
        motion_(device.parameters().motion),
        title_(fmt::format("Critical stiffness of {}{}", display_name(device), trust_mark(sweep.trust))),
        parameter_(parameter_axis_unit(sweep_.axes[0], device_)),
        stiffness_(axis_unit(range().second / room_above)) {
    for (const SweepPoint& point : sweep_.points) {
      for (const Crossover& each : point.crossovers) modes_ = std::max(modes_, each.limited_by.mode);
    }
  }

  [[nodiscard]] std::string draw(FigureFormat format) const {
    const SweepAxis& axis = sweep_.axes[0];
    const double low = range().first / stiffness_.size;
    const double high = range().second / stiffness_.size;
    const double first = std::min(axis.first, axis.last) / parameter_.size;
    const double last = std::max(axis.first, axis.last) / parameter_.size;
    Panel panel{
        .above = 28.0,
        .height = frame_height,
        .axes = fmt::format("set logscale y\n{}\nset xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\n"
                            "set format y '%g'\nset format x '%.10g'",
                            is_logarithmic(axis) ? "set logscale x" : "unset logscale x", first, last, low, high),
        .x_label = axis_title(axis, device_),
        .y_label = fmt::format("Stiffness K ({}{})", stiffness_.prefix, units_of(motion_).stiffness)};
    if (high < few_decades * low) panel.axes += "\n" + decade_ticks("y", low, high);
    if (is_logarithmic(axis) && last < few_decades * first) panel.axes += "\n" + decade_ticks("x", first, last);
    for (int mode = 0; mode <= modes_; ++mode) {
      const LineStyle style = branch_style(mode);
      panel.series.push_back({branches(mode), as_lines(style)});
      panel.series.push_back({limits(mode), as_lines({style.colour, limit_style.width, "1"})});
    }
    panel.series.push_back({jumps(), as_lines(jump_style)});
    panel.series.push_back({any_user(), as_lines(any_user_limit_style)});
    return report::draw(Figure{.title = title_, .legend = legend(), .panels = {panel}}, format);
  }

 private:
  [[nodiscard]] std::vector<LegendEntry> legend() const {
    std::vector<LegendEntry> entries{{"bold: K_CR, the crossover that limits", limit_style}};
    if (!any_user().empty()) entries.push_back({"with any passive user", any_user_limit_style});
    for (int mode = 0; mode <= modes_; ++mode) {
      if (branches(mode).empty()) continue;
      entries.push_back({mode == 0 ? std::string("crossovers of the rigid body")
                                   : fmt::format("crossovers of vibration mode {}", mode),
                         branch_style(mode)});
    }
    return entries;
  }

  /// The limits, and a decade above the largest for the branches.
  [[nodiscard]] std::pair<double, double> range() const {
    double low = std::numeric_limits<double>::infinity();
    double high = 0.0;
    const auto hold = [&](double stiffness) {
      if (!(stiffness > 0.0) || !std::isfinite(stiffness)) return;
      low = std::min(low, stiffness);
      high = std::max(high, stiffness);
    };
    for (const SweepPoint& point : sweep_.points) {
      hold(point.stiffness);
      if (point.any_user) hold(point.any_user->stiffness);
    }
    if (high == 0.0) {
      for (const SweepPoint& point : sweep_.points) {
        for (const Crossover& each : point.crossovers) hold(each.stiffness);
      }
    }
    if (high == 0.0) return {1.0, 10.0};
    return {low / room_below, high * room_above};
  }

  [[nodiscard]] const Crossover* nearest(const Crossover& to, const std::vector<Crossover>& among) const {
    const Crossover* best = nullptr;
    for (const Crossover& each : among) {
      if (distance(to, each) < same_branch && (best == nullptr || distance(to, each) < distance(to, *best))) {
        best = &each;
      }
    }
    return best;
  }

  [[nodiscard]] std::string segment(std::size_t i, double from, double to) const {
    return fmt::format("{:.9g} {:.9g}\n{:.9g} {:.9g}\n\n", values_[i] / parameter_.size, from / stiffness_.size,
                       values_[i + 1] / parameter_.size, to / stiffness_.size);
  }

  /// Pieces between neighbouring points whose crossovers are each other's nearest.
  [[nodiscard]] std::string branches(int mode) const {
    std::string rows;
    for (std::size_t i = 0; i + 1 < sweep_.points.size(); ++i) {
      const std::vector<Crossover>& here = sweep_.points[i].crossovers;
      const std::vector<Crossover>& next = sweep_.points[i + 1].crossovers;
      for (const Crossover& each : here) {
        if (each.limited_by.mode != mode) continue;
        const Crossover* partner = nearest(each, next);
        if (partner == nullptr || nearest(*partner, here) != &each) continue;
        rows += segment(i, each.stiffness, partner->stiffness);
      }
    }
    return rows;
  }

  [[nodiscard]] std::string limits(int mode) const {
    std::string rows;
    for (std::size_t i = 0; i + 1 < sweep_.points.size(); ++i) {
      const SweepPoint& here = sweep_.points[i];
      if (!goes_on(here, sweep_.points[i + 1]) || here.limit->limited_by.mode != mode) continue;
      rows += segment(i, here.stiffness, sweep_.points[i + 1].stiffness);
    }
    return rows;
  }

  /// Where another branch takes over.
  [[nodiscard]] std::string jumps() const {
    std::string rows;
    for (std::size_t i = 0; i + 1 < sweep_.points.size(); ++i) {
      const SweepPoint& here = sweep_.points[i];
      const SweepPoint& next = sweep_.points[i + 1];
      if (here.limit && next.limit && !goes_on(here, next)) rows += segment(i, here.stiffness, next.stiffness);
    }
    return rows;
  }

  [[nodiscard]] std::string any_user() const {
    std::string rows;
    for (std::size_t i = 0; i < sweep_.points.size(); ++i) {
      const auto& limit = sweep_.points[i].any_user;
      const bool drawn = limit && limit->stiffness > 0.0 && std::isfinite(limit->stiffness);
      rows += drawn ? fmt::format("{:.9g} {:.9g}\n", values_[i] / parameter_.size, limit->stiffness / stiffness_.size)
                    : std::string("\n");
    }
    return rows.find_first_not_of('\n') == std::string::npos ? "" : rows;
  }

  const Device& device_;
  const ParameterSweep& sweep_;
  const std::vector<double>& values_;
  Motion motion_;
  std::string title_;
  AxisUnit parameter_;
  AxisUnit stiffness_;
  int modes_ = 0;
};

constexpr double map_right = 760.0;  // px, room for the scale of colours

class MapFigure {
 public:
  MapFigure(const Device& device, const ParameterSweep& sweep)
      : device_(device),
        sweep_(sweep),
        motion_(device.parameters().motion),
        title_(fmt::format("Critical stiffness of {}{}", display_name(device), trust_mark(sweep.trust))),
        units_{parameter_axis_unit(sweep_.axes[0], device_), parameter_axis_unit(sweep_.axes[1], device_)} {}

  [[nodiscard]] std::string draw(FigureFormat format) const {
    const std::vector<std::size_t> first = thinned(sweep_.values[0].size());
    const std::vector<std::size_t> second = thinned(sweep_.values[1].size());
    const std::string jumps = edges_between_branches(first, second);
    double low = std::numeric_limits<double>::infinity();
    double high = 0.0;
    for (const std::size_t j : second) {
      for (const std::size_t i : first) {
        const SweepPoint& point = point_at(i, j);
        if (point.limit) low = std::min(low, point.stiffness), high = std::max(high, point.stiffness);
      }
    }
    if (high == 0.0) low = 1.0, high = 10.0;
    const AxisUnit stiffness = axis_unit(high);
    low /= stiffness.size;
    high /= stiffness.size;
    std::string rows;
    // In half cells, each of its nearest point: so the picture ends where the numbers do.
    for (std::size_t v = 0; v < 2 * (second.size() - 1); ++v) {
      for (std::size_t u = 0; u < 2 * (first.size() - 1); ++u) {
        const SweepPoint& point = point_at(first[(u + 1) / 2], second[(v + 1) / 2]);
        fmt::format_to(std::back_inserter(rows), "{:.9g} {:.9g} {}\n", middle_of_half(0, u, first),
                       middle_of_half(1, v, second),
                       point.limit ? fmt::format("{:.9g}", point.stiffness / stiffness.size) : "NaN");
      }
      rows += "\n";
    }
    const bool is_decades = high > 10.0 * low;
    const Page page = page_of(format);
    const std::vector<double> levels = contour_levels(low, high, is_decades);
    const std::string contours = contour_lines(first, second, levels, stiffness);
    Figure figure{.title = title_,
                  .subtitle = contours.empty() ? "" : "White lines: equal K_CR, at the values beside the colours."};
    if (!jumps.empty()) {
      figure.legend.push_back({"another crossover limits beyond this line: K_CR may jump", branch_edge});
    }
    figure.panels.push_back(
        {.height = frame_height,
         .right = map_right,
         .axes = fmt::format("unset grid\nunset logscale\n{}{}set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\n"
                             "set palette defined ({}) maxcolors 0\n{}set cbrange [{:.9g}:{:.9g}]\nset format cb '%g'",
                             tics("x", 0, page), tics("y", 1, {}), ends(0).first, ends(0).second, ends(1).first,
                             ends(1).second, even_colours, (is_decades ? "set logscale cb\n" : "") + level_tics(levels),
                             low, high > low ? high : 1.001 * low),
         .x_label = axis_title(sweep_.axes[0], device_),
         .y_label = axis_title(sweep_.axes[1], device_),
         .series = {{rows, "image", "1:2:3"},
                    {contours, as_lines(contour_style)},
                    {jumps, as_lines({"#ffffff", 3.0, "1"})},
                    {jumps, as_lines(branch_edge)}},
         .marks = [&](Canvas& canvas, const Box& frame) {
           canvas.colour_box({frame.right + 20.0, frame.right + 38.0, frame.top, frame.bottom});
           canvas.text(frame.right + 12.0, frame.top - 10.0,
                       fmt::format("K_CR ({}{})", stiffness.prefix, units_of(motion_).stiffness), {Anchor::left, 12.0});
         }});
    return report::draw(figure, format);
  }

 private:
  static std::vector<std::size_t> thinned(std::size_t count) {
    const std::size_t shown = std::min(count, most_cells);
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < shown; ++i) indices.push_back(i * (count - 1) / (shown - 1));
    return indices;
  }

  [[nodiscard]] const SweepPoint& point_at(std::size_t i, std::size_t j) const {
    return sweep_.points[i * sweep_.values[1].size() + j];
  }

  /// The sides of cells across which another crossover limits.
  [[nodiscard]] std::string edges_between_branches(const std::vector<std::size_t>& first,
                                                   const std::vector<std::size_t>& second) const {
    std::string rows;
    const double width = (place(0, first.back()) - place(0, first.front())) / static_cast<double>(first.size() - 1);
    const double height = (place(1, second.back()) - place(1, second.front())) / static_cast<double>(second.size() - 1);
    const auto differ = [](const SweepPoint& a, const SweepPoint& b) { return a.limit && b.limit && !goes_on(a, b); };
    const auto add = [&rows](double x1, double y1, double x2, double y2) {
      rows += fmt::format("{:.9g} {:.9g}\n{:.9g} {:.9g}\n\n", x1, y1, x2, y2);
    };
    for (std::size_t i = 0; i < first.size(); ++i) {
      for (std::size_t j = 0; j < second.size(); ++j) {
        const SweepPoint& here = point_at(first[i], second[j]);
        const double x = place(0, first[i]) + 0.5 * width;
        const double y = place(1, second[j]) + 0.5 * height;
        if (i + 1 < first.size() && differ(here, point_at(first[i + 1], second[j]))) add(x, y - height, x, y);
        if (j + 1 < second.size() && differ(here, point_at(first[i], second[j + 1]))) add(x - width, y, x, y);
      }
    }
    return rows;
  }

  /// Steps of 1, 2 or 5 within the limits, in the colours' unit: some six, or three a decade.
  static std::vector<double> contour_levels(double low, double high, bool is_decades) {
    std::vector<double> levels;
    if (is_decades) {
      for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade < high; decade *= 10.0) {
        for (const double step : {1.0, 2.0, 5.0}) levels.push_back(step * decade);
      }
    } else if (high > low) {
      const double rough = (high - low) / 6.0;
      const double decade = std::pow(10.0, std::floor(std::log10(rough)));
      const double step = decade * (rough < 2.0 * decade ? 2.0 : rough < 5.0 * decade ? 5.0 : 10.0);
      for (double count = std::ceil(low / step); count * step < high; ++count) levels.push_back(count * step);
    }
    std::erase_if(levels, [&](double level) { return level <= low || level >= high; });
    return levels;
  }

  static std::string level_tics(const std::vector<double>& levels) {
    std::string list;
    for (const double level : levels) list += fmt::format("{}{:.6g}", list.empty() ? "" : ", ", level);
    return list.empty() ? "set cbtics autofreq\n" : fmt::format("set cbtics ({})\n", list);
  }

  /// Marching squares between four points whose limits are one branch: across a jump there is no value in between.
  [[nodiscard]] std::string contour_lines(const std::vector<std::size_t>& first, const std::vector<std::size_t>& second,
                                          const std::vector<double>& levels, const AxisUnit& stiffness) const {
    struct Corner {
      const SweepPoint* point;
      double x, y, limit;
    };
    std::string rows;
    for (std::size_t i = 0; i + 1 < first.size(); ++i) {
      for (std::size_t j = 0; j + 1 < second.size(); ++j) {
        const auto corner = [&](std::size_t right, std::size_t up) {
          const SweepPoint& point = point_at(first[i + right], second[j + up]);
          return Corner{&point, place(0, first[i + right]), place(1, second[j + up]), point.stiffness / stiffness.size};
        };
        const std::array<Corner, 4> corners{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
        bool is_one_branch = true;
        for (std::size_t k = 0; k < 4; ++k) is_one_branch &= goes_on(*corners[k].point, *corners[(k + 1) % 4].point);
        if (!is_one_branch) continue;
        for (const double level : levels) {
          std::vector<std::string> crossed;
          for (std::size_t k = 0; k < 4; ++k) {
            const Corner& from = corners[k];
            const Corner& to = corners[(k + 1) % 4];
            if ((from.limit > level) == (to.limit > level)) continue;
            const double share = (level - from.limit) / (to.limit - from.limit);
            crossed.push_back(
                fmt::format("{:.9g} {:.9g}\n", from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)));
          }
          // Of a saddle the lines go round the corners that its middle differs from.
          const double middle = 0.25 * (corners[0].limit + corners[1].limit + corners[2].limit + corners[3].limit);
          if (crossed.size() == 4 && (middle > level) != (corners[0].limit > level)) {
            std::rotate(crossed.begin(), crossed.begin() + 3, crossed.end());
          }
          for (std::size_t k = 0; k + 1 < crossed.size(); k += 2) rows += crossed[k] + crossed[k + 1] + "\n";
        }
      }
    }
    return rows;
  }

  /// Cells of an image are equal: logarithmic axes are drawn in decades.
  [[nodiscard]] double place(std::size_t axis, std::size_t index) const {
    const std::vector<double>& values = sweep_.values[axis];
    const auto& ends = sweep_.axes[axis];
    const std::size_t cells = std::min(values.size(), most_cells);
    // Evenly, whatever thinning rounds.
    const double share = std::round(static_cast<double>(index) * static_cast<double>(cells - 1) /
                                    static_cast<double>(values.size() - 1)) /
                         static_cast<double>(cells - 1);
    return transformed(axis, ends.first) + share * (transformed(axis, ends.last) - transformed(axis, ends.first));
  }

  /// Of the half cells between the axis' ends, counted from 0.
  [[nodiscard]] double middle_of_half(std::size_t axis, std::size_t half, const std::vector<std::size_t>& shown) const {
    const double first = place(axis, shown.front());
    const double halves = 2.0 * static_cast<double>(shown.size() - 1);
    return first + (static_cast<double>(half) + 0.5) / halves * (place(axis, shown.back()) - first);
  }

  [[nodiscard]] double transformed(std::size_t axis, double value) const {
    const double drawn = value / units_.at(axis).size;
    return is_logarithmic(sweep_.axes[axis]) ? std::log10(drawn) : drawn;
  }

  /// The axis ends where its numbers do.
  [[nodiscard]] std::pair<double, double> ends(std::size_t axis) const {
    const double first = transformed(axis, sweep_.axes[axis].first);
    const double last = transformed(axis, sweep_.axes[axis].last);
    return {std::min(first, last), std::max(first, last)};
  }

  [[nodiscard]] std::string tics(std::string_view name, std::size_t axis, const Page& page) const {
    if (!is_logarithmic(sweep_.axes[axis])) {
      const double px = page.right - page.left - (frame_right - map_right);
      const std::string steps = page.is_narrow() ? sparse_ticks(name, ends(axis).second - ends(axis).first, px)
                                                 : fmt::format("set {}tics autofreq\n", name);
      return steps + fmt::format("set format {} '%.10g'\n", name);
    }
    const auto [low, high] = ends(axis);
    constexpr double rounding = 1e-9;
    std::string list;
    for (int decade = static_cast<int>(std::floor(low)); decade <= static_cast<int>(std::ceil(high)); ++decade) {
      for (const double step : {1.0, 2.0, 5.0}) {
        const double at = std::log10(step) + decade;
        if (at < low - rounding || at > high + rounding || (step != 1.0 && high - low > 2.5)) continue;
        list += fmt::format("{}'{:g}' {:.9g}", list.empty() ? "" : ", ", step * std::pow(10.0, decade), at);
      }
    }
    return fmt::format("set {}tics ({})\n", name, list);
  }

  const Device& device_;
  const ParameterSweep& sweep_;
  Motion motion_;
  std::string title_;
  std::array<AxisUnit, 2> units_;
};

}  // namespace

std::string draw_sweep(const Device& device, const ParameterSweep& sweep, FigureFormat format) {
  return sweep.axes.size() == 1 ? CurveFigure(device, sweep).draw(format) : MapFigure(device, sweep).draw(format);
}

}  // namespace zwidth::report

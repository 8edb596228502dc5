#include "report/figure/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace zwidth::report {
namespace {

constexpr double title_size = 16.0;
constexpr double title_row = 22.0;
constexpr double sample = 46.0;  // px of a legend's line
constexpr double text_after = 54.0;
constexpr double widest_column = 400.0;
constexpr std::size_t most_lines = 3;

}  // namespace

std::string ring_marker(std::string_view colour) { return fmt::format("pt 6 ps 0.7 lw 1.3 lc rgb '{}'", colour); }

Page page_of(const FigureFormat& format) {
  if (!format.paper_width) return {};
  constexpr double left_on_paper = 70.0;
  const double width = *format.paper_width / px_on_paper;
  return {width, left_on_paper, width - (canvas_width - frame_right)};
}

Heading::Heading(const std::string& title, std::vector<LegendEntry> legend, const std::string& subtitle,
                 const Page& page)
    : left_(page.is_narrow() ? 0.5 * row_height : page.left) {
  const double room = page.right - left_;
  const double column = std::min(widest_column, 0.5 * room + 4.0);
  title_ = Canvas::broken(title, title_size, room, most_lines);
  if (!subtitle.empty())
    subtitle_ = Canvas::broken(subtitle, text_size, room, page.is_narrow() ? 2 * most_lines : most_lines);
  bottom_ = 12.0 + title_row * static_cast<double>(title_.size());
  if (!subtitle_.empty()) bottom_ += 4.0 + row_height * static_cast<double>(subtitle_.size());
  bool beside = false;  // the second place of the row is free
  for (LegendEntry& entry : legend) {
    const bool is_short = !page.is_narrow() && Canvas::text_width(entry.text, text_size) <= column - text_after - 6.0;
    if (beside && is_short) {
      legend_.push_back({std::move(entry), left_ + column, bottom_ - 0.5 * row_height, {}});
      legend_.back().lines = {legend_.back().entry.text};
      beside = false;
      continue;
    }
    std::vector<std::string> lines = is_short ? std::vector<std::string>{entry.text}
                                              : Canvas::broken(entry.text, text_size, room - text_after, most_lines);
    const double height = row_height * static_cast<double>(lines.size());
    legend_.push_back({std::move(entry), left_, bottom_ + 0.5 * row_height, std::move(lines)});
    bottom_ += height;
    beside = is_short;
  }
}

void Heading::draw(Canvas& canvas) const {
  for (std::size_t i = 0; i < title_.size(); ++i) {
    canvas.text(left_, 18.0 + title_row * static_cast<double>(i), title_[i], {Anchor::left, title_size});
  }
  double y = 18.0 + title_row * static_cast<double>(title_.size()) + 2.0;
  for (const std::string& line : subtitle_) {
    canvas.text(left_, y, line, {Anchor::left, text_size});
    y += row_height;
  }
  for (const Placed& each : legend_) {
    const LegendEntry& entry = each.entry;
    if (!entry.fill.empty()) {
      canvas.rectangle({each.left, each.left + sample, each.y - 7.0, each.y + 7.0}, entry.fill);
    }
    if (entry.marker.empty()) {
      canvas.line(each.left, each.y, each.left + sample, each.y, entry.line);
    } else {
      canvas.marker(each.left + 0.5 * sample, each.y, entry.marker);
    }
    for (std::size_t i = 0; i < each.lines.size(); ++i) {
      canvas.text(each.left + text_after, each.y + row_height * static_cast<double>(i), each.lines[i],
                  {Anchor::left, text_size});
    }
  }
}

AxisUnit axis_unit(double largest, double least_shown) {
  static constexpr std::array<AxisUnit, 7> units = {
      {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1.0, ""}, {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}}};
  if (!(largest > 0.0) || !std::isfinite(largest)) return {};
  const auto* const found = std::ranges::find_if(
      units, [&](const AxisUnit& unit) { return largest >= least_shown * unit.size * (1.0 - 1e-12); });
  return found != units.end() ? *found : units.back();
}

double tick_step(const AxisRange& range, double step, double most_ticks) {
  while ((range.high - range.low) / step > most_ticks) step *= 2.0;
  return step;
}

double place_on_log_axis(const Box& frame, const AxisRange& range, double value) {
  const double share = std::log(value / range.low) / std::log(range.high / range.low);
  return frame.left + (frame.right - frame.left) * std::clamp(share, 0.0, 1.0);
}

std::string_view axes_look() {
  return "set tics font ',12' scale 0.6,0.3\nset border lw 0.8\n"
         "set grid xtics ytics lw 0.5 lc rgb '#c8c8c8' dt 1, lw 0.4 lc rgb '#e4e4e4' dt 1 back";
}

std::string sparse_ticks(std::string_view axis, double length, double px) {
  constexpr double room_of_tick = 48.0;
  const double least = length * room_of_tick / px;
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  const double step = decade * (least <= 2.0 * decade ? 2.0 : least <= 5.0 * decade ? 5.0 : 10.0);
  return fmt::format("set {}tics {:g}\n", axis, step);
}

std::string decade_ticks(std::string_view axis, double low, double high, double room) {
  constexpr double rounding = 1e-9;
  constexpr double room_of_tick = 30.0;
  const auto ticks_at = [&](std::span<const double> steps) {
    std::vector<std::string> ticks;
    for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10.0) {
      for (const double step : steps) {
        const double at = step * decade;
        if (at < low * (1.0 - rounding) || at > high * (1.0 + rounding)) continue;
        ticks.push_back(fmt::format("{:.6g}", at));
      }
    }
    return ticks;
  };
  constexpr std::array steps{1.0, 2.0, 5.0};
  std::vector<std::string> ticks = ticks_at(steps);
  if (room_of_tick * static_cast<double>(ticks.size()) > room && high > 100.0 * low) {
    ticks = ticks_at(std::span(steps).first(1));
  }
  return fmt::format("set {}tics ({})", axis, fmt::join(ticks, ", "));
}

}  // namespace zwidth::report

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "report/figure/figure.hpp"
#include "report/figure/figures.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/simulation_text.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/simulation/simulate.hpp"

namespace zwidth::report {
namespace {

constexpr double head_room = 0.06;  // of the axis
constexpr std::string_view wall_colour = "#e8e8e8";
/// Points drawn per curve: lowest and highest of each of so many stretches of time.
constexpr std::size_t drawn_stretches = 1200;
constexpr std::array<LineStyle, 2> motion_styles = {LineStyle{"#0b4f9e", 1.6, "1"},
                                                    LineStyle{"#c2410c", 1.4, "(10,5)"}};

struct Curve {
  std::string name;
  const std::vector<double>* values = nullptr;
};

AxisRange range_of(const std::vector<Curve>& curves) {
  AxisRange axis{curves.front().values->front(), curves.front().values->front()};
  for (const Curve& curve : curves) {
    const auto [low, high] = std::minmax_element(curve.values->begin(), curve.values->end());
    axis = {std::min(axis.low, *low), std::max(axis.high, *high)};
  }
  const double span = axis.high - axis.low;
  const double margin = span > 0.0 ? head_room * span : std::max(std::abs(axis.high), 1e-9);
  return {axis.low - margin, axis.high + margin};
}

/// Lowest and highest value of each stretch, in their order: no peak is lost.
std::vector<std::size_t> drawn_points(const std::vector<double>& values) {
  std::vector<std::size_t> points;
  const std::size_t length = std::max<std::size_t>(1, values.size() / drawn_stretches);
  for (std::size_t from = 0; from < values.size(); from += length) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(from);
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(std::min(from + length, values.size()));
    const auto [low, high] = std::minmax_element(begin, end);
    const auto first = static_cast<std::size_t>(std::min(low, high) - values.begin());
    const auto second = static_cast<std::size_t>(std::max(low, high) - values.begin());
    points.push_back(first);
    if (second != first) points.push_back(second);
  }
  return points;
}

void draw_names(Canvas& canvas, const Box& frame, const std::vector<Curve>& curves) {
  double left = frame.left;
  const double y = frame.top - 14.0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    canvas.line(left, y, left + 36.0, y, motion_styles[i]);
    const std::string name = Canvas::fitted(curves[i].name, text_size, 300.0);
    canvas.text(left + 42.0, y, name, {Anchor::left, text_size});
    left += 42.0 + Canvas::text_width(name, text_size) + 28.0;
  }
}

Panel curves_panel(const std::vector<Curve>& curves, const std::vector<double>& time, std::string_view name,
                   std::string_view unit) {
  const AxisRange axis = range_of(curves);
  const AxisUnit drawn = axis_unit(std::max(std::abs(axis.low), std::abs(axis.high)), 0.1);
  Panel panel{
      .axes = fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\nset ytics autofreq", time.front(),
                          std::max(time.back(), time.front() + 1e-12), axis.low / drawn.size, axis.high / drawn.size),
      .y_label = fmt::format("{} ({}{})", name, drawn.prefix, unit)};
  for (std::size_t i = 0; i < curves.size(); ++i) {
    std::string rows;
    for (const std::size_t k : drawn_points(*curves[i].values)) {
      rows += fmt::format("{:.9g} {:.9g}\n", time[k], (*curves[i].values)[k] / drawn.size);
    }
    panel.series.push_back({rows, as_lines(motion_styles[i])});
  }
  return panel;
}

/// How high the wall begins in the frame, in parts of it; none where it is not in the picture.
std::optional<double> wall_surface(const Simulation& result, const AxisRange& axis) {
  const ControllerOptions& wall = result.loop.controller;
  if (wall.kind != ControllerOptions::Kind::wall || wall.position >= axis.high) return std::nullopt;
  return std::max(0.0, (wall.position - axis.low) / (axis.high - axis.low));
}

std::vector<Curve> position_curves(const Device& device, const Simulation& result) {
  const Trajectory& kept = result.trajectory;
  if (!device.has_bodies()) return {{"position", &kept.position[0]}};
  const auto [sensed, held] = std::pair(device.loop().sensed, device.loop().held);
  std::vector<Curve> curves{{device.bodies()[sensed].name + " (sensed)", &kept.position[sensed]}};
  if (held != sensed) curves.push_back({device.bodies()[held].name + " (held by the user)", &kept.position[held]});
  return curves;
}

}  // namespace

std::string draw_simulation_figure(const Device& device, const Simulation& result, FigureFormat format) {
  const Trajectory& kept = result.trajectory;
  const Units units = units_of(device.parameters().motion);
  const std::vector<Curve> moved = position_curves(device, result);
  const std::optional<double> surface = wall_surface(result, range_of(moved));
  const std::string period = quantity(device.loop().sampling_period, "s");
  Figure figure{.title = fmt::format("Simulated motion of {}{}", display_name(device), trust_mark(result.trust)),
                .subtitle = result.generated_energy ? fmt::format("Wall of {}; sampled every {}.",
                                                                  simulated_wall_text(device, result), period)
                                                    : fmt::format("No wall; sampled every {}.", period),
                .below = 64.0};
  for (std::size_t i = 0; i < moved.size(); ++i) figure.legend.push_back({moved[i].name, motion_styles[i]});
  if (surface) figure.legend.push_back({"inside the wall", {wall_colour}, wall_colour});
  std::istringstream sentence(broken(verdict_sentence(device, result), 115, 0));
  for (std::string line; std::getline(sentence, line);) figure.notes.push_back({line});
  std::vector<Curve> pushed{{"commanded force", &kept.command}};
  if (result.loop.user_force.kind != UserForce::Kind::none) pushed.push_back({"user's force", &kept.user_force});
  Panel positions = curves_panel(moved, kept.time, "Position", units.length);
  positions.above = 14.0;
  positions.height = 220.0;
  positions.marks = [&](Canvas& canvas, const Box& frame) {
    if (!surface) return;
    const double bottom = frame.bottom - *surface * (frame.bottom - frame.top);
    canvas.rectangle({frame.left, frame.right, frame.top, bottom}, wall_colour);
  };
  Panel forces = curves_panel(pushed, kept.time, "Force", units.force);
  forces.above = 52.0;
  forces.height = 180.0;
  forces.x_label = "Time (s)";
  forces.marks = [&](Canvas& canvas, const Box& frame) { draw_names(canvas, frame, pushed); };
  figure.panels = {positions, forces};
  return draw(figure, format);
}

}  // namespace zwidth::report

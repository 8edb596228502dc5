#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "report/figure/figure.hpp"
#include "report/figure/figures.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "results/workspace_json.hpp"
#include "zwidth/workspace.hpp"

namespace zwidth::report {
namespace {

constexpr std::array<std::string_view, 3> world_axes{"x", "y", "z"};
constexpr double map_right = 748.0;     // px, room for the scale of colours
constexpr double least_height = 160.0;  // px of a map
constexpr double most_height = 560.0;
constexpr double small_side = 268.0;    // px of a map among several
constexpr double cells_of_map = 150.0;  // along its longer side: of the poses in one the least is drawn
constexpr double curves_along_map = 6.0;
constexpr double decades_of_scale = 10.0;  // a scale of more is logarithmic
constexpr double few_ticks_below = 300.0;

constexpr LineStyle direction_curve{"#1a1a1a", 1.1, "1"};
constexpr LineStyle curve_edge{"#ffffff", 3.0, "1"};
constexpr std::string_view anyone_ring = "pt 6 ps 1.5 lw 2.4 lc rgb '#b91c1c'";
constexpr std::string_view alone_ring = "pt 4 ps 1.4 lw 2.4 lc rgb '#7e22ce'";
constexpr std::string_view unknown_cross = "pt 2 ps 0.5 lw 1.2 lc rgb '#8a8a8a'";
constexpr std::string_view unstable_cross = "pt 2 ps 0.7 lw 2 lc rgb '#b91c1c'";

/// Two axes of the world.
struct MapView {
  int across = 0;
  int up = 1;
};

/// Where the tip is in a pose, and the least limit there.
struct TipPlace {
  Eigen::Vector3d tip;
  double limit = 0.0;  // N/m; infinity: unbounded
  std::size_t pose = 0;
};

class WorkspaceFigure {
 public:
  WorkspaceFigure(const Device& device, const Workspace& workspace, FigureFormat format)
      : device_(device), workspace_(workspace), format_(format), is_any_user_(workspace.least_any_user.has_value()) {
    for (std::size_t i = 0; i < workspace_.poses.size(); ++i) {
      const WorkspacePose& pose = workspace_.poses[i];
      if (pose.joints.empty()) continue;
      const std::optional<double> limit = least_of(pose);
      reached_.push_back(pose.tip);
      if (!limit) {
        unknown_.push_back(pose.tip);
      } else if (*limit == 0.0) {
        unstable_.push_back(pose.tip);
      } else {
        places_.push_back({pose.tip, *limit, i});
      }
    }
    for (const TipPlace& each : places_) {
      if (!std::isfinite(each.limit)) continue;
      low_ = std::min(low_, each.limit);
      high_ = std::max(high_, each.limit);
    }
    if (high_ == 0.0) low_ = 1.0, high_ = 10.0;
    stiffness_ = axis_unit(high_);
    if (reached_.empty()) return;
    double farthest = 0.0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto [low, high] =
          std::ranges::minmax(reached_, {}, [axis](const Eigen::Vector3d& tip) { return tip[axis]; });
      reach_.at(static_cast<std::size_t>(axis)) = {low[axis], high[axis]};
      farthest = std::max({farthest, -low[axis], high[axis]});
    }
    length_ = axis_unit(farthest);
  }

  [[nodiscard]] std::string draw() const {
    Figure figure{.title = fmt::format("Stiffest walls over the workspace of {}{}", display_name(device_),
                                       trust_mark(workspace_.trust)),
                  .subtitle = subtitle(),
                  .legend = legend()};
    if (is_spatial()) {
      add_views(figure);
    } else {
      figure.panels.push_back(whole_map());
    }
    return report::draw(figure, format_);
  }

 private:
  [[nodiscard]] bool is_spatial() const { return workspace_.tip_directions > 2; }

  [[nodiscard]] std::optional<double> limit_of(const DirectionLimits& direction) const {
    if (is_any_user_) return direction.any_user;
    return std::isnan(direction.nobody) ? std::nullopt : std::optional(direction.nobody);
  }

  [[nodiscard]] std::optional<double> least_of(const WorkspacePose& pose) const {
    const std::optional<DirectionLimits>& least = is_any_user_ ? pose.least_any_user : pose.least;
    return least ? limit_of(*least) : std::nullopt;
  }

  [[nodiscard]] std::string_view holder() const { return words_of(is_any_user_ ? Holder::any_user : Holder::nobody); }

  [[nodiscard]] const std::optional<WorkspaceLimit>& worst() const {
    return is_any_user_ ? workspace_.least_any_user : workspace_.least;
  }

  [[nodiscard]] std::string subtitle() const {
    if (places_.empty()) return {};
    std::string text = fmt::format(
        "Colour: the least limit over the directions of the wall with the tip there, {}; of several poses "
        "the least. {} poses.",
        holder(), workspace_.poses.size());
    if (const auto& share = workspace_.share_at_least) {
      text += fmt::format(" {} or more: {} of all poses and directions.",
                          quantity(share->stiffness, units_of(Motion::linear).stiffness),
                          percent(is_any_user_ && share->any_user ? *share->any_user : share->nobody));
    }
    return text;
  }

  static std::string percent(double share) { return fmt::format("{:.3g} %", 100.0 * share); }

  /// "shoulder 17.19°, slide 20 mm".
  [[nodiscard]] std::string pose_text(const WorkspacePose& pose) const {
    std::string text;
    const std::vector<double> positions = results::pose_positions(workspace_, pose);
    const std::vector<Motion> motions = results::pose_motions(workspace_);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const std::string& joint = workspace_.pose_joints[i];
      const double position = positions[i];
      const bool is_slide = motions[i] == Motion::linear;
      text +=
          fmt::format("{}{} {}", text.empty() ? "" : ", ", joint,
                      is_slide ? quantity(position, "m") : fmt::format("{:.4g}°", position * 180.0 / std::numbers::pi));
    }
    return text;
  }

  [[nodiscard]] std::string worst_text(Holder who, const WorkspaceLimit& limit) const {
    const Eigen::Vector3d& n = limit.normal;
    return fmt::format("least, {}: {} at {}, along {:.3g}, {:.3g}, {:.3g}", words_of(who),
                       limit_value_text(limit.stiffness, units_of(Motion::linear).stiffness),
                       pose_text(workspace_.poses[limit.pose]), n.x(), n.y(), n.z());
  }

  [[nodiscard]] std::vector<LegendEntry> legend() const {
    std::vector<LegendEntry> entries;
    const auto mark = [&](std::string text, std::string_view marker) {
      entries.push_back({std::move(text), {}, {}, std::string(marker)});
    };
    if (workspace_.trust.refused()) mark("refused: no map is given", unknown_cross);
    if (workspace_.least_any_user) mark(worst_text(Holder::any_user, *workspace_.least_any_user), anyone_ring);
    if (workspace_.least) mark(worst_text(Holder::nobody, *workspace_.least), alone_ring);
    if (has_curves()) {
      entries.push_back({"curve: the limit over directions, each to its own greatest", direction_curve, {}});
    }
    if (!unstable_.empty()) mark(fmt::format("{} poses: no wall is stable", unstable_.size()), unstable_cross);
    if (!unknown_.empty()) mark(fmt::format("{} poses without a known limit", unknown_.size()), unknown_cross);
    return entries;
  }

  [[nodiscard]] bool has_curves() const { return workspace_.tip_directions == 2 && !places_.empty(); }

  /// The part of the world's axis that the tip reaches.
  [[nodiscard]] const AxisRange& reach(int axis) const { return reach_.at(static_cast<std::size_t>(axis)); }

  [[nodiscard]] double extent(int axis) const {
    const AxisRange range = reach(axis);
    return range.high - range.low;
  }

  /// In which two axes the tip moves most.
  [[nodiscard]] MapView widest_view() const {
    int least = 2;
    for (const int axis : {1, 0}) {
      if (extent(axis) < extent(least)) least = axis;
    }
    return least == 2 ? MapView{0, 1} : least == 1 ? MapView{0, 2} : MapView{1, 2};
  }

  /// The least place of each cell, the least of all last: it lies on top.
  [[nodiscard]] std::vector<TipPlace> thinned(const MapView& view, double cells) const {
    const double cell = std::max(extent(view.across), extent(view.up)) / cells;
    std::map<std::pair<long, long>, TipPlace> kept;
    for (const TipPlace& each : places_) {
      const auto index = [&](int axis) {
        return cell > 0.0 ? std::lround((each.tip[axis] - reach(axis).low) / cell) : 0L;
      };
      const auto [found, is_new] = kept.try_emplace({index(view.across), index(view.up)}, each);
      if (!is_new && each.limit < found->second.limit) found->second = each;
    }
    std::vector<TipPlace> places;
    for (const auto& [where, each] : kept) places.push_back(each);
    std::ranges::stable_sort(places, std::ranges::greater{}, &TipPlace::limit);
    return places;
  }

  /// Places so far apart, the worst first.
  [[nodiscard]] std::vector<TipPlace> spread(const MapView& view, double apart) const {
    std::vector<TipPlace> places;
    const auto is_free = [&](const Eigen::Vector3d& tip) {
      return std::ranges::none_of(places, [&](const TipPlace& other) {
        return std::hypot(tip[view.across] - other.tip[view.across], tip[view.up] - other.tip[view.up]) < apart;
      });
    };
    for (const TipPlace& each : places_) {
      if (each.pose == worst_pose()) places.push_back(each);
    }
    for (const TipPlace& each : places_) {
      if (is_free(each.tip)) places.push_back(each);
    }
    return places;
  }

  [[nodiscard]] std::size_t worst_pose() const {
    return worst() ? worst()->pose : std::numeric_limits<std::size_t>::max();
  }

  [[nodiscard]] std::string row(const Eigen::Vector3d& at, const MapView& view) const {
    return fmt::format("{:.9g} {:.9g}\n", at[view.across] / length_.size, at[view.up] / length_.size);
  }

  [[nodiscard]] std::string rows(const std::vector<Eigen::Vector3d>& places, const MapView& view) const {
    std::string text;
    for (const Eigen::Vector3d& each : places) text += row(each, view);
    return text;
  }

  /// On the scale of colours: what is unbounded at its end.
  [[nodiscard]] double colour(double limit) const { return std::min(limit, high_) / stiffness_.size; }

  /// Dots that touch each other, so large that they fill what the tip reaches.
  [[nodiscard]] Series coloured(const MapView& view, double per_px) const {
    const std::vector<TipPlace> places = thinned(view, cells_of_map);
    const double wide = extent(view.across);
    const double high = extent(view.up);
    const double area = std::max(wide, 0.02 * high) * std::max(high, 0.02 * wide);
    const double spacing = std::sqrt(area / std::max(4.0, static_cast<double>(places.size())));
    std::string text;
    for (const TipPlace& each : places) {
      text += fmt::format("{:.6g} {:.6g} {:.6g}\n", each.tip[view.across] / length_.size,
                          each.tip[view.up] / length_.size, colour(each.limit));
    }
    return {text, dots(std::clamp(0.62 * spacing / per_px, 2.0, 30.0)), "1:2:3"};
  }

  [[nodiscard]] std::string dots(double radius) const {
    return fmt::format("points pt 7 ps {:.3f} lc palette", radius / point_radius(format_));
  }

  /// Around the tip of a pose the limit in every direction of the plane.
  [[nodiscard]] std::string curve_rows(const TipPlace& place, const MapView& view, double radius) const {
    std::vector<std::pair<double, double>> around;  // angle, limit
    double greatest = 0.0;
    const WorkspacePose& pose = workspace_.poses[place.pose];
    const auto add = [&](const DirectionLimits& direction) {
      const auto limit = limit_of(direction);
      if (!limit) return;
      const double angle = std::atan2(direction.normal[view.up], direction.normal[view.across]);
      around.emplace_back(angle < 0.0 ? angle + std::numbers::pi : angle, *limit);
      if (std::isfinite(*limit)) greatest = std::max(greatest, *limit);
    };
    for (const DirectionLimits& each : pose.directions) add(each);
    for (const auto* each : {&pose.least, &pose.greatest, &pose.least_any_user}) {
      if (*each) add(**each);
    }
    if (around.size() < 3 || greatest == 0.0) return {};
    std::ranges::sort(around);
    std::string text;
    for (const double half : {0.0, std::numbers::pi}) {
      for (const auto& [angle, limit] : around) {
        const double length = radius * std::min(1.0, limit / greatest);
        Eigen::Vector3d at = place.tip;
        at[view.across] += length * std::cos(angle + half);
        at[view.up] += length * std::sin(angle + half);
        text += row(at, view);
      }
    }
    return text + text.substr(0, text.find('\n') + 1) + "\n";
  }

  void add_worst(Panel& panel, const MapView& view, double arrow) const {
    const auto add = [&](const std::optional<WorkspaceLimit>& limit, std::string_view ring, std::string_view look) {
      if (!limit) return;
      const Eigen::Vector3d& tip = workspace_.poses[limit->pose].tip;
      const Eigen::Vector3d to = arrow * limit->normal;
      panel.series.push_back({row(tip, view), as_points(ring)});
      panel.series.push_back(
          {fmt::format("{:.9g} {:.9g} {:.9g} {:.9g}\n", tip[view.across] / length_.size, tip[view.up] / length_.size,
                       to[view.across] / length_.size, to[view.up] / length_.size),
           fmt::format("vectors head filled size screen 0.012,20 lw 2.2 lc rgb '{}'", look), "1:2:3:4"});
    };
    add(workspace_.least, alone_ring, purple);
    add(workspace_.least_any_user, anyone_ring, red);
  }

  [[nodiscard]] std::string palette() const {
    const double low = low_ / stiffness_.size;
    const double high = std::max(high_, 1.001 * low_) / stiffness_.size;
    const bool is_logarithmic = high > decades_of_scale * low;
    return fmt::format(
        "set palette defined ({}) maxcolors 0\n{} cb\nset cbrange [{:.9g}:{:.9g}]\nset format cb '%g'\n{}",
        even_colours, is_logarithmic ? "set logscale" : "unset logscale", low, high,
        is_logarithmic && high < few_ticks_below * low ? decade_ticks("cb", low, high) : "set cbtics autofreq");
  }

  void add_scale(Canvas& canvas, const Box& frame, double left) const {
    canvas.colour_box({left, left + 16.0, frame.top, frame.bottom});
    canvas.text(left - 8.0, frame.top - 10.0,
                fmt::format("K ({}{})", stiffness_.prefix, units_of(Motion::linear).stiffness), {Anchor::left, 12.0});
  }

  [[nodiscard]] std::string axis_text(int axis) const {
    return fmt::format("{} of the tip ({}m)", world_axes.at(static_cast<std::size_t>(axis)), length_.prefix);
  }

  /// Of an axis over this length, m.
  [[nodiscard]] std::string tics(std::string_view axis, double length, double px) const {
    return page_.is_narrow() ? sparse_ticks(axis, length / length_.size, px)
                             : fmt::format("set {}tics autofreq\n", axis);
  }

  /// A map in a frame of this size, px, both axes to one scale.
  [[nodiscard]] Panel map(const MapView& view, double width, double height) const {
    const AxisRange across = reach(view.across);
    const AxisRange up = reach(view.up);
    const double room = page_.is_narrow() ? 20.0 : 40.0;  // px, of the dots and curves at the ends
    const double wide = across.high - across.low;
    const double high = up.high - up.low;
    double per_px = std::max({1.16 * wide / width, wide / (width - 2.0 * room), high / (height - 2.0 * room)});
    if (per_px == 0.0) per_px = 0.2 / width;
    const auto axis = [&](std::string_view name, const AxisRange& range, double size) {
      const double middle = 0.5 * (range.low + range.high);
      return fmt::format("set {}range [{:.9g}:{:.9g}]\n", name, (middle - 0.5 * per_px * size) / length_.size,
                         (middle + 0.5 * per_px * size) / length_.size);
    };
    Panel panel{.above = 34.0,
                .height = height,
                .left = page_.left,
                .right = page_.left + width,
                .is_placed = true,
                .axes = axis("x", across, width) + axis("y", up, height) + tics("x", per_px * width, width) +
                        tics("y", per_px * height, height) + palette(),
                .x_label = axis_text(view.across),
                .y_label = axis_text(view.up)};
    panel.series.push_back(coloured(view, per_px));
    panel.series.push_back({rows(unknown_, view), as_points(unknown_cross)});
    panel.series.push_back({rows(unstable_, view), as_points(unstable_cross)});
    return panel;
  }

  [[nodiscard]] Panel whole_map() const {
    const MapView view = widest_view();
    constexpr double room_on_paper = 98.0;
    const double beside = page_.is_narrow() ? room_on_paper : canvas_width - map_right;
    const double width = page_.width - beside - page_.left;
    const double wide = extent(view.across);
    const double shape = wide > 0.0 ? extent(view.up) / wide : 1.0;
    const double height = std::clamp(width * shape, least_height, most_height);
    Panel panel = map(view, width, height);
    const double apart = std::max({extent(view.across), extent(view.up), 0.1}) / curves_along_map;
    if (has_curves()) {
      std::string curves;
      for (const TipPlace& each : spread(view, apart)) curves += curve_rows(each, view, 0.42 * apart);
      panel.series.push_back({curves, as_lines(curve_edge)});
      panel.series.push_back({curves, as_lines(direction_curve)});
    }
    add_worst(panel, view, 0.5 * apart);
    panel.marks = [this](Canvas& canvas, const Box& frame) { add_scale(canvas, frame, frame.right + 22.0); };
    return panel;
  }

  /// The directions of a wall at the worst pose, seen along z: n and -n are one, so half a sphere shows all.
  [[nodiscard]] Panel directions_of_worst() const {
    Panel panel{.height = small_side_on_page(),
                .axes = "set xrange [-1.12:1.12]\nset yrange [-1.12:1.12]\nset xtics 0.5\nset ytics 0.5",
                .x_label = "x of the normal",
                .y_label = "y of the normal"};
    std::string limits;
    const auto flat = [](const Eigen::Vector3d& normal) {
      return Eigen::Vector3d(std::copysign(1.0, normal.z()) * normal);
    };
    for (const DirectionLimits& each : workspace_.poses[worst()->pose].directions) {
      const auto limit = limit_of(each);
      const Eigen::Vector3d at = flat(each.normal);
      if (limit && *limit > 0.0) {
        limits += fmt::format("{:.6g} {:.6g} {:.6g}\n", at.x(), at.y(), colour(*limit));
      }
    }
    std::string outline;
    for (int degree = 0; degree <= 360; degree += 3) {
      const double angle = degree * std::numbers::pi / 180.0;
      outline += fmt::format("{:.6f} {:.6f}\n", std::cos(angle), std::sin(angle));
    }
    panel.series.push_back({outline, as_lines({grey, 0.8, "1"})});
    panel.series.push_back({limits, dots(8.0), "1:2:3"});
    const Eigen::Vector3d at = flat(worst()->normal);
    panel.series.push_back(
        {fmt::format("{:.9g} {:.9g}\n", at.x(), at.y()), as_points(is_any_user_ ? anyone_ring : alone_ring)});
    return panel;
  }

  /// With room for the scale of colours.
  [[nodiscard]] double small_side_on_page() const {
    constexpr double room_of_scale = 100.0;
    return std::min(small_side, page_.width - page_.left - room_of_scale);
  }

  /// Seen along each axis of the world, and every direction at the worst pose.
  void add_views(Figure& figure) const {
    static constexpr std::array<MapView, 3> views{MapView{0, 1}, MapView{0, 2}, MapView{1, 2}};
    static constexpr double between = 120.0;
    const double side = small_side_on_page();
    const auto put = [&](Panel panel, std::string heading, bool has_scale) {
      const bool is_beside = !page_.is_narrow() && figure.panels.size() % 2 == 1;
      panel.is_beside = is_beside;
      panel.above = figure.panels.empty() ? 40.0 : 84.0;
      panel.left = page_.left + (is_beside ? side + between : 0.0);
      panel.right = panel.left + side;
      panel.is_placed = true;
      panel.marks = [this, heading, has_scale](Canvas& canvas, const Box& frame) {
        canvas.text(frame.left, frame.top - 12.0, heading, {Anchor::left, 12.0, grey});
        if (has_scale) add_scale(canvas, frame, frame.right + 40.0);
      };
      if (!has_scale) panel.axes += "\nunset colorbox";
      figure.panels.push_back(std::move(panel));
    };
    for (const MapView& view : views) {
      Panel panel = map(view, side, side);
      add_worst(panel, view, 0.18 * std::max(extent(view.across), extent(view.up)));
      const int depth = 3 - view.across - view.up;
      put(std::move(panel),
          fmt::format("seen along {}, the least in front", world_axes.at(static_cast<std::size_t>(depth))),
          figure.panels.size() == 1);
    }
    if (worst()) put(directions_of_worst(), "directions at the worst pose; the brightest: that or more", false);
  }

  const Device& device_;
  const Workspace& workspace_;
  FigureFormat format_;
  Page page_ = page_of(format_);
  bool is_any_user_ = false;
  std::vector<TipPlace> places_;
  std::vector<Eigen::Vector3d> reached_;                  // where the tip is, in every pose
  std::vector<Eigen::Vector3d> unknown_;                  // where no limit is known
  std::vector<Eigen::Vector3d> unstable_;                 // where no wall is stable
  double low_ = std::numeric_limits<double>::infinity();  // N/m, of the scale of colours
  double high_ = 0.0;
  AxisUnit stiffness_;
  std::array<AxisRange, 3> reach_{};  // m
  AxisUnit length_;
};

}  // namespace

std::string draw_workspace(const Device& device, const Workspace& workspace, FigureFormat format) {
  return WorkspaceFigure(device, workspace, format).draw();
}

}  // namespace zwidth::report

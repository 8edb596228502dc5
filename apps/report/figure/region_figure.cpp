#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "report/figure/figure.hpp"
#include "report/figure/figures.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_filter_text.hpp"
#include "zwidth/design/region.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth::report {
namespace {

using Formula = RegionApproximation::Formula;

constexpr double panel_height = 360.0;

constexpr std::string_view region_colour = "#dbe7f6";
constexpr std::string_view any_user_colour = "#bfe3c8";
constexpr LineStyle boundary_style{"#0b4f9e", 2.0, "1"};
constexpr std::string_view recommended_marker = "pt 7 ps 1.3 lc rgb '#1a1a1a'";
constexpr LineStyle held_style{"#0b4f9e", 2.0, "(6,4)"};
constexpr LineStyle any_user_style{"#15803d", 1.6, "1"};
constexpr LineStyle one_rate_style{"#b45309", 1.8, "(10,5)"};

LineStyle style_of(Formula formula) {
  switch (formula) {
    case Formula::colgate_schenkel:
      return {"#c2410c", 1.6, "(10,5)"};
    case Formula::gil_hulin:
      return {"#7e22ce", 1.6, "(3,4)"};
    case Formula::diolaiti:
      break;
  }
  return {"#1a1a1a", 1.6, "1"};
}

std::string point_marker(Formula formula) {
  return fmt::format("pt 6 ps 0.9 lw 1.6 lc rgb '{}'", style_of(formula).colour);
}

/// What a panel shows: 0 to these.
struct Extent {
  double damping = 0.0;
  double stiffness = 0.0;
};

struct Place {
  double damping = 0.0;
  double stiffness = 0.0;
};

/// The part of a closed outline where `excess` is not above 0 (Sutherland & Hodgman): what gnuplot fills of an outline that
/// leaves its frame is not it.
template <class Excess>
std::vector<Place> cut_off(const std::vector<Place>& outline, Excess excess) {
  std::vector<Place> kept;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Place& a = outline[i];
    const Place& b = outline[(i + 1) % outline.size()];
    const double at_a = excess(a);
    const double at_b = excess(b);
    if (at_a <= 0.0) kept.push_back(a);
    if ((at_a <= 0.0) == (at_b <= 0.0)) continue;
    const double share = at_a / (at_a - at_b);
    kept.push_back({std::lerp(a.damping, b.damping, share), std::lerp(a.stiffness, b.stiffness, share)});
  }
  return kept;
}

std::vector<Place> within(const std::vector<Place>& outline, const Extent& extent) {
  return cut_off(cut_off(outline, [&](const Place& each) { return each.damping - extent.damping; }),
                 [&](const Place& each) { return each.stiffness - extent.stiffness; });
}

class RegionFigure {
 public:
  RegionFigure(const Device& device, const WallRegion& walls, const std::optional<Wall>& recommended,
               const WallRegion* one_rate)
      : device_(device),
        walls_(walls),
        recommended_(recommended),
        one_rate_(one_rate && !one_rate->trust.refused() ? &walls_with_nobody(*one_rate) : nullptr),
        units_(units_of(device.parameters().motion)) {}

  [[nodiscard]] std::string draw(FigureFormat format) const {
    constexpr double gap = 100.0;
    const std::vector<Extent> shown = extents();
    Figure figure{.title = title(),
                  .subtitle = fmt::format("{} White: {}.", timing(), words_of(WallStability::unstable)),
                  .legend = legend()};
    const auto count = static_cast<double>(shown.size());
    const double width = (frame_right - frame_left - gap * (count - 1.0)) / count;
    double left = frame_left;
    for (const Extent& extent : shown) {
      figure.panels.push_back(panel(extent));
      figure.panels.back().left = left;
      figure.panels.back().right = left + width;
      left += width + gap;
    }
    if (shown.size() > 1) {
      figure.panels.back().is_beside = true;
      figure.panels.back().marks = [](Canvas& canvas, const Box& frame) {
        canvas.text(frame.left, frame.top - 12.0, "Zoom: the corner at the origin", {Anchor::left, 12.0, grey});
      };
    }
    return report::draw(figure, format);
  }

 private:
  static const StableRegion& walls_with_nobody(const WallRegion& walls) {
    return walls.nobody ? walls.nobody->region : walls.region;
  }

  /// When spring and damper run.
  [[nodiscard]] std::string timing() const {
    const Loop& loop = device_.loop();
    const std::string spring =
        fmt::format("every {}, {} of delay", quantity(loop.sampling_period, "s"), quantity(loop.delay, "s"));
    if (!has_damper_loop(loop)) {
      return fmt::format(
          "Sampled {}.{}", spring,
          walls_.approximations.empty() ? "" : " In brackets: how far a formula lies above the exact limit.");
    }
    const DamperTiming damper = damper_timing(loop);
    return fmt::format("Spring {}; damper every {}, {} of delay.", spring, quantity(damper.sampling_period, "s"),
                       quantity(damper.delay, "s"));
  }

  /// Who holds where a wall is called stable.
  [[nodiscard]] std::string holders() const {
    const std::string nobody(words_of(Holder::nobody));
    return walls_.nobody ? fmt::format("{} and with {}", nobody, words_of(Holder::user)) : nobody;
  }

  /// A doubtful region says so on the picture.
  [[nodiscard]] std::string title() const {
    const double filter = device_.parameters().wall.velocity_filter_hz;
    const auto filters = wall_filters_text(device_.parameters().wall);
    return fmt::format("Stable walls of {}, {}{}{}{}", display_name(device_), holders(),
                       filter > 0.0 ? fmt::format(", velocity filter {}", quantity(filter, "Hz")) : std::string(),
                       filters ? ", through " + *filters : std::string(), trust_mark(walls_.trust));
  }

  [[nodiscard]] std::vector<LegendEntry> legend() const {
    std::vector<LegendEntry> entries;
    const auto up_to = [&](std::string_view what, const BoundaryPoint& stiffest) {
      return fmt::format("{}: up to {} at {} {}", what, quantity(stiffest.stiffness, units_.stiffness),
                         number(stiffest.damping), units_.damping);
    };
    // Which walls a passive user destabilises is not always known.
    const bool users_unknown = !walls_.any_user || (has_damper_loop(device_.loop()) && walls_.any_user->is_bound);
    const std::string stable = users_unknown ? holders() : std::string(words_of(WallStability::alone_only));
    if (walls_.shared) {
      if (walls_.shared->stiffest) {
        entries.push_back({up_to(stable, walls_.shared->stiffest->point), {region_colour, 2.0, "1"}, region_colour});
      } else {
        entries.push_back({"no wall is stable with both", {}, {}});
      }
      if (walls_.nobody->region.stiffest) {
        entries.push_back({up_to(words_of(Holder::nobody), *walls_.nobody->region.stiffest), boundary_style, {}});
      }
      if (walls_.region.stiffest) {
        entries.push_back({up_to(words_of(Holder::user), *walls_.region.stiffest), held_style, {}});
      }
    } else if (walls_.region.stiffest) {
      entries.push_back({up_to(stable, *walls_.region.stiffest), boundary_style, region_colour});
    } else {
      entries.push_back({walls_.trust.refused()  ? "refused: no region is given"
                         : walls_.region.bounded ? "no wall is stable"
                                                 : "every wall is stable",
                         boundary_style,
                         {}});
    }
    if (walls_.any_user && walls_.any_user->stiffest) {
      entries.push_back({fmt::format("{}: up to {}", words_of(WallStability::anyone),
                                     quantity(walls_.any_user->stiffest->stiffness, units_.stiffness)),
                         any_user_style, any_user_colour});
    }
    if (one_rate_) {
      const double period = std::max(device_.loop().sampling_period, damper_timing(device_.loop()).sampling_period);
      const std::string what = fmt::format("both at {}", quantity(1.0 / period, "Hz"));
      entries.push_back(
          {one_rate_->stiffest
               ? up_to(what, *one_rate_->stiffest)
               : fmt::format("{}: {}", what, one_rate_->bounded ? "no wall is stable" : "every wall is stable"),
           one_rate_style,
           {}});
    }
    if (recommended_) {
      const double filter = recommended_->velocity_filter_hz;
      entries.push_back({fmt::format("recommended: {} at {} {}{}", quantity(*recommended_->stiffness, units_.stiffness),
                                     number(recommended_->damping), units_.damping,
                                     filter > 0.0 ? ", velocity filter " + quantity(filter, "Hz") : std::string()),
                         {},
                         {},
                         std::string(recommended_marker)});
    }
    for (const ComparedApproximation& each : walls_.approximations) {
      const auto& ratio = each.error.ratio;
      const std::string off = ratio ? fmt::format(" ({:+.1f} dB at B = 0)", decibels(*ratio)) : std::string();
      entries.push_back({std::string(facts_of(each.formula.formula).name) + off,
                         style_of(each.formula.formula),
                         {},
                         each.formula.largest_damping == 0.0 ? point_marker(each.formula.formula) : std::string()});
    }
    return entries;
  }

  /// The whole region, and the corner at the origin where formulas, K_CR and one loop would be too small to see.
  [[nodiscard]] std::vector<Extent> extents() const {
    constexpr double margin = 1.06;
    constexpr double too_small = 0.2;
    const StableRegion& region = walls_.region;
    if (!region.stiffest) return {{1.0, 1.0}};
    Extent whole{margin * region.most_damped->damping, margin * region.stiffest->stiffness};
    double critical = region.critical_stiffness;
    const auto hold = [&](const StableRegion& other) {
      whole = {std::max(whole.damping, margin * other.most_damped->damping),
               std::max(whole.stiffness, margin * other.stiffest->stiffness)};
    };
    if (one_rate_ && one_rate_->stiffest) hold(*one_rate_);
    if (walls_.nobody && walls_.nobody->region.stiffest) {
      hold(walls_.nobody->region);
      critical = std::min(critical, walls_.nobody->region.critical_stiffness);
    }
    Extent corner{0.0, std::isfinite(critical) ? critical : 0.0};
    for (const ComparedApproximation& each : walls_.approximations) {
      corner.stiffness = std::max(corner.stiffness, each.formula.at_zero_damping);
      corner.damping = std::max(corner.damping, each.formula.largest_damping.value_or(0.0));
    }
    if (one_rate_ && one_rate_->stiffest) {
      corner = {std::max(corner.damping, one_rate_->most_damped->damping),
                std::max(corner.stiffness, one_rate_->stiffest->stiffness)};
    }
    corner = {2.0 * corner.damping, 2.0 * corner.stiffness};
    const bool shown = corner.damping > too_small * whole.damping && corner.stiffness > too_small * whole.stiffness;
    if (shown || corner.damping == 0.0 || corner.stiffness == 0.0) return {whole};
    return {whole, {std::min(corner.damping, whole.damping), std::min(corner.stiffness, whole.stiffness)}};
  }

  static std::string row(double damping, double stiffness) {
    return fmt::format("{:.9g} {:.9g}\n", damping, stiffness);
  }

  static std::string rows(const std::vector<Place>& places) {
    std::string text;
    for (const Place& each : places) text += row(each.damping, each.stiffness);
    return text + "\n";
  }

  static std::vector<std::vector<Place>> outlines_within(const StableRegion& region, const Extent& extent) {
    std::vector<std::vector<Place>> outlines;
    for (const StableComponent& component : region.components) {
      std::vector<Place> outline;
      for (const BoundaryArc& arc : component.outline.arcs) {
        for (const BoundaryPoint& point : arc.points) outline.push_back({point.damping, point.stiffness});
      }
      if (std::vector<Place> shown = within(outline, extent); !shown.empty()) outlines.push_back(std::move(shown));
    }
    return outlines;
  }

  /// All of the panel but what lies in the outlines, as one closed line: around the panel against the sense of the outlines,
  /// with a cut to each.
  static std::vector<Place> rest_of(const std::vector<std::vector<Place>>& outlines, const Extent& extent) {
    std::vector<Place> rest{
        {0.0, 0.0}, {extent.damping, 0.0}, {extent.damping, extent.stiffness}, {0.0, extent.stiffness}, {0.0, 0.0}};
    for (const std::vector<Place>& outline : outlines) {
      rest.insert(rest.end(), outline.begin(), outline.end());
      rest.push_back(outline.front());
      rest.push_back({0.0, 0.0});
    }
    return rest;
  }

  /// Down to K = 0 at either end.
  static std::vector<Place> outline_of(const std::vector<AbsoluteStabilityPoint>& range) {
    std::vector<Place> outline{{range.front().damping, 0.0}};
    for (const AbsoluteStabilityPoint& point : range) outline.push_back({point.damping, point.stiffness});
    outline.push_back({range.back().damping, 0.0});
    return outline;
  }

  /// The boundary without the axes.
  static std::string edge_rows(const StableRegion& region) {
    std::string edges;
    for (const StableComponent& component : region.components) {
      for (const BoundaryArc& arc : component.outline.arcs) {
        if (arc.kind == BoundaryKind::no_stiffness || arc.kind == BoundaryKind::no_damping) continue;
        for (const BoundaryPoint& point : arc.points) edges += row(point.damping, point.stiffness);
        edges += "\n";
      }
    }
    return edges;
  }

  [[nodiscard]] std::string formula_rows(const RegionApproximation& formula) const {
    const double end = formula.largest_damping.value_or(2.0 * walls_.region.most_damped->damping);
    const std::string first = row(0.0, formula.at_zero_damping);
    return end > 0.0 ? first + row(end, formula.at_zero_damping + formula.slope * end) : first;
  }

  [[nodiscard]] Panel panel(const Extent& extent) const {
    const AxisUnit unit = axis_unit(extent.stiffness, 3.0);
    const AxisUnit damping = axis_unit(extent.damping, 1.0);
    Panel panel{
        .above = 28.0,
        .height = panel_height,
        .axes = fmt::format("set grid front\nset xrange [0:{:.9g}]\nset yrange [0:{:.9g}]\nset xtics autofreq\nset "
                            "ytics autofreq",
                            extent.damping / damping.size, extent.stiffness / unit.size),
        .x_label = fmt::format("Virtual damping B ({}{})", damping.prefix, units_.damping),
        .y_label = fmt::format("Stiffness K ({}{})", unit.prefix, units_.stiffness)};
    const auto add = [&](std::string rows, std::string with) {
      panel.series.push_back(
          {std::move(rows), std::move(with), fmt::format("($1/{:g}):($2/{:g})", damping.size, unit.size)});
    };
    const auto add_area = [&](const std::string& rows, std::string_view colour) {
      add(rows, fmt::format("filledcurves closed fc rgb '{}' fs solid noborder", colour));
    };
    std::string outlines;
    for (const std::vector<Place>& each : outlines_within(walls_.region, extent)) outlines += rows(each);
    add_area(outlines, region_colour);
    if (walls_.nobody && walls_.nobody->region.bounded) {
      add_area(rows(rest_of(outlines_within(walls_.nobody->region, extent), extent)), "white");
    }
    if (walls_.any_user && walls_.any_user->stiffest) {
      std::string filled;
      std::string limits;
      for (const auto& range : walls_.any_user->ranges) {
        filled += rows(within(outline_of(range), extent));
        limits += rows(outline_of(range));
      }
      add_area(filled, any_user_colour);
      add(limits, as_lines(any_user_style));
    }
    add(edge_rows(walls_.region), as_lines(walls_.nobody ? held_style : boundary_style));
    if (walls_.nobody) add(edge_rows(walls_.nobody->region), as_lines(boundary_style));
    if (one_rate_) add(edge_rows(*one_rate_), as_lines(one_rate_style));
    if (recommended_) add(row(recommended_->damping, *recommended_->stiffness), as_points(recommended_marker));
    for (const ComparedApproximation& each : walls_.approximations) {
      const Formula formula = each.formula.formula;
      add(formula_rows(each.formula),
          each.formula.largest_damping == 0.0 ? as_points(point_marker(formula)) : as_lines(style_of(formula)));
    }
    return panel;
  }

  const Device& device_;
  const WallRegion& walls_;
  const std::optional<Wall>& recommended_;
  const StableRegion* one_rate_;  // with nobody holding
  Units units_;
};

}  // namespace

std::string draw_region(const Device& device, const WallRegion& walls, FigureFormat format,
                        const std::optional<Wall>& recommended, const WallRegion* one_rate) {
  return RegionFigure(device, walls, recommended, one_rate).draw(format);
}

}  // namespace zwidth::report

#include <fmt/format.h>

#include <numbers>

#include "report/text/design_text.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_filter_text.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::report {
namespace {

std::string bound_text(WallBound bound) {
  switch (bound) {
    case WallBound::none:
      return "nothing: more gains nothing";
    case WallBound::any_user:
      return "the gain margin with some passive user";
    case WallBound::gain_margin:
      return "the gain margin";
    case WallBound::phase_margin:
      return "the phase margin";
    case WallBound::quantisation_force:
      return "the force per encoder count";
    case WallBound::contact_damping:
      return "the contact would swing";
    case WallBound::uncertainty:
      return "how well the device is known";
    case WallBound::modal_frequency_uncertainty:
      return "the drift of its modes";
  }
  return "";
}

std::string short_text(WallBound bound) {
  switch (bound) {
    case WallBound::none:
      return "-";
    case WallBound::any_user:
      return "any user";
    case WallBound::gain_margin:
      return "gain";
    case WallBound::phase_margin:
      return "phase";
    case WallBound::quantisation_force:
      return "ripple";
    case WallBound::contact_damping:
      return "contact";
    case WallBound::uncertainty:
      return "uncertainty";
    case WallBound::modal_frequency_uncertainty:
      return "drift";
  }
  return "";
}

std::string goal_text(WallGoal goal) {
  if (goal == WallGoal::width) return "greatest K B";
  if (goal == WallGoal::damper) return "a damper alone (K = 0), strongest in motions of 10 Hz";
  return goal == WallGoal::stiffness ? "greatest K" : "greatest K whose contact does not swing";
}

class RecommendationWriter {
 public:
  RecommendationWriter(const Device& device, const RecommendationOptions& options, const WallRecommendation& answer)
      : device_(device), options_(options), answer_(answer), units_(units_of(device.parameters().motion)) {}

  [[nodiscard]] std::string text() const {
    std::string text = shortened(display_name(device_), line_width) + "\n";
    if (const auto note = trust_note(answer_.trust)) text += labelled("  trust", *note);
    if (answer_.trust.refused()) return text;
    text += labelled("  asked for", asked());
    if (!answer_.wall) {
      text += labelled("  no wall", zwidth::text(answer_.reason));
    } else {
      text += wall_lines(*answer_.wall);
    }
    for (const Remark& remark : answer_.remarks) text += bulleted(remark_line(remark));
    if (!answer_.wall) return text;
    if (!answer_.alternatives.empty()) text += "\n" + trade_off();
    if (answer_.drive_damper) {
      text += "\nThe damper on the drive, with the same margins\n" + bulleted(zwidth::text(answer_.drive_damper->why));
    }
    text += "\nFor the device file\n" + for_the_file(answer_.wall->wall);
    return text +
           wrap(
               "\nA local optimum, found by search; every wall here is computed exactly, and its poles are counted "
               "by a second computation, alone and with users. Friction and the force limit are left out.",
               line_width, 0);
  }

 private:
  [[nodiscard]] std::string stiffness(double value) const { return quantity(value, units_.stiffness); }
  [[nodiscard]] std::string damping(double value) const { return fmt::format("{} {}", number(value), units_.damping); }
  [[nodiscard]] static std::string degrees(double angle) {
    return fmt::format("{:.3g} degrees", angle * 180.0 / std::numbers::pi);
  }

  [[nodiscard]] std::string asked() const {
    const bool any_user = !answer_.wall || answer_.wall->absolute_stability_limit;
    const bool is_damper = options_.goal == WallGoal::damper;
    std::string text =
        fmt::format("{}; gain margin {:.3g} dB {} {}, phase margin {}", goal_text(options_.goal),
                    decibels(options_.gain_margin), is_damper ? "of B" : "of K alone and of the whole force",
                    any_user ? "with any passive user" : "of the device as it is", degrees(options_.phase_margin));
    if (options_.quantisation_force)
      text += fmt::format(", at most {} per encoder count", quantity(*options_.quantisation_force, units_.force));
    if (options_.modal_frequency_uncertainty > 0.0) {
      text += fmt::format(", at {} drifts of the modes by up to {:.3g} %", answer_.modal_shifts_checked,
                          100.0 * options_.modal_frequency_uncertainty);
    }
    return text;
  }

  [[nodiscard]] std::string wall_lines(const RecommendedWall& each) const {
    const Wall& wall = each.wall;
    const WallBounds& bounds = each.bounded_by;
    std::string text;
    if (options_.goal == WallGoal::damper) {
      text = labelled("  damping B", fmt::format("{}, without a spring (K = 0); bounded by {}", damping(wall.damping),
                                                 bound_text(bounds.damping.value_or(WallBound::none))));
    } else {
      text = labelled("  stiffness K",
                      fmt::format("{}; bounded by {}", stiffness(*wall.stiffness), bound_text(bounds.stiffness)));
      text += labelled("  damping B", fmt::format("{}; with more: {}", damping(wall.damping),
                                                  bound_text(bounds.damping.value_or(WallBound::none))));
    }
    std::string filter = wall.velocity_filter_hz > 0.0 ? quantity(wall.velocity_filter_hz, "Hz") : std::string("none");
    if (bounds.velocity_filter) filter += fmt::format("; with a faster one: {}", bound_text(*bounds.velocity_filter));
    text += labelled("  velocity filter", filter);
    if (const auto filters = wall_filters_text(wall)) text += labelled("  filters", *filters);
    text += labelled("  margins", margins(each));
    if (each.absolute_stability_damping_limit) {
      text +=
          labelled("  any passive user", fmt::format("B up to {}", damping(*each.absolute_stability_damping_limit)));
    } else if (each.absolute_stability_limit) {
      text += labelled("  any passive user",
                       fmt::format("K up to {} with this damper", stiffness(*each.absolute_stability_limit)));
    }
    if (each.contact_damping_ratio) {
      text += labelled("  damping of contact",
                       fmt::format("{:.3g} of critical, nobody holding", *each.contact_damping_ratio));
    }
    if (each.force_per_count) {
      const ForcePerCount& force = *each.force_per_count;
      text += labelled("  force per count",
                       fmt::format("{}: K q = {}, damper {}", quantity(force.largest, units_.force),
                                   quantity(force.stiffness, units_.force), quantity(force.damping, units_.force)));
    }
    return text;
  }

  [[nodiscard]] std::string margins(const RecommendedWall& each) const {
    const auto gain = [](const std::optional<double>& margin) {
      return margin ? fmt::format("{:.3g} dB", decibels(*margin)) : std::string("no limit");
    };
    if (*each.wall.stiffness == 0.0) {
      return fmt::format("B {}, phase {}", gain(each.margins.gain_margin),
                         each.margins.phase_margin ? degrees(*each.margins.phase_margin) : std::string("no limit"));
    }
    if (has_damper_loop(device_.loop()) && each.wall.damping > 0.0) {
      return fmt::format("K alone {}, phase of its force {}", gain(each.margins.stiffness_margin),
                         each.margins.phase_margin ? degrees(*each.margins.phase_margin) : std::string("no limit"));
    }
    return fmt::format("whole force {}, K alone {}, phase {}", gain(each.margins.gain_margin),
                       gain(each.margins.stiffness_margin),
                       each.margins.phase_margin ? degrees(*each.margins.phase_margin) : std::string("no limit"));
  }

  [[nodiscard]] std::vector<std::string> row(const RecommendedWall& each) const {
    const WallMargins& margins = each.margins;
    return {std::string(words_of(each.kind)),
            stiffness(*each.wall.stiffness),
            number(each.wall.damping),
            each.wall.velocity_filter_hz > 0.0 ? quantity(each.wall.velocity_filter_hz, "Hz") : "-",
            each.notch ? quantity(each.notch->frequency_hz, "Hz") : "-",
            margins.gain_margin ? fmt::format("{:.3g} dB", decibels(*margins.gain_margin)) : "-",
            margins.phase_margin ? fmt::format("{:.3g}°", *margins.phase_margin * 180.0 / std::numbers::pi) : "-",
            each.force_per_count ? quantity(each.force_per_count->largest, units_.force) : "-",
            short_text(options_.goal == WallGoal::damper ? each.bounded_by.damping.value_or(WallBound::none)
                                                         : each.bounded_by.stiffness)};
  }

  [[nodiscard]] std::string trade_off() const {
    TextTable table{{Align::left, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right,
                     Align::right, Align::left},
                    {{"", "K", "B", "filter", "notch", "gain", "phase", "per count",
                      options_.goal == WallGoal::damper ? "B bounded by" : "K bounded by"}}};
    table.rows.push_back(row(*answer_.wall));
    for (const RecommendedWall& each : answer_.alternatives) table.rows.push_back(row(each));
    return "The trade-off: other walls that keep what is asked\n" + layout(table);
  }

  [[nodiscard]] std::string for_the_file(const Wall& wall) const {
    std::string text = fmt::format("  [wall]\n  stiffness = {}\n  damping = {}\n", *wall.stiffness, wall.damping);
    if (wall.velocity_filter_hz > 0.0) text += fmt::format("  velocity_filter_hz = {}\n", wall.velocity_filter_hz);
    if (answer_.wall->notch) {
      const WallFilter& notch = *answer_.wall->notch;
      text += fmt::format(
          "  [[wall.filter]]\n  type = \"notch\"\n  frequency_hz = {}\n  damping_ratio = {}\n  depth = {}\n",
          notch.frequency_hz, notch.damping_ratio, notch.depth);
    }
    return text;
  }

  const Device& device_;
  const RecommendationOptions& options_;
  const WallRecommendation& answer_;
  Units units_;
};

}  // namespace

std::string wall_recommendation_text(const Device& device, const RecommendationOptions& options,
                                     const WallRecommendation& recommendation) {
  return RecommendationWriter(device, options, recommendation).text();
}

}  // namespace zwidth::report

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "report/text/design_text.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t modal_shifts_shown = 9;

class NotchWriter {
 public:
  NotchWriter(const Device& device, const NotchOptions& options, const NotchDesign& notch)
      : device_(device), options_(options), design_(notch), units_(units_of(device.parameters().motion)) {}

  [[nodiscard]] std::string text() const {
    std::string text = shortened(display_name(device_), line_width) + "\n";
    if (const auto trust = trust_note(design_.trust)) text += wrap(*trust, line_width, 22).replace(0, 7, "  trust");
    if (design_.trust.refused()) return text;
    for (const Remark& remark : design_.remarks) text += wrap(remark_line(remark), line_width, 4).replace(0, 4, "  ! ");
    if (!std::isfinite(design_.without)) {
      return text + wrap("Every wall is stable without a notch: there is nothing to gain.", line_width, 0);
    }
    if (!design_.notch) return text + wrap(no_notch(), line_width, 0);
    const WallFilter& notch = *design_.notch;
    text += fmt::format("  notch               {:.4g} Hz, damping ratio {:.3g}, depth {:.3g} ({:.3g} dB)\n",
                        notch.frequency_hz, notch.damping_ratio, notch.depth, decibels(notch.depth));
    const std::string without = design_.without > 0.0
                                    ? fmt::format("{} without ({:+.3g} %)", quantity(design_.without, units_.stiffness),
                                                  100.0 * (design_.with / design_.without - 1.0))
                                    : std::string("none without");
    text += fmt::format("  stiffest wall       {} with it, {}\n", quantity(design_.with, units_.stiffness), without);
    text += fmt::format("  that is             {}\n\n", what_is_promised());
    text += "For the device file\n" + for_the_file() + "\n";
    if (design_.over_modal_shift.size() > 1) text += over_modal_shift() + "\n";
    text += costs() + "\n";
    return text + wrap(fmt::format("Below its centre the notch delays the force by {}: a wall of {} feels {} {} less "
                                   "damped. Found by search: a local optimum, verified over the whole drift.",
                                   quantity(design_.low_frequency_delay, "s"), quantity(design_.with, units_.stiffness),
                                   number(design_.with * design_.low_frequency_delay), units_.damping),
                       line_width, 0);
  }

 private:
  [[nodiscard]] const char* goal() const {
    return options_.goal == StiffnessGoal::absolute_stability_limit ? "limit with any passive user"
                                                                    : "critical stiffness";
  }

  [[nodiscard]] std::string what_is_promised() const {
    std::string text = fmt::format("the least {}", goal());
    if (options_.modal_frequency_uncertainty > 0.0) {
      text += fmt::format(" while the modes drift by up to {:.3g} %", 100.0 * options_.modal_frequency_uncertainty);
    }
    if (options_.gain_margin > 1.0) text += fmt::format(", over {:.3g}", options_.gain_margin);
    if (options_.phase_margin > 0.0) {
      text += fmt::format(", {:.3g} degrees of phase left", options_.phase_margin * 180.0 / std::numbers::pi);
    }
    return text;
  }

  [[nodiscard]] std::string no_notch() const {
    if (design_.without == 0.0) {
      return fmt::format("No wall keeps what is asked for ({}), and no notch was found that changes that.",
                         what_is_promised());
    }
    const auto cause = what_limits({design_.state_without->device, design_.state_without->analysis});
    return fmt::format("No notch was found that makes the worst wall stiffer than {} without one: {}.{}",
                       quantity(design_.without, units_.stiffness), what_is_promised(),
                       cause ? " The device as it is is limited by " + *cause + "." : std::string());
  }

  [[nodiscard]] std::string for_the_file() const {
    const WallFilter& notch = *design_.notch;
    return fmt::format(
        "  [[wall.filter]]\n  type = \"notch\"\n  frequency_hz = {}\n  damping_ratio = {}\n  depth = {}\n",
        notch.frequency_hz, notch.damping_ratio, notch.depth);
  }

  [[nodiscard]] std::string over_modal_shift() const {
    TextTable table{{Align::right, Align::right, Align::right}, {{"modes", "without", "with the notch"}}};
    const std::size_t step = (design_.over_modal_shift.size() - 1) / (modal_shifts_shown - 1);
    for (std::size_t i = 0; i < design_.over_modal_shift.size(); i += step) {
      const NotchAtModalShift& each = design_.over_modal_shift[i];
      table.rows.push_back({fmt::format("{:+.3g} %", 100.0 * each.modal_shift),
                            quantity(each.without, units_.stiffness), quantity(each.with, units_.stiffness)});
    }
    return "Stiffest wall over the drift\n" + layout(table);
  }

  [[nodiscard]] static std::string margins(const Analysis& analysis) {
    const WallMargins& wall = *analysis.wall;
    if (!wall.stable) return "UNSTABLE";
    return fmt::format("{}, {}",
                       wall.gain_margin ? fmt::format("{:.3g} dB", decibels(*wall.gain_margin)) : std::string("none"),
                       wall.phase_margin ? fmt::format("{:.3g} deg", *wall.phase_margin * 180.0 / std::numbers::pi)
                                         : std::string("none"));
  }

  [[nodiscard]] std::vector<std::string> column(const Analysis& analysis) const {
    const CriticalStiffness& critical = analysis.critical;
    return {quantity(critical.stiffness, units_.stiffness),
            critical.limit ? oscillator_name(analysis, critical.limit->limited_by) : "-",
            critical.limit ? quantity(hertz(critical.limit->frequency), "Hz") : "-",
            analysis.any_user ? quantity(analysis.any_user->stiffness, units_.stiffness) : "-",
            analysis.wall ? margins(analysis) : "-"};
  }

  [[nodiscard]] std::string costs() const {
    const std::vector<std::string> names{
        "critical stiffness", "limited by", "at", "any passive user",
        fmt::format("margins of a wall of {}", quantity(design_.with, units_.stiffness))};
    const std::vector<std::string> without = column(design_.state_without->analysis);
    const std::vector<std::string> with = column(design_.state_with->analysis);
    TextTable table{{Align::left, Align::left, Align::left}, {{"", "without", "with the notch"}}};
    for (std::size_t i = 0; i < names.size(); ++i) table.rows.push_back({names[i], without[i], with[i]});
    return "What it changes on the device as it is\n" + layout(table);
  }

  const Device& device_;
  const NotchOptions& options_;
  const NotchDesign& design_;
  Units units_;
};

}  // namespace

std::string notch_text(const Device& device, const NotchOptions& options, const NotchDesign& notch) {
  return NotchWriter(device, options, notch).text();
}

}  // namespace zwidth::report

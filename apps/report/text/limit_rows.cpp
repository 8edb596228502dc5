#include "report/text/limit_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_medium.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t title_width = 92;
constexpr std::size_t label_gap = 3;
constexpr std::size_t hint_gap = 7;
constexpr std::size_t narrowest_answer = 30;

class LimitTable {
 public:
  explicit LimitTable(const AnalysedDevice& analysed)
      : analysed_(analysed), analysis_(analysed.analysis), units_(units_of(analysed.device.parameters().motion)) {}

  [[nodiscard]] std::vector<LimitRow> rows() {
    add_springs();
    if (shows_dampers()) add_dampers();
    add_walls();
    return std::move(rows_);
  }

 private:
  /// `what` only in the first row of its group.
  void add(std::string what, Holder holder, std::string answer, std::string hint = "") {
    if (!rows_.empty() && group_ == what) {
      what.clear();
    } else {
      group_ = what;
    }
    rows_.push_back({std::move(what), std::string(words_of(holder)), std::move(answer), std::move(hint)});
  }

  [[nodiscard]] std::string stiffness(double value) const { return quantity(value, units_.stiffness); }
  [[nodiscard]] std::string damping(double value) const { return fmt::format("{} {}", number(value), units_.damping); }

  /// "then shakes at 6.143 Hz: the rigid body and the sampling delay of T/2 = 500 us"
  [[nodiscard]] std::string then_what(const AnalysedDevice& held, const Oscillator& oscillator,
                                      double frequency) const {
    const double nyquist = std::numbers::pi / analysed_.device.loop().sampling_period;
    const std::string cause = what_turns_unstable(held.device, oscillator_name(held.analysis, oscillator), frequency);
    if (frequency == 0.0) return "then drifts away: " + cause;
    return fmt::format("then shakes at {}{}: {}", quantity(hertz(frequency), "Hz"),
                       frequency < nyquist ? "" : " (Nyquist)", cause);
  }

  [[nodiscard]] std::string spring_text(const AnalysedDevice& held, const CriticalStiffness& critical) const {
    switch (critical.status) {
      case StiffnessStatus::finite:
        if (!critical.limit) return stiffness(critical.stiffness);
        return fmt::format("{}, {}", stiffness(critical.stiffness),
                           then_what(held, critical.limit->limited_by, critical.limit->frequency));
      case StiffnessStatus::refused:
        return "no number is given";
      default:
        return critical_stiffness_text(critical, held.device.parameters().motion);
    }
  }

  void add_springs() {
    const Wall& wall = analysed_.device.parameters().wall;
    const std::string what = wall.damping > 0.0 ? "spring, B = " + number(wall.damping) : std::string("spring alone");
    const AnalysedDevice alone = with_nobody_holding(analysed_);
    add(what, Holder::nobody, spring_text(alone, alone.analysis.critical));
    if (analysis_.limits.user) add(what, Holder::user, spring_text(analysed_, analysis_.critical));
    if (const auto limit = absolute_stability_note(analysed_)) add(what, Holder::any_user, *limit);
  }

  [[nodiscard]] bool shows_dampers() const {
    const bool has_no_spring = analysis_.wall && analysis_.wall->stiffness == 0.0;
    return analysed_.device.parameters().motion == Motion::rotary || has_no_spring ||
           analysis_.limits.nobody.critical_stiffness == 0.0;
  }

  [[nodiscard]] std::string damper_text(const AnalysedDevice& held, const HolderLimit& limit) const {
    const double largest = *limit.critical_damping;
    if (largest == 0.0) return "none: every damper is unstable, however small";
    if (std::isinf(largest)) return "unbounded: every damper is stable";
    std::string text = "up to B = " + damping(largest);
    if (!limit.damping_frequency) return text;
    if (limit.damping_limited_by) {
      return fmt::format("{}, {}", text, then_what(held, *limit.damping_limited_by, *limit.damping_frequency));
    }
    return *limit.damping_frequency == 0.0
               ? text
               : fmt::format("{}, worst at {}", text, quantity(hertz(*limit.damping_frequency), "Hz"));
  }

  void add_dampers() {
    const std::string what = "damper alone";
    const HoldingLimits& limits = analysis_.limits;
    if (limits.nobody.critical_damping) {
      add(what, Holder::nobody, damper_text(with_nobody_holding(analysed_), limits.nobody));
    }
    if (limits.user && limits.user->critical_damping) add(what, Holder::user, damper_text(analysed_, *limits.user));
    if (limits.any_user && limits.any_user->critical_damping) {
      add(what, Holder::any_user, damper_text(analysed_, *limits.any_user));
    }
  }

  [[nodiscard]] std::string damped_text(const WallSummary& walls) const {
    if (!walls.with_damper) return "left out: " + text(walls.why_no_damper);
    const StiffestDampedWall& wall = *walls.with_damper;
    if (wall.stiffness == 0.0) return "none: no wall is stable, with any damper tried";
    if (std::isinf(wall.stiffness)) return "unbounded with B = " + damping(wall.damping);
    if (wall.damping == 0.0) {
      return fmt::format("up to {}: no damper raises it{}", stiffness(wall.stiffness), trust_mark(wall.trust));
    }
    std::string text = fmt::format("up to {} with B = {}", stiffness(wall.stiffness), damping(wall.damping));
    if (wall.velocity_filter_hz > 0.0) {
      text += fmt::format(", velocity filter {}", quantity(wall.velocity_filter_hz, "Hz"));
    }
    return text + std::string(trust_mark(wall.trust));
  }

  [[nodiscard]] std::string margins_text(const WallSummary& walls) const {
    if (!walls.with_margins) return "left out: " + text(walls.why_no_margins);
    const RecommendedWall& found = *walls.with_margins;
    std::string text = stiffness(*found.wall.stiffness);
    text += found.wall.damping > 0.0 ? ", B = " + damping(found.wall.damping) : std::string(", no damper");
    if (found.wall.velocity_filter_hz > 0.0) {
      text += fmt::format(", velocity filter {}", quantity(found.wall.velocity_filter_hz, "Hz"));
    }
    if (found.notch) text += fmt::format(", notch at {}", quantity(found.notch->frequency_hz, "Hz"));
    return text;
  }

  void add_walls() {
    if (!analysed_.walls) return;
    const WallSummary& walls = *analysed_.walls;
    const Holder holder = analysed_.device.is_mechanical() ? Holder::any_user : Holder::nobody;
    add("with a damper", holder, damped_text(walls), walls.with_damper ? "" : "zwidth region FILE");
    add("with margins", holder, margins_text(walls), "zwidth design FILE --recommend");
  }

  const AnalysedDevice& analysed_;
  const Analysis& analysis_;
  Units units_;
  std::string group_;
  std::vector<LimitRow> rows_;
};

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text;
}

std::string title_line(const AnalysedDevice& analysed) {
  const Trust& trust = analysed.analysis.trust;
  const std::string_view verdict = trust.sound() ? "sound" : trust.refused() ? "REFUSED" : "DOUBTFUL";
  const std::size_t of_medium = text_medium().line_length;
  const std::size_t width = of_medium > 0 ? std::min(of_medium, title_width) : title_width;
  const std::size_t room = width - verdict.size() - 2;
  const std::string name = for_medium(shortened(display_name(analysed.device), room));
  const std::string gap(room + 2 - std::min(width_of(name), room), ' ');
  return fmt::format("{}{}{}\n", name, gap, verdict);
}

}  // namespace

std::vector<LimitRow> limit_rows(const AnalysedDevice& analysed) {
  return analysed.analysis.trust.refused() ? std::vector<LimitRow>() : LimitTable(analysed).rows();
}

std::string limit_lines(const AnalysedDevice& analysed) {
  const std::vector<LimitRow> rows = limit_rows(analysed);
  std::size_t what_width = 0;
  std::size_t holder_width = 0;
  for (const LimitRow& row : rows) {
    what_width = std::max(what_width, row.what.size());
    holder_width = std::max(holder_width, row.holder.size());
  }
  std::string text = title_line(analysed);
  const std::size_t of_medium = text_medium().line_length;
  const std::size_t width = of_medium > 0 ? of_medium : line_width;
  for (const LimitRow& row : rows) {
    std::string label = "  " + padded(row.what, what_width + label_gap) + padded(row.holder, holder_width + label_gap);
    std::string line;
    if (label.size() + narrowest_answer <= width) {
      line = labelled(label, row.answer, label.size());
    } else {  // a narrow terminal
      text += label.substr(0, label.find_last_not_of(' ') + 1) + "\n";
      label.resize(label_gap + 1);
      line = wrap(row.answer, width, label.size());
    }
    if (!row.hint.empty()) {
      const std::size_t last = line.rfind('\n', line.size() - 2);
      const std::size_t used = width_of(last == std::string::npos ? line : line.substr(last + 1));
      if (used + hint_gap + row.hint.size() <= width) {
        line.insert(line.size() - 1, std::string(hint_gap, ' ') + row.hint);
      } else {
        line += std::string(label.size(), ' ') + row.hint + "\n";
      }
    }
    text += line;
  }
  return text;
}

}  // namespace zwidth::report

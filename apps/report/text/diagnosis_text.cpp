#include "report/text/diagnosis_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/model/mechanism_key.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t cause_indent = 16;

std::string cause_text(OscillationCause cause) {
  switch (cause) {
    case OscillationCause::device:
      return "the device itself, nobody holding";
    case OscillationCause::with_user:
      return "the device with its user";
    case OscillationCause::passive_user:
      return "the grasp of a user";
    case OscillationCause::quantisation:
      return "the steps of the encoder";
    case OscillationCause::friction:
      return "dry friction";
  }
  return "";
}

std::string line(std::string_view label, std::string_view content) {
  return labelled(fmt::format("  {}", label), content, cause_indent);
}

std::string oscillator_text(const std::optional<Oscillator>& oscillator) {
  if (!oscillator) return "";
  return oscillator->kind == Oscillator::Kind::rigid_body ? " (rigid body)"
                                                          : fmt::format(" (vibration mode {})", oscillator->mode);
}

std::string value_text(const DiagnosisChange& change, double value, Motion motion) {
  if (change.key == "wall.filter" || change.key == "wall.velocity_filter_hz")
    return value > 0.0 ? quantity(value, "Hz") : "none";
  return parameter_text(change.key == "body.*.damping" ? "wall.damping" : change.key, value, motion);
}

/// "13 % lower", "2.5 times higher"; from how many times on a percentage is no help.
std::string moved_text(double factor) {
  const std::string_view way = factor < 1.0 ? "lower" : "higher";
  const double larger = std::max(factor, 1.0 / factor);
  return larger < 2.0 ? fmt::format("{:.2g} % {}", 100.0 * std::abs(factor - 1.0), way)
                      : fmt::format("{:.2g} times {}", larger, way);
}

/// What would have to be otherwise for it to fit: "it fits where its limit is 13 % lower, 5 kN/m".
std::string otherwise_text(const OscillationCandidate& candidate, const Units& units) {
  const OtherwiseNeeded& needed = *candidate.otherwise;
  std::vector<std::string> parts;
  if (needed.limit != 1.0) {
    parts.push_back(fmt::format("its limit is {}", moved_text(needed.limit)));
    if (candidate.stiffness) parts.back() += ", " + quantity(needed.limit * *candidate.stiffness, units.stiffness);
    if (candidate.damping)
      parts.back() += fmt::format(", {} {}", number(needed.limit * *candidate.damping), units.damping);
  }
  if (needed.frequency != 1.0) {
    parts.push_back(fmt::format("its frequency is {}, {} instead of {}", moved_text(needed.frequency),
                                quantity(hertz(needed.frequency * candidate.frequency), "Hz"),
                                quantity(hertz(candidate.frequency), "Hz")));
  }
  if (needed.amplitude != 1.0) parts.push_back(fmt::format("its swing is {}", moved_text(needed.amplitude)));
  if (parts.empty()) return "it fits where the user lets go";
  return fmt::format("it fits where {}", fmt::join(parts, " and "));
}

std::string why_text(const OscillationCandidate& candidate, const Units& units) {
  const std::string why = text(candidate.why);
  return candidate.otherwise ? fmt::format("{}; {}", why, otherwise_text(candidate, units)) : why;
}

/// Limits of a table of changes as numbers without their unit, which stands above it.
class LimitScale {
 public:
  explicit LimitScale(const Device& device, const Diagnosis& diagnosis)
      : is_damper_(diagnosis.limit_of == WallNumber::damping) {
    const Units units = units_of(device.parameters().motion);
    double largest = 0.0;
    const auto take = [&largest](const std::optional<double>& limit) {
      if (limit && std::isfinite(*limit)) largest = std::max(largest, *limit);
    };
    take(diagnosis.absolute_stability_limit_now);
    for (const DiagnosisChange& each : diagnosis.changes)
      take(each.limit_then), take(each.absolute_stability_limit_then);
    constexpr double thousands = 1e4;
    if (!is_damper_ && largest >= thousands) scale_ = 1e3;
    unit_ = fmt::format("{}{}", scale_ > 1.0 ? "k" : "", is_damper_ ? units.damping : units.stiffness);
  }

  [[nodiscard]] std::string text(double limit) const {
    if (limit == 0.0) return "none";
    if (std::isnan(limit)) return "not known";
    return std::isfinite(limit) ? number(limit / scale_) : std::string("no limit");
  }
  [[nodiscard]] std::string with_unit(double limit) const {
    return limit == 0.0 || !std::isfinite(limit) ? text(limit) : fmt::format("{} {}", text(limit), unit_);
  }
  [[nodiscard]] const std::string& unit() const { return unit_; }
  [[nodiscard]] std::string heading() const { return is_damper_ ? "limit of B" : "limit of K"; }

 private:
  bool is_damper_;
  double scale_ = 1.0;
  std::string unit_;
};

/// The three words, of the wall after a change: whether it ends the oscillation, and for whom.
std::string end_text(const Diagnosis& diagnosis, const DiagnosisChange& change) {
  if (!change.ends_it) return "-";
  if (!*change.ends_it) return "no";
  if (!diagnosis.stiffness) return "yes";
  if (!change.absolute_stability_limit_then) return diagnosis.absolute_stability_limit_now ? "alone only" : "yes";
  const bool is_damper = diagnosis.limit_of == WallNumber::damping;
  const double now = is_damper ? diagnosis.damping : *diagnosis.stiffness;
  const double wall = change.key == (is_damper ? "wall.damping" : "wall.stiffness") ? change.value_then : now;
  return *change.absolute_stability_limit_then > wall ? "yes" : "alone only";
}

std::string changes_text(const Device& device, const Diagnosis& diagnosis) {
  const Motion motion = device.parameters().motion;
  const Units units = units_of(motion);
  const LimitScale limits(device, diagnosis);
  const bool by_amplitude = diagnosis.nearest == OscillationCause::quantisation;
  const bool judged = diagnosis.absolute_stability_limit_now && diagnosis.nearest != OscillationCause::passive_user;
  TextTable table{{Align::left, Align::right, Align::right, Align::right, Align::left},
                  {{"change", "now", "then", by_amplitude ? "swing" : limits.heading(), "ends it"}}};
  if (judged) {
    table.alignment.push_back(Align::right);
    table.rows.front().push_back("any user");
  }
  std::string lowering;
  for (const DiagnosisChange& each : diagnosis.changes) {
    std::string effect = "-";
    if (each.limit_then) effect = limits.text(*each.limit_then);
    if (by_amplitude && each.amplitude_then) effect = quantity(*each.amplitude_then, units.length);
    table.rows.push_back({words_of(each),
                          value_text(each, each.value_now, motion_of_key(device.parameters(), each.key)),
                          value_text(each, each.value_then, motion_of_key(device.parameters(), each.key)), effect,
                          end_text(diagnosis, each)});
    if (judged)
      table.rows.back().push_back(each.absolute_stability_limit_then ? limits.text(*each.absolute_stability_limit_then)
                                                                     : "-");
    if (!each.safe.value_or(true)) lowering += (lowering.empty() ? "" : ", ") + words_of(each);
  }
  std::string now;
  if (!diagnosis.changes.empty()) {
    const DiagnosisChange& first = diagnosis.changes.front();
    if (first.limit_now) now = fmt::format("{} now {}", limits.heading(), limits.with_unit(*first.limit_now));
    if (first.amplitude_now) now = fmt::format("swing now {}", quantity(*first.amplitude_now, units.length));
  }
  if (judged) {
    now += fmt::format("{}with any passive user {}", now.empty() ? "" : ", ",
                       limits.with_unit(*diagnosis.absolute_stability_limit_now));
  }
  if (!by_amplitude || judged) now += fmt::format("{}limits in {}", now.empty() ? "" : "; ", limits.unit());
  std::string text =
      "\n" + wrap(fmt::format("What moves it, each change alone and recomputed ({})", now), line_width, 0);
  text += layout(table);
  if (!lowering.empty()) {
    text += bulleted(fmt::format("lowers the limit with any passive user, or leaves it unknown: {}", lowering));
  }
  return text;
}

}  // namespace

std::string diagnosis_text(const Device& device, const Diagnosis& diagnosis) {
  const Units units = units_of(device.parameters().motion);
  std::string text = shortened(display_name(device), line_width) + "\n";
  if (const auto note = trust_note(diagnosis.trust)) text += line("trust", *note);
  if (diagnosis.trust.refused()) return text;
  const std::string damper = fmt::format("{} {}", number(diagnosis.damping), units.damping);
  const std::string stiffness =
      diagnosis.stiffness ? quantity(*diagnosis.stiffness, units.stiffness) : std::string("unknown stiffness");
  text += line(
      "oscillates",
      fmt::format(
          "at {}{}, {}", quantity(hertz(*diagnosis.frequency), "Hz"),
          diagnosis.amplitude ? fmt::format(" by {}", quantity(*diagnosis.amplitude, units.length)) : std::string(),
          diagnosis.limit_of == WallNumber::damping ? fmt::format("a damper of {} alone, K = 0", damper)
                                                    : fmt::format("wall of {} and {}", stiffness, damper)));
  if (diagnosis.nearest) {
    const OscillationCandidate& cause = diagnosis.candidates.front();
    text +=
        line("cause", fmt::format("{}{}{}: {}", diagnosis.cause ? "" : "none fits; the nearest is ",
                                  cause_text(cause.cause), oscillator_text(cause.limited_by), why_text(cause, units)));
  } else {
    text += line("cause", "none fits: nothing that is modelled here oscillates there with this wall");
  }
  for (const Remark& remark : diagnosis.remarks) text += bulleted(remark_line(remark));
  std::string others;
  for (std::size_t i = diagnosis.nearest ? 1 : 0; i < diagnosis.candidates.size(); ++i) {
    const OscillationCandidate& each = diagnosis.candidates[i];
    others +=
        bulleted(fmt::format("{}{}: {}", each.fits ? "possible: " : "", cause_text(each.cause), why_text(each, units)));
  }
  if (!others.empty()) text += (diagnosis.nearest ? "\nWhat else was looked at\n" : "\nWhat was looked at\n") + others;
  if (!diagnosis.changes.empty()) text += changes_text(device, diagnosis);
  return text;
}

}  // namespace zwidth::report

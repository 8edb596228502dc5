#include "report/text/diagnosis_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t cause_indent = 16;

std::string cause_text(OscillationCause cause) {
  switch (cause) {
    case OscillationCause::device:
      return "the device itself, nobody holding";
    case OscillationCause::with_operator:
      return "the device with its operator";
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
  return wrap(content, line_width, cause_indent).replace(0, 2 + label.size(), fmt::format("  {}", label));
}

std::string mechanism_text(const std::optional<Mechanism>& mechanism) {
  if (!mechanism) return "";
  return mechanism->kind == Mechanism::Kind::rigid_body ? " (rigid body)"
                                                        : fmt::format(" (vibration mode {})", mechanism->mode);
}

std::string value_text(const DiagnosisChange& change, double value, Motion motion) {
  if (change.key == "wall.filter" || change.key == "wall.velocity_filter_hz")
    return value > 0.0 ? quantity(value, "Hz") : "none";
  return parameter_text(change.key == "body.*.damping" ? "wall.damping" : change.key, value, motion);
}

std::string changes_text(const Device& device, const Diagnosis& diagnosis) {
  const Motion motion = device.parameters().motion;
  const Units units = units_of(motion);
  const bool by_amplitude = diagnosis.cause == OscillationCause::quantisation;
  TextTable table{{Align::left, Align::right, Align::right, Align::right, Align::left},
                  {{"change", "now", "then", by_amplitude ? "swing" : "limit of K", "ends it"}}};
  for (const DiagnosisChange& each : diagnosis.changes) {
    std::string effect = "-";
    if (each.limit_then)
      effect = std::isfinite(*each.limit_then) ? quantity(*each.limit_then, units.stiffness) : "no limit";
    if (by_amplitude && each.amplitude_then) effect = quantity(*each.amplitude_then, units.length);
    table.rows.push_back({each.what, value_text(each, each.value_now, motion),
                          value_text(each, each.value_then, motion), effect,
                          each.ends_it ? (*each.ends_it ? "yes" : "no") : "-"});
  }
  std::string now;
  if (!diagnosis.changes.empty()) {
    const DiagnosisChange& first = diagnosis.changes.front();
    if (first.limit_now) now = fmt::format(" (limit of K now {})", quantity(*first.limit_now, units.stiffness));
    if (first.amplitude_now) now = fmt::format(" (swing now {})", quantity(*first.amplitude_now, units.length));
  }
  return fmt::format("\nWhat moves it, each change alone and recomputed{}\n", now) + layout(table);
}

}  // namespace

std::string diagnosis_text(const Device& device, const Diagnosis& diagnosis) {
  const Units units = units_of(device.parameters().motion);
  std::string text = shortened(display_name(device), line_width) + "\n";
  if (const auto note = trust_note(diagnosis.trust)) text += line("trust", *note);
  if (diagnosis.trust.refused()) return text;
  text += line(
      "oscillates",
      fmt::format(
          "at {}{}, wall of {} and {} {}", quantity(hertz(*diagnosis.frequency), "Hz"),
          diagnosis.amplitude ? fmt::format(" by {}", quantity(*diagnosis.amplitude, units.length)) : std::string(),
          diagnosis.stiffness ? quantity(*diagnosis.stiffness, units.stiffness) : std::string("unknown stiffness"),
          number(diagnosis.damping), units.damping));
  if (diagnosis.cause) {
    const OscillationCandidate& cause = diagnosis.candidates.front();
    text +=
        line("cause", fmt::format("{}{}: {}", cause_text(cause.cause), mechanism_text(cause.limited_by), cause.why));
  } else {
    text += line("cause", "none fits: nothing that is modelled here oscillates there with this wall");
  }
  for (const Remark& remark : diagnosis.remarks) text += wrap(remark_line(remark), line_width, 4).replace(0, 4, "  - ");
  std::string others;
  for (std::size_t i = diagnosis.cause ? 1 : 0; i < diagnosis.candidates.size(); ++i) {
    const OscillationCandidate& each = diagnosis.candidates[i];
    others +=
        wrap(fmt::format("{}{}: {}", each.fits ? "possible: " : "", cause_text(each.cause), each.why), line_width, 4)
            .replace(0, 4, "  - ");
  }
  if (!others.empty()) text += (diagnosis.cause ? "\nWhat else was looked at\n" : "\nWhat was looked at\n") + others;
  if (!diagnosis.changes.empty()) text += changes_text(device, diagnosis);
  return text;
}

}  // namespace zwidth::report

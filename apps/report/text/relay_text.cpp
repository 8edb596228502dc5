#include "report/text/relay_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_filter_text.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::report {
namespace {

std::string heading(const RelayResult& result) {
  const Units units = units_of(result.motion);
  const std::string relay = fmt::format("relay of {}", quantity(result.relay.amplitude, units.force));
  std::string text;
  if (result.source == RelayResult::Source::recording) {
    text = fmt::format("Recorded relay experiment: {}\n  {}, {} Hz sampling\n",
                       shortened(result.recording, line_width - 28), relay, number(1.0 / result.sampling_period));
  } else {
    const auto damper = damper_apart_text(*result.device, result.device->parameters().wall.damping);
    text = fmt::format(
        "Simulated relay experiment: {}\n  {}{}, delay {}{}\n",
        shortened(display_name(*result.device), line_width - 28), relay,
        result.relay.hysteresis > 0.0 ? fmt::format(", hysteresis {}", quantity(result.relay.hysteresis, units.length))
                                      : "",
        quantity(result.device->loop().delay, "s"), damper ? ", beside a damper of " + *damper : std::string());
  }
  const auto note = trust_note(result.trust);
  return text + (note ? wrap("as a limit for walls: " + *note, line_width, 2) : "") + "\n";
}

TextTable trial_table(const RelayResult& result) {
  const Units units = units_of(result.motion);
  TextTable table{{Align::right, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right},
                  {{"trial", "Hz", "K", "K (dB)", "amplitude", "steady from (s)", "by cycles (Hz)"}}};
  for (std::size_t i = 0; i < result.trials.size(); ++i) {
    const RelayTrial& trial = result.trials[i];
    const std::string name = std::to_string(i + 1);
    if (!trial.result) {
      table.rows.push_back({name, "-", "-", "-", "-", "-", "-"});
      continue;
    }
    const RelayReading& reading = *trial.result;
    table.rows.push_back({name, fmt::format("{:.4f}", hertz(reading.frequency)),
                          quantity(reading.stiffness, units.stiffness),
                          fmt::format("{:.2f}", decibels(reading.stiffness)), quantity(reading.amplitude, units.length),
                          fmt::format("{:.2f}", static_cast<double>(reading.steady_from) * result.sampling_period),
                          reading.cycle_frequency ? fmt::format("{:.4f}", hertz(*reading.cycle_frequency)) : "-"});
  }
  if (const auto& mean = result.mean; mean && mean->trials > 1) {
    table.rows.push_back({"mean", fmt::format("{:.4f}", hertz(mean->frequency)),
                          quantity(mean->stiffness, units.stiffness), fmt::format("{:.2f}", decibels(mean->stiffness)),
                          quantity(mean->amplitude, units.length), "", ""});
  }
  return table;
}

/// Trials without an oscillation.
std::vector<std::string> failures(const RelayResult& result) {
  std::vector<std::string> items;
  for (std::size_t i = 0; i < result.trials.size(); ++i) {
    const auto& found = result.trials[i].result;
    if (!found) items.push_back(fmt::format("trial {}: no oscillation: {}", i + 1, text(found.error().why)));
  }
  return items;
}

std::string spectra_note(const RelayResult& result) {
  for (const RelayTrial& trial : result.trials) {
    if (!trial.result) continue;
    return fmt::format(
        "Frequencies are lines of the spectra, {} Hz apart; \"by cycles\" counts the position's cycles "
        "instead.",
        number(hertz(trial.result->line_spacing)));
  }
  return "";
}

/// Else friction may hold what a wall of that stiffness does not.
std::optional<std::string> limit_option(const RelayResult& result) {
  if (!result.mean || !result.trust.sound()) return std::nullopt;
  return fmt::format("for identify: --limit \"K={:.4g}, hz={:.4g}\"", result.mean->stiffness,
                     hertz(result.mean->frequency));
}

/// `none`: what stands where there are no cycles.
void add_cycles(TextTable& table, const std::string& name, const std::vector<LimitCycle>& cycles,
                const std::string& none, std::string_view length) {
  const std::vector<CycleBand> bands = cycle_bands(cycles);
  if (bands.empty()) table.rows.push_back({name, none, "", ""});
  for (std::size_t i = 0; i < bands.size(); ++i) {
    const auto& [count, low, high] = bands[i];
    const std::string label = i == 0 ? name : "";
    if (count == 1) {
      table.rows.push_back({label, number(hertz(low.frequency)), fmt::format("{:.2f}", decibels(low.stiffness)),
                            quantity(low.amplitude, length)});
    } else {
      table.rows.push_back(
          {label, fmt::format("{} to {}", number(hertz(low.frequency)), number(hertz(high.frequency))),
           fmt::format("{:.2f} to {:.2f}", decibels(low.stiffness), decibels(high.stiffness)),
           fmt::format("{} to {}", quantity(low.amplitude, length), quantity(high.amplitude, length))});
    }
  }
}

/// The critical one and the lowest; a long delay has thousands.
void add_crossovers(TextTable& table, const CriticalStiffness& linear) {
  static constexpr std::size_t most = 12;
  std::string label = "linear crossovers";
  std::size_t shown = 0;
  std::size_t left_out = 0;
  for (const Crossover& crossover : linear.crossovers) {
    if (crossover.frequency <= 0.0) continue;
    const bool limits = linear.limit && linear.limit->frequency == crossover.frequency;
    if (shown >= most && !limits) {
      ++left_out;
      continue;
    }
    ++shown;
    table.rows.push_back({label, number(hertz(crossover.frequency)),
                          fmt::format("{:.2f}", decibels(crossover.stiffness)), limits ? "<- critical" : ""});
    label.clear();
  }
  if (shown == 0) table.rows.push_back({label, "none", "", ""});
  if (left_out > 0) table.rows.push_back({"", fmt::format("and {} more", left_out), "", ""});
}

constexpr const char* expected = "What theory expects";
constexpr const char* of_expectations =
    "First harmonics are an approximation. The exact oscillations have neither friction nor encoder nor force limit; "
    "stable or not, all are listed. The continuous relay acts t_d + T/2 late.";

/// Headings alone where nothing is predicted.
TextTable prediction_table(const RelayResult& result) {
  TextTable table{{Align::left, Align::right, Align::right, Align::right}, {{"", "Hz", "K (dB)", "amplitude"}}};
  if (!result.prediction) return table;
  const RelayPrediction& prediction = *result.prediction;
  const std::string_view length = units_of(result.motion).length;
  add_crossovers(table, prediction.linear);
  const bool has_exact =
      !(result.device && damper_apart_text(*result.device, result.device->parameters().wall.damping));
  const std::string none =
      has_exact ? fmt::format("none above {}", number(hertz(prediction.lowest_frequency))) : std::string("left out");
  add_cycles(table, result.friction_level.value_or(0.0) > 0.0 ? "first harmonics, with friction" : "first harmonics",
             prediction.describing_function, has_exact ? "none" : "none known", length);
  add_cycles(table, "sampled relay, exact", prediction.sampled_relay, none, length);
  add_cycles(table, "continuous relay, exact", prediction.continuous_relay, none, length);
  return table;
}

/// A remark of some trials.
struct SharedRemark {
  std::string text;
  std::vector<std::size_t> trials;  // from 1
};

std::vector<SharedRemark> shared_remarks(const std::vector<RelayTrial>& trials) {
  std::vector<SharedRemark> shared;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (!trials[i].result) continue;
    for (const Remark& remark : trials[i].result->remarks) {
      const std::string text = remark_line(remark);
      auto same = std::find_if(shared.begin(), shared.end(), [&](const auto& each) { return each.text == text; });
      if (same == shared.end()) same = shared.insert(shared.end(), {text, {}});
      same->trials.push_back(i + 1);
    }
  }
  return shared;
}

std::vector<std::string> remarks(const RelayResult& result) {
  std::vector<std::string> items;
  for (const Remark& remark : result.remarks) items.push_back(remark_line(remark));
  for (const SharedRemark& remark : shared_remarks(result.trials)) {
    const bool is_of_all = remark.trials.size() == result.trials.size();
    items.push_back(is_of_all ? remark.text : fmt::format("trial {}: {}", fmt::join(remark.trials, ", "), remark.text));
  }
  const auto is_first = [&](const RelayTrial& each) { return each.position == result.trials.front().position; };
  if (result.trials.size() > 1 && std::ranges::all_of(result.trials, is_first)) {
    items.push_back("all trials are alike: without a start offset and friction nothing varies");
  }
  return items;
}

std::vector<std::string> explanations(const RelayResult& result) {
  std::vector<std::string> items;
  for (const Finding& each : result.explanation) items.push_back(zwidth::text(each));
  return items;
}

std::string bullets(const std::string& title, const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& each : items) text += bulleted(each);
  return text.empty() ? "" : "\n" + title + "\n" + text;
}

}  // namespace

std::string relay_text(const RelayResult& result) {
  if (result.trials.empty()) return heading(result);
  std::string text = heading(result) + layout(trial_table(result));
  for (const std::string& each : failures(result)) text += bulleted(each);
  if (const std::string note = spectra_note(result); !note.empty()) text += wrap(note, line_width, 2);
  if (const auto option = limit_option(result)) text += fmt::format("  {}\n", *option);
  if (result.prediction) {
    text += fmt::format("\n{}\n", expected) + layout(prediction_table(result)) + wrap(of_expectations, line_width, 2);
  }
  return text + bullets("What it means", explanations(result)) + bullets("To know", remarks(result));
}

void add_relay(Document& document, const RelayResult& result) {
  if (result.trials.empty()) return;
  document.rows(std::vector<LabelledText>{{"relay", quantity(result.relay.amplitude, units_of(result.motion).force)},
                                          {"sampling", quantity(1.0 / result.sampling_period, "Hz")}});
  document.table(trial_table(result));
  document.list(failures(result));
  document.paragraph(spectra_note(result));
  document.paragraph(limit_option(result));
  document.part(expected);
  document.table(prediction_table(result));
  if (result.prediction) document.paragraph(of_expectations);
  document.part("What it means");
  document.list(explanations(result));
  document.part("To know");
  document.list(remarks(result));
}

}  // namespace zwidth::report

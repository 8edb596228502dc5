#include "report/text/frf_text.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"

namespace zwidth::report {
namespace {

std::string between(const Interval& interval, const std::string& unit) {
  return fmt::format("95 % between {} and {}", quantity(interval.lower, unit), quantity(interval.upper, unit));
}

std::string in_hertz(const Interval& interval) {
  return fmt::format("{} to {} Hz", number(hertz(interval.lower)), number(hertz(interval.upper)));
}

std::vector<LabelledText> found(const MeasuredStiffness& stiffness, const std::string& unit) {
  const MeasuredCrossover& limit = *stiffness.limit;
  return {{"critical stiffness",
           fmt::format("{}, {}", quantity(limit.stiffness, unit), between(*stiffness_interval(stiffness), unit))},
          {"oscillates at",
           fmt::format("{}, 95 %: {}", crossover_frequency_text(limit.frequency), in_hertz(limit.frequency_interval))}};
}

std::vector<LabelledText> answer(const MeasuredResponse& frf, const std::string& unit) {
  if (!frf.stiffness) return {{"critical stiffness", "not to be had from this response"}};
  const MeasuredStiffness& stiffness = *frf.stiffness;
  switch (stiffness.status) {
    case MeasuredStiffnessStatus::found:
      return found(stiffness, unit);
    case MeasuredStiffnessStatus::not_in_band:
      return {{"critical stiffness", "unknown: the crossover that limits is not in the measured band"}};
    case MeasuredStiffnessStatus::undetermined:
      break;
  }
  return {{"critical stiffness", stiffness.limit
                                     ? fmt::format("unknown, at most {}: noise may hide a softer crossover",
                                                   quantity(stiffness.limit->stiffness_interval.upper, unit))
                                     : "unknown: noise hides the phase"}};
}

/// Headings alone where the data prove none.
TextTable crossovers(const MeasuredResponse& frf, const std::string& unit) {
  TextTable table{{Align::right, Align::right, Align::right, Align::right, Align::left},
                  {{"Hz", "95 %", "K", "95 %", "as K rises"}}};
  if (!frf.stiffness) return table;
  const MeasuredStiffness& stiffness = *frf.stiffness;
  for (const MeasuredCrossover& crossover : stiffness.crossovers) {
    const bool limits = stiffness.status == MeasuredStiffnessStatus::found && stiffness.limit &&
                        stiffness.limit->frequency == crossover.frequency;
    table.rows.push_back({number(hertz(crossover.frequency)), in_hertz(crossover.frequency_interval),
                          quantity(crossover.stiffness, unit),
                          fmt::format("{} to {}", quantity(crossover.stiffness_interval.lower, unit),
                                      quantity(crossover.stiffness_interval.upper, unit)),
                          std::string(crossover.poles_leaving > 0 ? "an oscillation sets in" : "an oscillation ends") +
                              (limits ? "  <- critical" : "")});
  }
  return table;
}

constexpr const char* proven_crossovers = "Phase crossovers that the data prove";

std::string measured_text(const FrequencyResponse& response) {
  std::string text = fmt::format("{} lines, {}", response.points.size(),
                                 in_hertz({response.points.front().frequency, response.points.back().frequency}));
  if (response.sampling_period) text += fmt::format(", T = {}", quantity(*response.sampling_period, "s"));
  return text;
}

/// What the answer is given with, and what was measured.
std::vector<LabelledText> basis(const MeasuredResponse& frf) {
  if (frf.trust.refused()) return {};
  return {{"basis", "the bare stiffness, without a virtual damper"}};
}

}  // namespace

std::string frf_text(const MeasuredResponse& frf, const results::FrfUnits& units, ShownFindings shown) {
  const FindingsText findings = findings_text(frf.trust, frf.remarks, shown);
  const TextTable proven = crossovers(frf, units.stiffness());
  return shortened(frf.source, line_width) + "\n" + lines_of(answer(frf, units.stiffness())) + lines_of(basis(frf)) +
         findings.against + (frf.trust.sound() ? labelled("  trust", "sound") : "") +
         labelled("  measured", measured_text(frf.response)) +
         (proven.rows.size() == 1 ? "" : fmt::format("\n{}\n", proven_crossovers) + layout(proven)) + findings.remarks;
}

void add_response(Document& document, const MeasuredResponse& frf, const results::FrfUnits& units) {
  std::vector<LabelledText> rows = answer(frf, units.stiffness());
  for (LabelledText& each : basis(frf)) rows.push_back(std::move(each));
  rows.push_back({"measured", measured_text(frf.response)});
  document.rows(rows);
  document.part(proven_crossovers);
  document.table(crossovers(frf, units.stiffness()));
}

}  // namespace zwidth::report

#include "report/text/frf_text.hpp"

#include <fmt/format.h>

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

std::string found(const MeasuredStiffness& stiffness, const std::string& unit) {
  const MeasuredCrossover& limit = *stiffness.limit;
  return labelled("  critical stiffness", fmt::format("{}, {}", quantity(limit.stiffness, unit),
                                                      between(*stiffness_interval(stiffness), unit))) +
         labelled("  oscillates at", fmt::format("{}, 95 %: {}", crossover_frequency_text(limit.frequency),
                                                 in_hertz(limit.frequency_interval)));
}

std::string answer(const MeasuredResponse& frf, const std::string& unit) {
  if (!frf.stiffness) return labelled("  critical stiffness", "not to be had from this response");
  const MeasuredStiffness& stiffness = *frf.stiffness;
  switch (stiffness.status) {
    case MeasuredStiffnessStatus::found:
      return found(stiffness, unit);
    case MeasuredStiffnessStatus::not_in_band:
      return labelled("  critical stiffness", "unknown: the crossover that limits is not in the measured band");
    case MeasuredStiffnessStatus::undetermined:
      break;
  }
  return labelled("  critical stiffness", stiffness.limit
                                              ? fmt::format("unknown, at most {}: noise may hide a softer crossover",
                                                            quantity(stiffness.limit->stiffness_interval.upper, unit))
                                              : "unknown: noise hides the phase");
}

std::string crossovers(const MeasuredResponse& frf, const std::string& unit) {
  if (!frf.stiffness || frf.stiffness->crossovers.empty()) return "";
  const MeasuredStiffness& stiffness = *frf.stiffness;
  TextTable table{{Align::right, Align::right, Align::right, Align::right, Align::left},
                  {{"Hz", "95 %", "K", "95 %", "as K rises"}}};
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
  return "Phase crossovers that the data prove\n" + layout(table);
}

}  // namespace

std::string frf_text(const MeasuredResponse& frf, const results::FrfUnits& units, ShownFindings shown) {
  const FrequencyResponse& response = frf.response;
  std::string measured = fmt::format("{} lines, {}", response.points.size(),
                                     in_hertz({response.points.front().frequency, response.points.back().frequency}));
  if (response.sampling_period) measured += fmt::format(", T = {}", quantity(*response.sampling_period, "s"));
  const std::string basis =
      frf.trust.refused() ? "" : labelled("  basis", "the bare stiffness, without a virtual damper");
  const FindingsText findings = findings_text(frf.trust, frf.remarks, shown);
  const std::string proven = crossovers(frf, units.stiffness());
  return shortened(frf.source, line_width) + "\n" + answer(frf, units.stiffness()) + basis + findings.against +
         (frf.trust.sound() ? labelled("  trust", "sound") : "") + labelled("  measured", measured) +
         (proven.empty() ? "" : "\n" + proven) + findings.remarks;
}

}  // namespace zwidth::report

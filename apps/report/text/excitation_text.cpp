#include "report/text/excitation_text.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/text/quantity.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::report {
namespace {

std::string_view name_of(ExcitationKind kind) {
  switch (kind) {
    case ExcitationKind::linear_chirp:
      return "Linear chirp";
    case ExcitationKind::logarithmic_chirp:
      return "Logarithmic chirp";
    case ExcitationKind::multisine:
      return "Multisine";
    case ExcitationKind::noise:
      return "Band-limited noise";
    case ExcitationKind::relay:
      return "Square wave";
  }
  return {};
}

}  // namespace

std::string excitation_title(const ExcitationOptions& options) {
  const std::string_view name = name_of(options.kind);
  if (options.kind == ExcitationKind::relay) return fmt::format("{} of {:.6g} Hz", name, options.lowest_hz);
  return fmt::format("{}, {:.6g} to {:.6g} Hz", name, options.lowest_hz, options.highest_hz);
}

std::string excitation_text(const Excitation& excitation) {
  const Units units = units_of(excitation.motion);
  const auto seconds = [&](std::size_t samples) { return static_cast<double>(samples) / excitation.rate; };
  std::string text = fmt::format("{}: {:.9g} s, {} samples at {:.9g} Hz\n", excitation_title(excitation.options),
                                 seconds(excitation.samples.size()), excitation.samples.size(), excitation.rate);
  if (excitation.period > 0) {
    text += fmt::format("  one period: {} samples, {:.6g} s\n", excitation.period, seconds(excitation.period));
  }
  text += fmt::format("  peak {}, rms {}, crest factor {:.3f}\n", quantity(excitation.crest.peak, units.force),
                      quantity(excitation.crest.rms, units.force), excitation.crest.factor);
  const auto add_notes = [&text](const std::vector<Remark>& remarks) {
    for (const Remark& remark : remarks) {
      if (remark.severity == Remark::Severity::note) text += "  " + remark_line(remark) + "\n";
    }
  };
  if (excitation.check) {
    const ExcitationCheck& check = *excitation.check;
    text += std::isfinite(check.peak_stroke) ? fmt::format("  {} moves up to {} from its start\n", check.device,
                                                           quantity(check.peak_stroke, units.length))
                                             : fmt::format("  {} runs away\n", check.device);
  }
  add_notes(excitation.remarks);
  if (excitation.check) add_notes(excitation.check->remarks);
  return text;
}

}  // namespace zwidth::report

#include "report/excitation_summary.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/text/quantity.hpp"
#include "report/text/remark_line.hpp"

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

double duration_of(const CheckedExcitation& checked) {
  return static_cast<double>(checked.excitation.samples.size()) / checked.options.rate;
}

}  // namespace

std::string excitation_title(const ExcitationOptions& options) {
  const std::string_view name = name_of(options.kind);
  if (options.kind == ExcitationKind::relay) return fmt::format("{} of {:.6g} Hz", name, options.lowest_hz);
  return fmt::format("{}, {:.6g} to {:.6g} Hz", name, options.lowest_hz, options.highest_hz);
}

std::string excitation_text(const CheckedExcitation& checked) {
  const Units units = units_of(checked.motion);
  const CrestFactor crest = crest_factor(checked.excitation.samples);
  std::string text = fmt::format("{}: {:.9g} s, {} samples at {:.9g} Hz\n", excitation_title(checked.options),
                                 duration_of(checked), checked.excitation.samples.size(), checked.options.rate);
  if (checked.excitation.period > 0) {
    text += fmt::format("  one period: {} samples, {:.6g} s\n", checked.excitation.period,
                        static_cast<double>(checked.excitation.period) / checked.options.rate);
  }
  text += fmt::format("  peak {}, rms {}, crest factor {:.3f}\n", quantity(crest.peak, units.force),
                      quantity(crest.rms, units.force), crest.factor);
  if (checked.check) {
    text += std::isfinite(checked.check->peak_stroke)
                ? fmt::format("  {} moves up to {} from its start\n", checked.device,
                              quantity(checked.check->peak_stroke, units.length))
                : fmt::format("  {} runs away\n", checked.device);
  }
  const auto add_notes = [&text](const std::vector<Remark>& remarks) {
    for (const Remark& remark : remarks) {
      if (remark.severity == Remark::Severity::note) text += "  " + remark_line(remark) + "\n";
    }
  };
  add_notes(checked.excitation.remarks);
  if (checked.check) add_notes(checked.check->remarks);
  return text;
}

}  // namespace zwidth::report

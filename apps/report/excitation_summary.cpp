#include "report/excitation_summary.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/text/quantity.hpp"
#include "report/text/remark_line.hpp"
#include "results/frf_json.hpp"
#include "results/json.hpp"

namespace zwidth::report {
namespace {

using Json = results::Json;

struct KindName {
  std::string_view word;  ///< as on the command line
  std::string_view prose;
};

KindName name_of(ExcitationKind kind) {
  switch (kind) {
    case ExcitationKind::linear_chirp:
      return {"linear-chirp", "Linear chirp"};
    case ExcitationKind::logarithmic_chirp:
      return {"log-chirp", "Logarithmic chirp"};
    case ExcitationKind::multisine:
      return {"multisine", "Multisine"};
    case ExcitationKind::noise:
      return {"noise", "Band-limited noise"};
    case ExcitationKind::relay:
      return {"relay", "Square wave"};
  }
  return {};
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

double duration_of(const CheckedExcitation& checked) {
  return static_cast<double>(checked.excitation.samples.size()) / checked.options.rate;
}

Json check_json(const CheckedExcitation& checked) {
  if (!checked.check) return {};
  Json json;
  json["device"] = checked.device;
  json["largest_motion"] = number_or_null(checked.check->peak_stroke);
  json["within_limits"] = checked.check->exceeded.empty();
  json["exceeded"] = remarks_json(checked.check->exceeded);
  json["remarks"] = remarks_json(checked.check->remarks);
  return json;
}

}  // namespace

std::string excitation_title(const ExcitationOptions& options) {
  const std::string_view name = name_of(options.kind).prose;
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

results::Json excitation_json(const CheckedExcitation& checked) {
  const CrestFactor crest = crest_factor(checked.excitation.samples);
  const bool relay = checked.options.kind == ExcitationKind::relay;
  Json json;
  json["schema"] = "zwidth.excitation/1";
  json["kind"] = name_of(checked.options.kind).word;
  json["units"] = {{"force", units_of(checked.motion).force}, {"motion", units_of(checked.motion).length}};
  json["lowest_hz"] = checked.options.lowest_hz;
  json["highest_hz"] = relay ? Json() : Json(checked.options.highest_hz);
  json["rate_hz"] = checked.options.rate;
  json["samples"] = checked.excitation.samples.size();
  json["duration_s"] = duration_of(checked);
  json["period_samples"] = checked.excitation.period > 0 ? Json(checked.excitation.period) : Json();
  json["peak_force"] = crest.peak;
  json["rms_force"] = crest.rms;
  json["crest_factor"] = crest.factor;
  json["remarks"] = remarks_json(checked.excitation.remarks);
  json["check"] = check_json(checked);
  return json;
}

}  // namespace zwidth::report

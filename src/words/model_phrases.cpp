#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> model_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  static constexpr std::array phrases{
      Phrase{stated, "stated", refusal, "{reason}"},
      Phrase{left_out, "left_out", doubt, "the family of users is left out: {reason}"},
      Phrase{nobody_holding, "nobody_holding", refusal, "with nobody holding: {reason}"},
      Phrase{not_converged, "not_converged", refusal, "{reason}"},
      Phrase{untrusted_without_reason, "untrusted_without_reason", refusal,
             "the device file says so, without a reason: measure or identify the device again"},
      Phrase{assumed_numbers, "assumed_numbers", refusal, "assumed, not measured: {keys}", "", "give the device's own"},
      Phrase{period_too_short, "period_too_short", warning,
             "the sampling period{?whose| of the {whose}} is {period:.4g} s",
             "every delay, damping and critical stiffness depends on it",
             "is the time in the unit that was stated? It must be in seconds"},
      Phrase{period_too_long, "period_too_long", warning,
             "the sampling period{?whose| of the {whose}} is {period:.4g} s",
             "every delay, damping and critical stiffness depends on it",
             "is it in {likely_unit}? It must be in seconds: {likely:.4g}"},
      Phrase{late_beyond_drives, "late_beyond_drives", warning,
             "delay and lag come to {late:.4g} s, {periods:.3g} sampling periods", "few drives are as slow as that",
             "is it in {likely_unit}? It must be in seconds: {likely:.4g}"},
      Phrase{mass_too_large, "mass_too_large", warning, "{body} has a mass of {mass:.4g} kg",
             "few haptic devices are as heavy as that", "is it in g? It must be in kg: {likely:.4g}"},
      Phrase{inertia_too_large, "inertia_too_large", warning, "{body} has an inertia of {inertia:.4g} kg m^2",
             "few haptic devices are as heavy as that", "is it in g m^2? It must be in kg m^2: {likely:.4g}"},
      Phrase{mechanism_number_replaced, "mechanism_number_replaced", note,
             "{key} is {value:.4g} here, and {of_file:.4g} in the mechanism's file", ""}};
  return phrases;
}

}  // namespace zwidth::internal

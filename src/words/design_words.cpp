#include <fmt/format.h>

#include "zwidth/design/diagnosis.hpp"
#include "zwidth/design/region_approximation.hpp"
#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/model/mechanism_key.hpp"

namespace zwidth {

FormulaFacts facts_of(RegionApproximation::Formula formula) {
  using enum RegionApproximation::Formula;
  switch (formula) {
    case colgate_schenkel:
      return {"Colgate & Schenkel", "Colgate & Schenkel 1997", "b > K T/2 + B (1 - a)/(1 + a)",
              "rigid device, no delay, any passive user; exact there"};
    case gil_hulin:
      return {"Gil, Hulin", "Gil et al. 2007, Hulin et al.", "K < (b + B)/(T/2 + t_d)",
              "rigid device, no other user, small delay, fast sampling, low damping; approximate"};
    case diolaiti:
      break;
  }
  return {"Diolaiti", "Diolaiti et al. 2006", "K <= b/(T/2 + t_d), B = 0",
          "rigid device, no virtual damper, any passive user; exact for a delay of whole samples"};
}

std::string words_of(const DiagnosisChange& change) {
  using enum DiagnosisChange::Kind;
  switch (change.kind) {
    case more_body_damping:
      return "damping of every body + 20 %";
    case half_delay:
      return "half the delay";
    case twice_sampling_rate:
      return "twice the sampling rate";
    case half_actuator_lag:
      return "half the actuator's lag";
    case no_velocity_filter:
      return "no velocity filter";
    case stiffer_link:
      if (is_key_of_mechanism_file(change.key)) {
        return fmt::format("{} 20 % stiffer", change.key.substr(0, change.key.rfind('.')));
      }
      return fmt::format("{} {} 20 % stiffer", change.key.starts_with("link.") ? "link" : "cable of transmission",
                         change.link.value_or(0));
    case finer_encoder:
      return "an encoder four times as fine";
    case half_damper:
      return "half the damper";
    case weaker_damper:
      return "a weaker damper, 6 dB below";
    case half_stiffness:
      return "half the stiffness";
    case softer_wall:
      return "a softer wall, 6 dB below";
    case other_damper:
      return "another virtual damper";
    case damper_on_drive:
      return fmt::format("a damper on the drive, B = {:.4g}, {:.4g} µs late", change.damping_then.value_or(0.0),
                         1e6 * change.delay_then.value_or(0.0));
    case half_damper_delay:
      return "half the damper's delay";
    case twice_damper_rate:
      return "twice the damper's rate";
    case twice_tracking:
      return "twice the drive's tracking bandwidth";
    case notch:
      break;
  }
  return "a notch there";
}

std::string_view words_of(RecommendedWall::Kind kind) {
  using enum RecommendedWall::Kind;
  switch (kind) {
    case recommended:
      return "recommended";
    case no_virtual_damper:
      return "no virtual damper";
    case half_damping:
      return "half the damping";
    case more_damping:
      return "half as much damping again";
    case no_velocity_filter:
      return "no velocity filter";
    case no_notch:
      return "no notch";
    case stiffest:
      return "stiffest";
    case widest:
      return "greatest K B";
    case critically_damped:
      break;
  }
  return "contact critically damped";
}

}  // namespace zwidth

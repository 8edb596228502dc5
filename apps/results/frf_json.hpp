#pragma once

#include <string>

#include "results/json.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::results {

/// [lower, upper]
void to_json(Json& json, const Interval& interval);

NLOHMANN_JSON_SERIALIZE_ENUM(MeasuredStiffnessStatus, {{MeasuredStiffnessStatus::found, "found"},
                                                       {MeasuredStiffnessStatus::not_in_band, "not_in_band"},
                                                       {MeasuredStiffnessStatus::undetermined, "undetermined"}})

/// Names of the units of a measured response.
struct FrfUnits {
  std::string force = "N";
  std::string position = "m";
  [[nodiscard]] std::string stiffness() const;   ///< "N/m", "N m/rad"
  [[nodiscard]] std::string compliance() const;  ///< "m/N", "rad/(N m)"
};

/// Those that the columns' names state; N and m where they state none.
[[nodiscard]] FrfUnits frf_units(const MeasuredResponse& measured);

/// Those of what is recorded of a device.
[[nodiscard]] FrfUnits frf_units(const Device& device);

enum class FrfContent {
  summary,     ///< all but the lines
  with_lines,  ///< and the arrays of frequency, magnitude, phase and coherence with their bounds
};

/// The measured response as a JSON document, schema "zwidth.frf/1": see docs/frf_json.md.
[[nodiscard]] Json frf_json(const MeasuredResponse& measured, const FrfUnits& units = {},
                            FrfContent content = FrfContent::summary);

/// The lines of the response as comma-separated values with a header; a bound that does not exist is empty; the last is trust.
/// `zwidth frf --table` reads it back.
[[nodiscard]] std::string frf_csv(const MeasuredResponse& measured);

}  // namespace zwidth::results

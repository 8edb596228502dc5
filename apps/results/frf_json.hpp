#pragma once

#include "report/measured_frf.hpp"
#include "results/json.hpp"

namespace zwidth::report {

enum class FrfContent {
  summary,     ///< all but the lines
  with_lines,  ///< and the arrays of frequency, magnitude, phase and coherence with their bounds
};

/// The measured response as a JSON document, schema "zwidth.frf/1": see docs/frf_json.md.
[[nodiscard]] results::Json frf_json(const MeasuredFrf& frf, FrfContent content);

/// "found", "not_in_band", "undetermined".
[[nodiscard]] const char* name_of(MeasuredStiffnessStatus status);

/// [{"severity": "note" | "warning", "what": ..., "meaning": ...}, ...]
[[nodiscard]] results::Json remarks_json(const std::vector<Remark>& remarks);

}  // namespace zwidth::report

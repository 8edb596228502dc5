#pragma once

#include "results/json.hpp"
#include "zwidth/design/diagnosis.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(OscillationCause, {{OscillationCause::device, "device"},
                                                {OscillationCause::with_user, "operator"},
                                                {OscillationCause::passive_user, "passive_user"},
                                                {OscillationCause::quantisation, "quantisation"},
                                                {OscillationCause::friction, "friction"}})

/// The answer of `diagnose --json`, schema zwidth.diagnosis/1 (docs/diagnosis.md).
[[nodiscard]] Json diagnosis_json(const Device& device, const Diagnosis& diagnosis);

}  // namespace zwidth::results

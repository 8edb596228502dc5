#pragma once

#include "export/export.hpp"
#include "results/json.hpp"

namespace zwidth::results {

/// The model and its wall as a JSON document, schema "zwidth.model/1". Matrices are arrays of rows; polynomials ascend.
/// "with_delay_states" is null where the delay exceeds most_delay_states samples: the matrix would be mostly zeros.
[[nodiscard]] Json export_json(const report::ExportedModel& model);
inline constexpr std::size_t most_delay_states = 200;

}  // namespace zwidth::results

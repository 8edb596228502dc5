#pragma once

#include "results/json.hpp"
#include "zwidth/stability/device_model.hpp"

namespace zwidth::results {

/// The model and its wall as a JSON document, schema "zwidth.model/1". Matrices are arrays of rows; polynomials ascend.
/// "with_delay_states" is null where the delay exceeds most_delay_states samples: the matrix would be mostly zeros.
[[nodiscard]] Json export_json(const DeviceModel& model);

}  // namespace zwidth::results

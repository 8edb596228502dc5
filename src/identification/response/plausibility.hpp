#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// Units that are probably not SI: whole numbers in a channel, a sampling period of seconds.
[[nodiscard]] std::vector<Remark> implausible_recording(const Recording& recording);

/// Why no answer of this recording is one in SI units: what was doubted as it was read; a column's name states a unit that is not known, or of something
/// else than the column is taken for; or it holds whole numbers, or these and a half, as an encoder counts.
[[nodiscard]] std::optional<Finding> doubt_of_units(const Recording& recording, OutputQuantity output);

/// Why no answer of this recording is one of the fitted device's loop: doubt_of_units(); its columns are of a linear motion
/// by their names and the device is rotary, or the other way round; the force goes beyond the actuator's limit, where less
/// acted; or the loop's period is a half, a third, ... of the rows' of all recordings: where those between were left
/// out, so is the force between, and delay is missing from the fit.
[[nodiscard]] std::vector<Finding> doubts_of_recording(const Recording& recording, std::span<const Recording> all,
                                                       OutputQuantity output, const Device& fitted);

}  // namespace zwidth::internal

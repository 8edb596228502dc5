#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/identification/parameter_fit.hpp"
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

/// Why the masses of a device of which nothing was known are not in SI units: no haptic device has such.
[[nodiscard]] std::optional<Finding> doubt_of_weight(const Device& fitted);

/// Why a fitted lag of the actuator cannot be believed: longer than any drive's, beside the record's period. A body's own
/// m/b and such a lag can be exchanged in its response.
[[nodiscard]] std::optional<Finding> doubt_of_lag(const std::vector<ParameterEstimate>& estimates,
                                                  double recorded_period);

/// Numbers of the fitted device that are powers of ten from those of the structure (where its values are known) or from
/// what the record allows.
[[nodiscard]] std::vector<Remark> implausible_device(const Device& fitted, const Device* known,
                                                     std::optional<double> recorded_period);

/// Why no answer is one in SI units where a fitted mass or inertia is about a hundred times the structure's or more, or a
/// hundredth or less.
[[nodiscard]] std::optional<Finding> doubt_of_masses(const Device& fitted, const Device& known);

}  // namespace zwidth::internal

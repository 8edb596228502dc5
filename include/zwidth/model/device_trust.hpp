#pragma once

#include "zwidth/model/device.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// How far the numbers of a device may be relied on, as whoever wrote them said: Uncertainty::verdict, warning,
/// reasons, assumed.
///
/// A warning, reasons or assumed numbers without a verdict are doubtful; a device without an uncertainty is sound.
/// What is computed from the device is trusted no more than that: see Trust::inherit().
[[nodiscard]] Trust trust_of(const Device& device);

}  // namespace zwidth

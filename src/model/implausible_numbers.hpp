#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::internal {

// Numbers that are probably not in SI units, with the likely one.

constexpr double many_periods = 20.0;  ///< of delay or lag: few drives are as slow

/// A sampling period of a haptic loop lies between a microsecond and a tenth of a second. `whose`:
/// "recording", "structure"; empty for the device's.
[[nodiscard]] std::optional<Remark> implausible_period(double period, const std::string& whose);

/// Delay and lag beside a period: the device's own, or the recording's.
[[nodiscard]] std::optional<Remark> implausible_actuation_delay(const Device& device, double period);

/// Bodies of more than `heaviest`, kg or kg m^2.
[[nodiscard]] std::vector<Remark> implausible_masses(const Device& device, double heaviest);

/// Of a device by itself: its period, its delay and lag, and masses that no haptic device has.
[[nodiscard]] std::vector<Remark> implausible_numbers(const Device& device);

}  // namespace zwidth::internal

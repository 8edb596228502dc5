#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// A damping ratio for links of which nothing is known.
inline constexpr double typical_damping_ratio = 0.03;

/// m_1 m_2 / (m_1 + m_2) of the bodies that a link joins: with its stiffness k they vibrate at sqrt(k / mu), the rest aside.
[[nodiscard]] double reduced_mass(const DeviceParameters& device, const Link& link);

/// 2 zeta sqrt(k mu).
[[nodiscard]] double link_damping(const DeviceParameters& device, const Link& link, double damping_ratio);

/// Of the links whose stiffness and damping are both in `free`, those that damp and hardly spring (a damping ratio above 1),
/// as a fit has them where bodies move as one in the band, with their mode at w and a typical damping: another basin of the
/// search, which it does not reach from there. Nothing where there is none.
[[nodiscard]] std::optional<DeviceParameters> with_springs(const DeviceParameters& device,
                                                           const std::vector<std::string>& free, double w);

}  // namespace zwidth::internal

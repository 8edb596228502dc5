#pragma once

#include <optional>
#include <vector>

#include "stability/margins/unit_gain.hpp"
#include "stability/tip/tip_states.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// Beyond, closed-loop poles are not looked at.
inline constexpr Eigen::Index most_states_of_crossovers = 80;

// Every eigenvalue of L = (K + B v) P, m x m, that is of size 1 on |z| = 1, of a stable loop. With T = L (1 + L)^-1 of its own
// poles d_i these are the eigenvalues of T of real part 1/2, and
//
//     |dT/dangle|  <=  sum over i of |C r_i| |l_i B| / |z - d_i|^2
//
// Intervals of angle in which that bound keeps all eigenvalues off (Bauer and Fike 1960) hold none; the others are halved
// until they are narrower than 1e-7 of the angle. Two that lie together within that are one, or none. Nothing where the
// poles lie too near to each other for the bound, and beyond most_states_of_crossovers.
[[nodiscard]] std::optional<std::vector<UnitGainPoint>> all_unit_gain_points(const SampledTip& plant, const Wall& wall);

// The least delay, s, added in every direction at once, that puts a pole of a stable loop on the circle; nothing where none
// does. Throws Error (did_not_converge) where crossovers are not known.
[[nodiscard]] std::optional<double> delay_margin_of_tip(const TipCoordinates& of, const DeviceParameters& loop);

}  // namespace zwidth::internal

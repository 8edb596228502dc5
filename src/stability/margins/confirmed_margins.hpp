#pragma once

#include "zwidth/stability/analysis.hpp"

namespace zwidth::internal {

/// disk_margin() of a loop that is known to be stable.
[[nodiscard]] DiskMargin disk_margin_of_stable(const FilteredPlant& plant, const Wall& wall);

/// Asks closed-loop poles and each other for the margins of a stable wall, whose crossings poles that lie together may hide:
///
/// - the loop is stable with hardly less further delay than the margin, and unstable with hardly more;
/// - it is stable at parts of the phase margin, up to all but 1e-4 of it, and at any phase where there is none;
/// - alpha <= 2 (g - 1)/(g + 1) for gain margins g and 1/g, alpha <= 2 tan(phase margin / 2): the disk holds no more than
///   each alone (Seiler, Packard & Gahinet 2020).
///
/// What contradicts is left out, with what follows from the same crossings, and the analysis doubtful.
void confirm_margins(const Device& device, Analysis& analysis);

}  // namespace zwidth::internal

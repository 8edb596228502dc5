#pragma once

#include "reproduce/reproduction.hpp"

namespace zwidth::report {

/// Fig. 11, Fig. 12 with both branches, and the fit of the friction. Throws OutputFailed.
[[nodiscard]] PaperFigure figure_11();
[[nodiscard]] PaperFigure figure_12();
[[nodiscard]] PaperFigure figure_12_friction();

}  // namespace zwidth::report

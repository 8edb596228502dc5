#pragma once

#include "zwidth/identification/identification.hpp"

namespace zwidth::internal {

/// Doubts an answer otherwise sound where the structure with one body more, on a link to any of its bodies, explains the
/// response notably better (explains_notably_more()): a mode above the band bends the response within it before what is left
/// stands out of the noise at any line. The mode begins at 1.3 and at 3 times the highest line, damped by 0.1 % of the
/// critical damping; its mass and stiffness are free beside the numbers of the fit. Nothing of a response without variances.
void judge_further_body(Identification& result, const IdentifyOptions& options);

}  // namespace zwidth::internal

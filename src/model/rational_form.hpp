#pragma once

#include <vector>

#include "model/extended_precision.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal {

// A quotient of polynomials in double-double as a sum of terms, and where it has its poles.
struct RationalForm {
  ModalForm form;                        // in the polynomials' own variable; none of its modes means anything
  std::vector<Complex<Extended>> poles;  // all, those at zero included
};

// Polynomials by rising powers, degree(numerator) < degree(denominator); a denominator that begins with zeros has as many
// roots at zero. Throws Error (did_not_converge) where the terms do not add up to the quotient at |1 + x| = 1.
RationalForm rational_form(std::vector<Extended> numerator, std::vector<Extended> denominator);

}  // namespace zwidth::internal

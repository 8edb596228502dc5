#pragma once

// Partial fractions of devices whose poles crowd: separate terms cancel there, and double-double carries neither the
// poles nor the terms. Roots are isolated with proof from the exact polynomial (Arb), terms are computed in balls whose
// precision rises until every coefficient is known, and terms that cancel are joined.

#include "model/exact_fraction.hpp"
#include "model/exact_poles.hpp"
#include "model/pole_groups.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal {

// Terms are joined until none exceeds the sum by more, at the frequency of any pole but where irrelevant_below says.
inline constexpr double joined_above = 1e3;

// `known`: poles that were found before, and will be. Throws Error (did_not_converge) where terms of
// ModalTerm::max_degree still cancel too much.
ModalForm exact_partial_fractions(ExactFraction fraction, const DrivePath& drive, const PoleLabels& labels,
                                  KnownPoles& known);

}  // namespace zwidth::internal

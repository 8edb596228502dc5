#pragma once

#include "zwidth/identification/parameter_fit.hpp"

namespace zwidth::internal {

/// Whether no parameter has moved by a notable part of its standard deviation, from one fit of a structure to another.
[[nodiscard]] bool stands_still(const ParameterFit& before, const ParameterFit& after);

[[nodiscard]] bool explains_more(const ParameterFit& one, const ParameterFit& other);

/// Whether another fit leaves no more than chance may: by Student's t, of as many degrees of freedom as independent
/// residuals exceed the free parameters,
///
///     (chi^2 / chi_first^2 - 1) nu <= t_nu^2
[[nodiscard]] bool explains_as_much(const ParameterFit& other, const ParameterFit& first, double line_correlation);

/// Whether another fit leaves so much more that not even five deviations of what tells them apart account for it.
[[nodiscard]] bool is_contradicted(const ParameterFit& other, const ParameterFit& first, double line_correlation);

}  // namespace zwidth::internal

#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/io/input_error.hpp"
#include "zwidth/io/number_with_unit.hpp"
#include "zwidth/study/distribution.hpp"

namespace zwidth::internal {

/// The discrete distribution of values in any order, equal ones together; those of weight 0 are left out.
[[nodiscard]] Distribution discrete_of(const std::vector<double>& values, const std::vector<double>& weights);

/// Measured samples as a distribution: a text file with a number per line and, where there is a second one, how often it
/// was seen (a histogram: "0.00025 118"); no comma without a blank, which may be a decimal one. Lines that are empty or begin with # are skipped. SI units, or a header line
/// "# unit: ms" with one of what is measured.
[[nodiscard]] tl::expected<Distribution, InputError> read_study_samples(const std::string& path, Measure measure,
                                                                        Motion motion);

}  // namespace zwidth::internal

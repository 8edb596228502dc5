#pragma once

#include <string>

#include "report/measured_frf.hpp"

namespace zwidth::report {

/// The lines of the response as comma-separated values with a header; a bound that does not exist is empty.
/// `zwidth frf --table` reads it back.
[[nodiscard]] std::string frf_csv(const FrequencyResponse& response);

}  // namespace zwidth::report

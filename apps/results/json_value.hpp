#pragma once

#include <optional>
#include <string>

#include "results/json.hpp"
#include "results/stability_json.hpp"

namespace zwidth::report {

// Until every result converts itself through results/json.hpp: the old names for what its serializers do.
[[nodiscard]] inline results::Json number_or_null(std::optional<double> value) { return value; }
[[nodiscard]] inline results::Json mechanism_json(const Mechanism& mechanism) { return mechanism; }
[[nodiscard]] inline std::string status_name(StiffnessStatus status) { return results::name_of(status); }

}  // namespace zwidth::report

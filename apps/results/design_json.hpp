#pragma once

#include <string>

#include "report/design_comparison.hpp"
#include "report/design_sweep.hpp"
#include "report/designed_device.hpp"
#include "report/designed_notch.hpp"
#include "results/json.hpp"

namespace zwidth::results {

/// The answer of `design --json`, schema zwidth.design/1 (docs/design.md).
[[nodiscard]] Json design_json(const report::DesignedDevice& designed);

/// The answer of `design --sweep --json`, schema zwidth.design_sweep/1.
[[nodiscard]] Json sweep_json(const report::DesignSweep& sweep);

/// Every point, a line each: the parameters, K_CR (empty where unbounded), rad/s, mode (0: the rigid body), the
/// any-user limit where asked for.
[[nodiscard]] std::string sweep_csv(const report::DesignSweep& sweep);

/// The answer of `design --compare --json`, schema zwidth.design_comparison/1.
[[nodiscard]] Json comparison_json(const report::DesignComparison& comparison);

/// The answer of `design --notch --json`, schema zwidth.notch/1.
[[nodiscard]] Json notch_json(const report::DesignedNotch& notch);

}  // namespace zwidth::results

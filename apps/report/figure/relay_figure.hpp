#pragma once

#include <string>
#include <string_view>

#include "report/figure/canvas.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/simulation/relay.hpp"
#include "zwidth/simulation/relay_trials.hpp"

namespace zwidth::report {

/// Force and position of the end of one trial, over the same time: ten cycles of its oscillation, or all of the record
/// where there is none (Fig. 11 of Díaz & Gil). Throws OutputFailed.
[[nodiscard]] std::string draw_relay_record(const std::string& title, const RelayTrial& trial, double sampling_period,
                                            Motion motion, FigureFormat format);

/// The same of the first trial that oscillates, of the first one where none does. Throws OutputFailed.
[[nodiscard]] std::string draw_relay(const RelayResult& result, FigureFormat format);

}  // namespace zwidth::report

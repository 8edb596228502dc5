#pragma once

#include <span>

#include "report/analysed_device.hpp"
#include "report/figure/bode_figure.hpp"
#include "zwidth/stability/bode.hpp"

namespace zwidth::report {

/// One device: sampled and continuous response; up to most_curves devices: the sampled ones, over a range that shows
/// all. Every crossover is marked.
[[nodiscard]] BodeFigure device_bode_figure(std::span<const AnalysedDevice> devices, const BodeOptions& options = {});

}  // namespace zwidth::report

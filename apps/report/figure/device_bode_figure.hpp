#pragma once

#include <span>

#include "report/analysed_device.hpp"
#include "report/figure/bode_figure.hpp"
#include "zwidth/design/diagnosis.hpp"
#include "zwidth/stability/bode.hpp"

namespace zwidth::report {

/// One device: sampled and continuous response; up to most_curves devices: the sampled ones, over a range that shows
/// all. Every crossover is marked.
[[nodiscard]] BodeFigure device_bode_figure(std::span<const AnalysedDevice> devices, const BodeOptions& options = {});

/// The loop that a diagnosis is about, its damper closed, with the frequency that was observed and where its wall stands.
[[nodiscard]] BodeFigure diagnosis_figure(const Device& device, const Diagnosis& diagnosis);

}  // namespace zwidth::report

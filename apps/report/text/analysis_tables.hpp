#pragma once

#include <span>
#include <string>

#include "report/analysed_device.hpp"
#include "report/text/text_table.hpp"

namespace zwidth::report {

// The tables of an answer, shared by the text and the HTML report. Only headings where there is nothing to list.

/// Every phase crossover, by rising frequency.
[[nodiscard]] TextTable crossover_table(const AnalysedDevice& analysed, const Detail& detail = {});

/// The rigid body where springs tie it to ground, and the vibration modes.
[[nodiscard]] TextTable mode_table(const AnalysedDevice& analysed);

/// One row per device; names are cut to `name_width` characters.
[[nodiscard]] TextTable comparison_table(std::span<const AnalysedDevice> devices, std::size_t name_width);

/// What its columns mean.
[[nodiscard]] std::string comparison_legend(std::span<const AnalysedDevice> devices);

}  // namespace zwidth::report

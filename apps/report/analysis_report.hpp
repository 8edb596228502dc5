#pragma once

#include <optional>
#include <span>
#include <string>

#include "report/analysed_device.hpp"
#include "report/text/text_table.hpp"

namespace zwidth::report {

/// The answer as a person reads it: at most 100 columns, units with every number.
///
/// One device in full; several as a comparison table followed by a short answer for each.
[[nodiscard]] std::string analysis_text(std::span<const AnalysedDevice> devices, const Detail& detail = {});

/// The region that the page draws; none where it would take seconds, is refused, or holds no wall. Throws as region() does.
[[nodiscard]] std::optional<WallRegion> region_of_page(const AnalysedDevice& analysed, const Progress& progress = {});

/// The same as one self-contained HTML page, every device in full, with figures and the numbers of its file. Throws
/// OutputFailed when the figures cannot be drawn.
[[nodiscard]] std::string html_report(std::span<const AnalysedDevice> devices);

}  // namespace zwidth::report

#include <fmt/format.h>

#include <numbers>
#include <string>
#include <vector>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::report {
namespace {

/// Both at once, unlike the margins before it.
std::string disk_margin_note(const DiskMargin& disk) {
  const std::string gain =
      disk.gain_margin ? fmt::format("{} to {} times", number(*disk.lower_gain_margin), number(*disk.gain_margin))
                       : "any number of times";
  return fmt::format(
      "disk margin {}: stable while the loop's gain is off by {} and its phase by up to {}° at once{}",
      number(disk.alpha), gain, number(disk.phase_margin * 180.0 / std::numbers::pi),
      disk.frequency > 0.0 ? fmt::format("; least at {} Hz", number(0.5 * disk.frequency / std::numbers::pi)) : "");
}

}  // namespace

std::vector<std::string> wall_margin_notes(const Analysis& analysis) {
  const auto& wall = analysis.wall;
  if (!wall || !wall->stable) return {};
  std::vector<std::string> margins;
  for (const Remark& remark : analysis.remarks) {
    if (remark.severity == Remark::Severity::warning) margins.push_back(remark_line(remark));
  }
  if (wall->gain_margin) {
    margins.push_back(fmt::format("gain margin {:.2f} dB: unstable when {} {} times", decibels(*wall->gain_margin),
                                  wall->damping > 0.0 ? "stiffness and damping grow" : "the stiffness grows",
                                  number(*wall->gain_margin)));
  } else {
    margins.emplace_back("gain margin without limit: no larger gain destabilises it");
  }
  if (wall->lower_gain_margin) {
    margins.push_back(fmt::format(
        "lower gain margin {:.2f} dB: unstable when {} scaled down to {} times", decibels(*wall->lower_gain_margin),
        wall->damping > 0.0 ? "both are" : "the stiffness is", number(*wall->lower_gain_margin)));
  }
  if (wall->damping > 0.0 && wall->stiffness_margin) {
    margins.push_back(fmt::format("stiffness margin {:.2f} dB: unstable when the stiffness alone grows {} times",
                                  decibels(*wall->stiffness_margin), number(*wall->stiffness_margin)));
  }
  if (wall->phase_margin) {
    margins.push_back(fmt::format("phase margin {}° ({} rad)", number(*wall->phase_margin * 180.0 / std::numbers::pi),
                                  number(*wall->phase_margin)));
  }
  if (wall->delay_margin) margins.push_back("delay margin " + quantity(*wall->delay_margin, "s") + " of further delay");
  if (analysis.disk_margin) margins.push_back(disk_margin_note(*analysis.disk_margin));
  return margins;
}

}  // namespace zwidth::report

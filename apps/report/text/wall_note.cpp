#include "report/text/wall_note.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/analysed_device.hpp"
#include "report/text/quantity.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::report {
namespace {

/// Growth in percent per sample that cannot be told from none.
constexpr double growth_of_rounding = 1e-9;

std::string percent_text(double share) { return number(std::round(1000.0 * share) / 10.0) + " %"; }

/// The gain that the wall uses up: its stiffness, or where it has none its damping.
struct UsedGain {
  double value = 0.0;
  std::optional<double> limit;
};

std::string used_text(const UsedGain& gain, Holder holder) {
  if (!gain.limit || !(*gain.limit > 0.0) || !std::isfinite(*gain.limit)) return "";
  return fmt::format("{} of the limit with {}", percent_text(gain.value / *gain.limit), words_of(holder));
}

/// "56 % of the limit with nobody holding, ...": of every holder whose limit is finite.
std::string shares_text(const WallMargins& wall, const HoldingLimits& limits) {
  if (wall.stiffness == 0.0 && wall.damping == 0.0) return "";
  const auto used = [&wall](const HolderLimit& limit) {
    return wall.stiffness > 0.0 ? UsedGain{wall.stiffness, limit.critical_stiffness}
                                : UsedGain{wall.damping, limit.critical_damping};
  };
  std::vector<std::string> shares{used_text(used(limits.nobody), Holder::nobody)};
  if (limits.user) shares.push_back(used_text(used(*limits.user), Holder::user));
  if (limits.any_user) shares.push_back(used_text(used(*limits.any_user), Holder::any_user));
  std::erase(shares, "");
  return fmt::format("{}", fmt::join(shares, ", "));
}

std::string motion_text(const WallMargins& wall) {
  const double growth = 100.0 * (wall.spectral_radius - 1.0);
  if (std::abs(growth) < growth_of_rounding) return "what is set in motion neither grows nor comes to rest";
  if (wall.stable) return fmt::format("what moves longest decays by {} % per sample", number(-growth));
  return fmt::format("an oscillation grows by {} % per sample", number(std::max(growth, 0.0)));
}

std::string name_of_wall(const WallMargins& wall, const Units& units) {
  const std::string damper = fmt::format("{} {}", number(wall.damping), units.damping);
  if (wall.stiffness > 0.0) {
    return fmt::format("The wall of {}{}", quantity(wall.stiffness, units.stiffness),
                       wall.damping > 0.0 ? " and " + damper : "");
  }
  return wall.damping > 0.0 ? fmt::format("The damper of {} alone", damper) : "The wall without spring and damper";
}

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

std::string phase_text(double margin) {
  return fmt::format("phase margin {}° ({} rad)", number(margin * 180.0 / std::numbers::pi), number(margin));
}

/// What grows as the whole force does.
std::string_view whole_force(const WallMargins& wall) {
  if (wall.stiffness == 0.0) return "the damping grows";
  return wall.damping > 0.0 ? "stiffness and damping grow" : "the stiffness grows";
}

std::string_view whole_force_scaled(const WallMargins& wall) {
  if (wall.stiffness == 0.0) return "the damping is";
  return wall.damping > 0.0 ? "both are" : "the stiffness is";
}

/// Whether the analysis has no gain margin of the whole force, as beside a damper in a loop of its own.
bool leaves_gain_out(const Analysis& analysis) {
  return std::ranges::any_of(analysis.remarks, [](const Remark& each) {
    if (each.finding && each.finding->code == FindingCode::point_margins_left_out) return true;
    return each.finding && each.finding->code == FindingCode::left_out_beside_damper_loop &&
           std::ranges::find(each.finding->subjects, Subject{"what", "gain"}) != each.finding->subjects.end();
  });
}

void add_margins(const WallMargins& wall, bool gain_is_left_out, std::vector<std::string>& margins) {
  if (wall.gain_margin) {
    margins.push_back(fmt::format("gain margin {:.2f} dB: unstable when {} {} times", decibels(*wall.gain_margin),
                                  whole_force(wall), number(*wall.gain_margin)));
  } else if (!gain_is_left_out) {
    margins.emplace_back("gain margin without limit: no larger gain destabilises it");
  }
  if (wall.lower_gain_margin) {
    margins.push_back(fmt::format("lower gain margin {:.2f} dB: unstable when {} scaled down to {} times",
                                  decibels(*wall.lower_gain_margin), whole_force_scaled(wall),
                                  number(*wall.lower_gain_margin)));
  }
  if (wall.stiffness > 0.0 && wall.damping > 0.0 && wall.stiffness_margin) {
    margins.push_back(fmt::format("stiffness margin {:.2f} dB: unstable when the stiffness alone grows {} times",
                                  decibels(*wall.stiffness_margin), number(*wall.stiffness_margin)));
  }
  if (wall.phase_margin) margins.push_back(phase_text(*wall.phase_margin));
  if (wall.delay_margin) margins.push_back("delay margin " + quantity(*wall.delay_margin, "s") + " of further delay");
  if (wall.spring_delay_margin) {
    margins.push_back("delay margin of the spring alone " + quantity(*wall.spring_delay_margin, "s"));
  }
  if (wall.damper_delay_margin) {
    margins.push_back("delay margin of the damper alone " + quantity(*wall.damper_delay_margin, "s"));
  }
}

/// The margins with nobody holding beside those with the file's user, in one line.
std::string margins_alone(const WallMargins& wall, bool gain_is_left_out) {
  const std::string gain = wall.gain_margin   ? fmt::format("{:.2f} dB", decibels(*wall.gain_margin))
                           : gain_is_left_out ? std::string("left out")
                                              : std::string("without limit");
  std::string text = fmt::format("with {}: gain margin {}", words_of(Holder::nobody), gain);
  if (wall.phase_margin) text += ", " + phase_text(*wall.phase_margin);
  if (wall.delay_margin) text += ", delay margin " + quantity(*wall.delay_margin, "s");
  return text;
}

/// How far the wall's gain alone may grow in any hand.
std::optional<std::string> margin_with_any_user(const Analysis& analysis) {
  const WallMargins& wall = *analysis.wall;
  if (!analysis.limits.any_user || !analysis.wall_stable_for->any_user.value_or(false)) return std::nullopt;
  const bool has_spring = wall.stiffness > 0.0;
  const double limit = has_spring ? analysis.limits.any_user->critical_stiffness
                                  : analysis.limits.any_user->critical_damping.value_or(HUGE_VAL);
  const double ratio = limit / (has_spring ? wall.stiffness : wall.damping);
  if (!std::isfinite(ratio)) return std::nullopt;
  return fmt::format("with {}: {:.2f} dB, unstable with some user when the {} alone grows {} times",
                     words_of(Holder::any_user), decibels(ratio), has_spring ? "stiffness" : "damping", number(ratio));
}

/// No spring ties any body to ground.
bool is_free(const AnalysedDevice& analysed) {
  const auto& alone = analysed.analysis.alone;
  return analysed.device.has_bodies() &&
         !(alone ? alone->suspended_rigid_body : analysed.analysis.suspended_rigid_body);
}

}  // namespace

std::string wall_verdict(const Analysis& analysis) {
  return analysis.wall_stable_for ? std::string(words_of(stability_of(*analysis.wall_stable_for))) : "-";
}

std::optional<std::string> wall_note(const AnalysedDevice& analysed) {
  const Analysis& analysis = analysed.analysis;
  const auto& wall = analysis.wall;
  if (!wall || !analysis.wall_stable_for) return std::nullopt;
  const std::string shares = shares_text(*wall, analysis.limits);
  std::string text = fmt::format("{} is {}{}.", name_of_wall(*wall, units_of(analysed.device.parameters().motion)),
                                 wall_verdict(analysis), shares.empty() ? "" : ": " + shares);
  if (!analysis.alone || !analysis.alone->wall) {
    text += fmt::format(" With {} {}.", words_of(holder_of(analysis.limits)), motion_text(*wall));
  } else {
    text += fmt::format(" With {} {}; with {} {}.", words_of(Holder::nobody), motion_text(*analysis.alone->wall),
                        words_of(Holder::user), motion_text(*wall));
  }
  if (wall->stiffness == 0.0 && is_free(analysed)) text += " Nothing returns it to a place.";
  const bool is_known = analysis.wall_stable_for->any_user.has_value();
  if (stability_of(*analysis.wall_stable_for) == WallStability::alone_only && !is_known) {
    text += fmt::format(" Whether it is with {} is not known.", words_of(Holder::any_user));
  }
  return text;
}

std::vector<std::string> wall_margin_notes(const Analysis& analysis) {
  const auto& wall = analysis.wall;
  if (!wall || !analysis.wall_stable_for) return {};
  std::vector<std::string> notes;
  for (const Remark& remark : analysis.remarks) {
    if (remark.severity == Remark::Severity::warning) notes.push_back(remark_line(remark));
  }
  if (stability_of(*analysis.wall_stable_for) == WallStability::unstable) return notes;
  if (analysis.alone && analysis.alone->wall)
    notes.push_back(margins_alone(*analysis.alone->wall, leaves_gain_out(analysis)));
  std::vector<std::string> margins;
  add_margins(*wall, leaves_gain_out(analysis), margins);
  if (analysis.disk_margin) margins.push_back(disk_margin_note(*analysis.disk_margin));
  const std::string_view holder = words_of(holder_of(analysis.limits));
  for (const std::string& margin : margins) notes.push_back(fmt::format("with {}: {}", holder, margin));
  if (auto margin = margin_with_any_user(analysis)) notes.push_back(*std::move(margin));
  return notes;
}

}  // namespace zwidth::report

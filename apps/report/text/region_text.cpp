#include "report/text/region_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_filter_text.hpp"
#include "zwidth/finding_code.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t region_indent = 22;

class RegionWriter {
 public:
  RegionWriter(const Device& device, const WallRegion& walls, const Detail& detail)
      : device_(device), walls_(walls), detail_(detail), units_(units_of(device.parameters().motion)) {
    named_.modes = walls.modes;
    named_.suspended_rigid_body = walls.suspended_rigid_body;
  }

  [[nodiscard]] std::string text() const {
    std::string text = shortened(display_name(device_), line_width) + "\n";
    if (const auto note = trust_note(walls_.trust)) text += wrap(*note, line_width, 0);
    if (walls_.trust.refused()) return text;
    const StableRegion& region = walls_.region;
    if (!region.bounded) {
      return text + wrap("Every wall is stable: the force does not move what the wall senses.", line_width, 0) + "\n";
    }
    if (!region.stiffest) {
      return text +
             wrap(fmt::format("No wall is stable{}, with or without a virtual damper.",
                              walls_.nobody ? fmt::format(" with {}", words_of(Holder::user)) : std::string()),
                  line_width, 0) +
             "\n";
    }
    if (walls_.shared && !walls_.shared->stiffest) {
      return text +
             wrap(fmt::format("No wall is stable both with {} and with {}.", words_of(Holder::nobody),
                              words_of(Holder::user)),
                  line_width, 0) +
             "\n";
    }
    text += (walls_.shared ? shared_lines(*walls_.shared) : answer_lines()) + "\n" + meaning() + "\n";
    if (walls_.any_user) text += absolute_stability_paragraph() + "\n";
    if (detail_.formulas && !walls_.approximations.empty()) text += approximations() + "\n";
    for (const Remark& remark : walls_.remarks) text += wrap(remark_line(remark), line_width, 0) + "\n";
    return text + wrap(
                      "Linear and sampled: friction, encoder steps and the force limit are left out. The area is one "
                      "number for the Z-width: of all stable walls in the plane of K and B.",
                      line_width, 0);
  }

 private:
  [[nodiscard]] std::string line(std::string_view label, std::string_view content) const {
    return labelled(fmt::format("  {}", label), content, region_indent);
  }

  [[nodiscard]] std::string stiffness(double value) const { return quantity(value, units_.stiffness); }
  [[nodiscard]] std::string damping(double value) const { return fmt::format("{} {}", number(value), units_.damping); }

  [[nodiscard]] std::string where(const BoundaryPoint& point) const {
    if (!point.limited_by) return {};
    return fmt::format("; beyond it oscillates at {}, limited by {}", crossover_frequency_text(*point.frequency),
                       oscillator_name(named_, *point.limited_by));
  }

  [[nodiscard]] std::string answer_lines() const {
    const StableRegion& region = walls_.region;
    std::string lines = line("stable with", words_of(Holder::nobody));
    lines += line("largest K", fmt::format("{} with a virtual damper of {}{}", stiffness(region.stiffest->stiffness),
                                           damping(region.stiffest->damping), where(*region.stiffest)));
    lines += line("without a damper", region.critical_stiffness > 0.0
                                          ? fmt::format("{} (K_CR at B = 0)", stiffness(region.critical_stiffness))
                                          : std::string("no wall is stable from K = 0"));
    lines += line("largest B", fmt::format("{} at K = {}", damping(region.most_damped->damping),
                                           stiffness(region.most_damped->stiffness)));
    lines += line("Z-width (area)", area(region.area));
    return lines + wall_lines(*region.stiffest, *region.most_damped);
  }

  [[nodiscard]] std::string area(double value) const {
    return fmt::format("{:.4g} {} x {}", value, units_.stiffness, units_.damping);
  }

  /// The same of the walls that are stable with nobody and with the file's user.
  [[nodiscard]] std::string shared_lines(const SharedWalls& shared) const {
    const auto bounded_by = [&](const SharedPoint& end) {
      const auto frequency = end.point.frequency;
      return frequency ? fmt::format("; beyond it oscillates at {} with {}", crossover_frequency_text(*frequency),
                                     words_of(end.holder))
                       : std::string();
    };
    const BoundaryPoint& stiffest = shared.stiffest->point;
    const BoundaryPoint& most_damped = shared.most_damped->point;
    std::string lines = line("stable with", fmt::format("{} and {}: a person lets go of the handle",
                                                        words_of(Holder::nobody), words_of(Holder::user)));
    lines += line("largest K", fmt::format("{} with a virtual damper of {}{}", stiffness(stiffest.stiffness),
                                           damping(stiffest.damping), bounded_by(*shared.stiffest)));
    lines += line("without a damper",
                  shared.critical_stiffness > 0.0
                      ? fmt::format("{} (K_CR at B = 0, the lesser of both)", stiffness(shared.critical_stiffness))
                      : std::string("no wall is stable from K = 0"));
    lines +=
        line("largest B", fmt::format("{} at K = {}", damping(most_damped.damping), stiffness(most_damped.stiffness)));
    lines += line("Z-width (area)", area(shared.area));
    lines += holder_line(Holder::nobody, walls_.nobody->region);
    lines += holder_line(Holder::user, walls_.region);
    return lines + wall_lines(stiffest, most_damped);
  }

  [[nodiscard]] std::string holder_line(Holder holder, const StableRegion& region) const {
    if (!region.stiffest) return line(words_of(holder), region.bounded ? "no wall is stable" : "every wall is stable");
    return line(words_of(holder),
                fmt::format("up to {} at {}; {} without a damper", stiffness(region.stiffest->stiffness),
                            damping(region.stiffest->damping), stiffness(region.critical_stiffness)));
  }

  /// What the walls up to these are made with.
  [[nodiscard]] std::string wall_lines(const BoundaryPoint& stiffest, const BoundaryPoint& most_damped) const {
    std::string lines;
    if (const auto& force = walls_.force_per_count) {
      const auto at = [&](const BoundaryPoint& point) {
        return quantity(point.stiffness * force->per_stiffness + point.damping * force->per_damping, units_.force);
      };
      lines += line("force per count", fmt::format("{} at the largest K, {} at the largest B: one step of the encoder",
                                                   at(stiffest), at(most_damped)));
    }
    const double filter = device_.parameters().wall.velocity_filter_hz;
    lines += line("velocity filter", filter > 0.0 ? quantity(filter, "Hz") : std::string("none"));
    if (const auto filters = wall_filters_text(device_.parameters().wall)) {
      lines += line("filters in the wall", *filters);
    }
    return lines;
  }

  [[nodiscard]] std::string meaning() const {
    const StableRegion& region = walls_.region;
    const double undamped = walls_.shared ? walls_.shared->critical_stiffness : region.critical_stiffness;
    const BoundaryPoint& stiffest = walls_.shared ? walls_.shared->stiffest->point : *region.stiffest;
    std::string text;
    if (undamped > 0.0 && stiffest.damping > 0.0) {
      text = fmt::format("The right virtual damper makes the stiffest wall {} times as stiff as none. ",
                         number(stiffest.stiffness / undamped));
    }
    const bool is_sampled = std::ranges::any_of(walls_.remarks, [](const Remark& each) {
      return each.finding && each.finding->code == FindingCode::boundary_sampled;
    });
    text += is_sampled ? "Each point of the boundary is exact."
                       : "The boundary is exact: every wall inside is stable, every wall just outside is not.";
    if (region.components.size() > 1) {
      text += fmt::format(" The stable walls come in {} separate parts (see --json or a figure).",
                          region.components.size());
    }
    return wrap(text, line_width, 0);
  }

  [[nodiscard]] std::string absolute_stability_paragraph() const {
    const AbsoluteStabilityRegion& region = *walls_.any_user;
    const std::string anyone(words_of(WallStability::anyone));
    if (!region.stiffest) return wrap(fmt::format("No wall is {}: some user destabilises any.", anyone), line_width, 0);
    const auto& first = region.ranges.front().front();
    const std::string undamped =
        first.damping == 0.0 ? fmt::format("; {} without a damper", stiffness(first.stiffness)) : std::string();
    const double of_area = walls_.shared ? walls_.shared->area : walls_.region.area;
    std::string text =
        fmt::format("{}: up to {} with a damper of {}{}, and up to a damper of {}: {:.3g} % of the area above. {}.",
                    anyone, stiffness(region.stiffest->stiffness), damping(region.stiffest->damping), undamped,
                    damping(region.most_damped->damping), 100.0 * region.area / of_area,
                    region.is_bound ? std::string("That is a lower bound: others may be too")
                                    : fmt::format("The other walls are {}", words_of(WallStability::alone_only)));
    text.front() = 'S';
    return wrap(text, line_width, 0);
  }

  [[nodiscard]] std::string approximations() const {
    TextTable table{{Align::left, Align::left, Align::right, Align::right, Align::left, Align::left}, {}};
    table.rows.push_back({"formula", "", "K", "exact", "off at B = 0", "over all B"});
    std::string notes;
    for (const ComparedApproximation& each : walls_.approximations) {
      const RegionApproximation& formula = each.formula;
      const ApproximationError& error = each.error;
      const std::string off = (error.ratio ? fmt::format("{:+.2f} dB", decibels(*error.ratio)) : std::string("-")) +
                              (error.unsafe ? ", UNSAFE" : "");
      const std::string shares = error.unsafe_share
                                     ? fmt::format("{:.3g} % of it unsafe, {:.3g} % missed",
                                                   100.0 * *error.unsafe_share, 100.0 * *error.missed_share)
                                     : std::string("B = 0 only");
      const FormulaFacts facts = facts_of(formula.formula);
      table.rows.push_back({std::string(facts.name), formula.any_user ? "any user" : "this device",
                            stiffness(formula.at_zero_damping), stiffness(error.at_zero_damping), off, shares});
      notes += wrap(fmt::format("{}: {}. For a {}{}.", facts.source, facts.equation, facts.valid_for,
                                formula.not_met.empty()
                                    ? ""
                                    : fmt::format("; this device has {}", fmt::join(words_of(formula.not_met), ", "))),
                    line_width, 2);
    }
    return "Formulas of the literature beside it, K at B = 0 (b: damping of all bodies)\n" + layout(table) + notes;
  }

  const Device& device_;
  const WallRegion& walls_;
  Detail detail_;
  Analysis named_;  // the modes alone
  Units units_;
};

}  // namespace

std::string region_text(const Device& device, const WallRegion& walls, const Detail& detail) {
  return RegionWriter(device, walls, detail).text();
}

}  // namespace zwidth::report

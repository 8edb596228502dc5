#include "report/text/identification_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t most_rivals = 6;
constexpr std::size_t most_beside = 3;  ///< of pairs hardly told apart, and of recordings
/// What moves the limit by less is not shown.
constexpr double least_share_of_limit = 0.005;

/// How many of them are shown.
std::size_t shown_of(std::size_t count, std::size_t most, ShownFindings shown) {
  return shown == ShownFindings::all ? count : std::min(count, most);
}

/// `is_of_motion`: the response is where the fit began, and has in it what is not linear.
std::string fit_quality(const ParameterFit& fit, bool is_of_motion) {
  if (fit.frequencies.empty()) return "";
  std::string text = fmt::format("Response: {} points from {:.4g} to {:.4g} Hz", fit.frequencies.size(),
                                 hertz(fit.frequencies.front()), hertz(fit.frequencies.back()));
  if (fit.misfit) {
    text += is_of_motion ? fmt::format("; the linear device alone leaves {:.3g} times its noise", *fit.misfit)
                         : fmt::format("; residuals {:.3g} times the noise (1: the noise explains them)", *fit.misfit);
  }
  if (fit.model_error > 1e-4) {
    text += fmt::format("; {:.3g} % of the response unexplained beyond it", 100.0 * std::min(fit.model_error, 10.0));
  }
  return text + ".";
}

std::vector<std::string> motion_quality(std::span<const FittedMotion> motions, Motion motion, ShownFindings shown) {
  std::vector<std::string> items;
  for (const FittedMotion& each : motions.first(shown_of(motions.size(), most_beside, shown))) {
    items.push_back(fmt::format("{}noise of {} per sample; {:.3g} % of the motion unexplained.",
                                motions.size() > 1 ? each.source + ": " : "Motion: ",
                                quantity(each.noise, units_of(motion).length), 100.0 * each.unexplained));
  }
  return items;
}

/// "no damper", "the wall's damper of 5 N s/m closed": what a K_CR is given with.
std::string basis_text(const StiffnessBasis& basis, Motion motion) {
  std::string text = "no damper";
  if (basis.virtual_damping > 0.0) {
    text = fmt::format("the wall's damper of {} closed", quantity(basis.virtual_damping, units_of(motion).damping));
    if (basis.velocity_filter_hz > 0.0) {
      text += fmt::format(" behind its {} filter", quantity(basis.velocity_filter_hz, "Hz"));
    }
  }
  if (basis.filters > 0) text += fmt::format(", through the wall's {} filter(s)", basis.filters);
  return text;
}

/// Whether it moves the limit, or is clearly there.
bool matters(const RivalEstimate& rival, double limit) {
  const auto moves = [&](double end) { return !(std::abs(end / limit - 1.0) < least_share_of_limit); };
  const auto& range = rival.stiffness_interval;
  if (range && (moves(range->lower) || moves(range->upper))) return true;
  return rival.standard_deviation && std::abs(rival.value) > 2.0 * *rival.standard_deviation;
}

/// Of what else explains the records, what is shown.
std::vector<RivalEstimate> shown_rivals(const Identification& identified, ShownFindings shown) {
  std::vector<RivalEstimate> listed = identified.rivals;
  if (shown == ShownFindings::all) return listed;
  const double limit = identified.analysis.critical.stiffness;
  std::erase_if(listed, [&](const auto& each) { return !matters(each, limit); });
  listed.resize(std::min(listed.size(), most_rivals));
  return listed;
}

std::string rivals_text(const Identification& identified, ShownFindings shown) {
  if (identified.rivals.empty()) return "";
  const std::size_t listed = shown_rivals(identified, shown).size();
  std::string text = listed == 0 ? "" : "\n" + layout(rival_table(identified, shown));
  if (const std::size_t rest = identified.rivals.size() - listed; rest > 0) {
    text += listed == 0
                ? wrap(fmt::format("None of the {} other explanations fitted with it moves the limit by {:g} %: "
                                   "--explain lists them.",
                                   rest, 100.0 * least_share_of_limit),
                       line_width, 0)
                : fmt::format("  ... {} more that hardly count: add --explain\n", rest);
  }
  return text;
}

/// What the limit is of.
std::optional<std::string> limited_by(const Identification& identified) {
  const auto limit = what_limits(AnalysedDevice{identified.fit.device, identified.analysis});
  if (!limit || identified.trust.refused()) return std::nullopt;
  return "Limited by " + *limit + ".";
}

std::string paragraphs(const std::vector<std::string>& items, std::size_t indent) {
  std::string text;
  for (const std::string& each : items) text += wrap(each, line_width, indent);
  return text;
}

}  // namespace

std::string limit_line(const Identification& identified) {
  if (identified.trust.refused()) return "refused: no critical stiffness";
  const Analysis& analysis = identified.analysis;
  const Motion motion = identified.fit.device.parameters().motion;
  const auto value = [&](double stiffness) { return limit_value_text(stiffness, units_of(motion).stiffness); };
  std::string text = fmt::format("{}: critical stiffness {}", identified.trust.sound() ? "sound" : "doubtful",
                                 value(analysis.critical.stiffness));
  if (analysis.interval) {
    text += fmt::format(", 95 % from {} to {}", value(analysis.interval->lower), value(analysis.interval->upper));
  }
  return fmt::format("{} ({}, {})", text, analysis.alone ? "the file's user holding" : "nobody holding",
                     basis_text(identified.basis, motion));
}

std::vector<std::string> hardly_told_apart(const ParameterFit& fit, ShownFindings shown) {
  const std::span<const StrongCorrelation> strong(fit.correlations);
  std::vector<std::string> items;
  for (const StrongCorrelation& each : strong.first(shown_of(strong.size(), most_beside, shown))) {
    items.push_back(
        fmt::format("{} and {} are hardly told apart: correlation {:.3f}", each.first, each.second, each.correlation));
  }
  return items;
}

TextTable estimate_table(std::span<const ParameterEstimate> estimates, Motion motion) {
  TextTable table{{Align::left, Align::right, Align::left, Align::right, Align::right, Align::right},
                  {{"parameter", "value", "unit", "+-1 sigma", "95 % from", "to"}}};
  for (const ParameterEstimate& each : estimates) {
    std::vector<std::string> row = {each.key, number(each.value), parameter_unit(each.key, motion)};
    if (each.standard_deviation) {
      row.insert(row.end(), {number(*each.standard_deviation), number(*each.lower), number(*each.upper)});
    } else {
      row.insert(row.end(), {"not determined", "-", "-"});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable rival_table(const Identification& identified, ShownFindings shown) {
  const Units units = units_of(identified.fit.device.parameters().motion);
  TextTable table{{Align::left, Align::left, Align::right, Align::right, Align::right, Align::right},
                  {{"what else explains the record", "", "size", "+-1 sigma", "K_CR from", "to"}}};
  for (const RivalEstimate& each : shown_rivals(identified, shown)) {
    const auto size = [&](double found) {
      constexpr double rounding = 1e-12;  // of SI units: what the search leaves of a number that is 0
      const double value = std::abs(found) < rounding ? 0.0 : found;
      const bool takes_prefix = !each.unit.empty() && each.unit.find_first_of(" /") == std::string::npos;
      return takes_prefix ? quantity(value, each.unit) : number(value) + (each.unit.empty() ? "" : " " + each.unit);
    };
    const bool has_range = each.stiffness_interval.has_value() && !identified.trust.refused();
    const auto end = [&](double Interval::*which) {
      return has_range ? limit_value_text((*each.stiffness_interval).*which, units.stiffness) : "-";
    };
    std::string name = each.code;
    std::ranges::replace(name, '_', ' ');
    table.rows.push_back({std::move(name), each.parameter, size(each.value),
                          each.standard_deviation ? size(*each.standard_deviation) : "not determined",
                          end(&Interval::lower), end(&Interval::upper)});
  }
  return table;
}

std::string quality_of_fit(const Identification& identified) {
  const Motion motion = identified.fit.device.parameters().motion;
  std::vector<std::string> sentences = motion_quality(identified.motions, motion, ShownFindings::all);
  sentences.push_back(fit_quality(identified.fit, !identified.motions.empty()));
  return fmt::format("{}", fmt::join(sentences, " "));
}

std::string identification_text(const Identification& identified, ShownFindings shown) {
  const ParameterFit& fit = identified.fit;
  const Motion motion = fit.device.parameters().motion;
  const FindingsText findings = findings_text(identified.trust, identified.remarks, shown);
  std::string text = wrap(limit_line(identified), line_width, 0);
  text += fmt::format("{}, identified from {}", display_name(fit.device), identified.source);
  text += "\n" + findings.reasons + "\n";
  text += layout(estimate_table(fit.estimates, motion));
  if (const auto hardly = hardly_told_apart(fit, shown); !hardly.empty()) text += "\n" + paragraphs(hardly, 2);
  text += rivals_text(identified, shown) + "\n";
  if (const auto limit = limited_by(identified)) text += wrap(*limit, line_width, 0);
  text += paragraphs(motion_quality(identified.motions, motion, shown), 0);
  if (const std::string quality = fit_quality(fit, !identified.motions.empty()); !quality.empty())
    text += wrap(quality, line_width, 0);
  return text + findings.remarks;
}

std::string identification_text(const RigidBodyIdentification& identified, ShownFindings shown) {
  const RigidBodyFit& fit = identified.fit;
  std::string text = fmt::format("A rigid body, identified from {}\n", identified.source);
  const FindingsText findings = findings_text(identified.trust, identified.remarks, shown);
  text += findings.against;
  text += layout(estimate_table(estimates(fit), identified.device.parameters().motion)) + "\n";
  text += wrap(fmt::format("Inverse dynamics: low-pass of {:.4g} Hz without phase, every {}. sample, {} equations; the "
                           "residual force is {:.3g} % of the force (both rms). Intervals allow for residuals that are "
                           "correlated in time.",
                           fit.cutoff_hz, fit.decimation, fit.equations, 100.0 * fit.relative_residual),
               line_width, 0);
  return text + (identified.trust.sound() ? "Trust: sound.\n" : "") + findings.remarks;
}

}  // namespace zwidth::report

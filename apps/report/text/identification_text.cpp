#include "report/text/identification_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/remark_line.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::report {
namespace {

constexpr std::size_t width = 100;

std::string fit_quality(const ParameterFit& fit) {
  std::string text = fmt::format("{} points from {:.4g} to {:.4g} Hz", fit.frequencies.size(),
                                 hertz(fit.frequencies.front()), hertz(fit.frequencies.back()));
  if (fit.misfit) text += fmt::format("; residuals {:.3g} times the noise (1: the noise explains them)", *fit.misfit);
  if (fit.model_error > 1e-4) {
    text += fmt::format("; {:.3g} % of the response unexplained beyond it", 100.0 * std::min(fit.model_error, 10.0));
  }
  return text + ".";
}

std::string correlations(const ParameterFit& fit) {
  std::string text;
  for (const StrongCorrelation& each : fit.correlations) {
    text += wrap(
        fmt::format("{} and {} are hardly told apart: correlation {:.3f}", each.first, each.second, each.correlation),
        width, 2);
  }
  return text.empty() ? "" : "\n" + text;
}

std::string remarks(const std::vector<Remark>& all) {
  std::string text;
  for (const Remark& remark : all) {
    const std::string label = remark.severity == Remark::Severity::warning ? "  ! " : "  - ";
    text += wrap(remark_line(remark), width, 4).replace(0, label.size(), label);
  }
  return text.empty() ? "" : "\nRemarks\n" + text;
}

}  // namespace

TextTable estimate_table(std::span<const ParameterEstimate> estimates, Motion motion) {
  using Align = TextTable::Align;
  TextTable table{{Align::left, Align::right, Align::left, Align::right, Align::right, Align::right},
                  {{"parameter", "value", "unit", "+-1 sigma", "95 % from", "to"}}};
  for (const ParameterEstimate& each : estimates) {
    std::vector<std::string> row = {each.key, number(each.value), std::string(unit_of_parameter(each.key, motion))};
    if (each.standard_deviation) {
      row.insert(row.end(), {number(*each.standard_deviation), number(*each.lower), number(*each.upper)});
    } else {
      row.insert(row.end(), {"not determined", "-", "-"});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string identification_text(const IdentifiedDevice& identified) {
  const ParameterFit& fit = identified.fit;
  const Analysis& analysis = identified.analysed.analysis;
  std::string text = fmt::format("{}, identified from {}\n", display_name(fit.device), identified.source);
  text += layout(estimate_table(fit.estimates, fit.device.parameters().motion)) + correlations(fit) + "\n" +
          wrap(fit_quality(fit), width, 0) + "\n";
  text += trust_lines(identified.trust);
  if (identified.trust.refused()) return text + remarks(identified.remarks);
  const Motion motion = fit.device.parameters().motion;
  text += wrap(fmt::format("Critical stiffness of this device, {}: {}.", basis_text(identified.basis, motion),
                           critical_stiffness_text(analysis.critical, motion)),
               width, 0);
  if (const auto interval = interval_note(identified.analysed)) {
    text += wrap("95 % interval: " + *interval + ".", width, 0);
  }
  if (const auto limit = what_limits(identified.analysed)) text += wrap("Limited by " + *limit + ".", width, 0);
  return text + remarks(identified.remarks);
}

}  // namespace zwidth::report

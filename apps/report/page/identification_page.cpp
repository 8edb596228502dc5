#include "report/page/identification_page.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>

#include "report/analysis_report.hpp"
#include "report/document.hpp"
#include "report/figure/identification_figure.hpp"
#include "report/page/answer_box.hpp"
#include "report/page/html_page.hpp"
#include "report/text/device_table.hpp"
#include "report/text/explanation.hpp"
#include "report/text/identification_text.hpp"
#include "report/text/quantity.hpp"
#include "zwidth/ranked_findings.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::report {
namespace {

/// The limits of the fitted device, judged as the fit is; the fit has an interval of its own.
AnalysedDevice judged(const Device& device, const Trust& trust) {
  AnalysedDevice analysed = analysed_device(device);
  analysed.analysis.trust = trust;
  analysed.analysis.interval.reset();
  return analysed;
}

/// "95 % of the limit with nobody holding: 8.7 kN/m to 9 kN/m, over everything that explains the record as well."
std::string interval_of_fit(const Identification& identified) {
  const auto& interval = identified.analysis.interval;
  if (!interval || identified.trust.refused()) return "";
  const std::string_view unit = units_of(identified.fit.device.parameters().motion).stiffness;
  return fmt::format("95 % of the limit with {}: {} to {}, over everything that explains the record as well.",
                     words_of(identified.analysis.alone ? Holder::user : Holder::nobody),
                     limit_value_text(interval->lower, unit), limit_value_text(interval->upper, unit));
}

std::string page_of(const AnalysedDevice& analysed, const std::string& source, std::span<const Remark> remarks,
                    Document document) {
  document.part("What was found about it");
  std::vector<std::string> found;
  for (const RankedFinding& each : most_important(analysed.analysis.trust, remarks)) found.push_back(text(each.words));
  document.list(found);
  document.part("The device as fitted");
  document.table(device_table(analysed.device));
  const std::string title = fmt::format("{}, identified", display_name(analysed.device));
  return html_page(title, element("h1", title) + element("p", "From " + source + ".") + answer_box(analysed) +
                              std::move(document).str());
}

}  // namespace

std::string identification_page(const Identification& identified) {
  const ParameterFit& fit = identified.fit;
  const AnalysedDevice analysed = judged(fit.device, identified.trust);
  Document document(Medium::page);
  document.part();
  document.paragraph(interval_of_fit(identified));
  document.part("The numbers that were fitted");
  document.table(estimate_table(fit.estimates, fit.device.parameters().motion));
  document.part("What else explains the record, and the limit over its range");
  document.table(rival_table(identified, ShownFindings::all));
  document.part("The fit");
  if (!fit.frequencies.empty()) {
    document.figure("fit", "The fitted device over what was measured, and what the fit leaves.",
                    [&] { return draw_identification(identified, FigureFormat::svg); });
  }
  document.paragraph(quality_of_fit(identified));
  return page_of(analysed, identified.source, identified.remarks, std::move(document));
}

std::string identification_page(const RigidBodyIdentification& identified) {
  Document document(Medium::page);
  document.part("The numbers that were fitted");
  document.table(estimate_table(estimates(identified.fit), identified.device.parameters().motion));
  document.part("The fit");
  document.figure("fit", "The measured force and that of the fitted body, and what the fit leaves.",
                  [&] { return draw_identification(identified, FigureFormat::svg); });
  return page_of(judged(identified.device, identified.trust), identified.source, identified.remarks,
                 std::move(document));
}

}  // namespace zwidth::report

#include "report/page/identification_page.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>

#include "report/figure/identification_figure.hpp"
#include "report/page/answer_box.hpp"
#include "report/page/html_page.hpp"
#include "report/text/device_table.hpp"
#include "report/text/explanation.hpp"
#include "report/text/identification_text.hpp"
#include "zwidth/ranked_findings.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::report {
namespace {

std::string page_of(const Device& device, const std::string& source, const Trust& trust,
                    std::span<const Remark> remarks, Document document) {
  document.part("What was found about it");
  std::vector<std::string> found;
  for (const RankedFinding& each : most_important(trust, remarks)) found.push_back(text(each.words));
  document.list(found);
  document.part("The device as fitted");
  document.table(device_table(device));
  const std::string title = fmt::format("{}, identified", display_name(device));
  return html_page(title, element("h1", title) + element("p", "From " + source + ".") + std::move(document).str());
}

}  // namespace

void add_identification(Document& document, const Identification& identified) {
  const ParameterFit& fit = identified.fit;
  document.verbatim(answer_box({fit.device, analyze_fit(identified)}));
  document.paragraph(limit_line(identified));
  document.part("The numbers that were fitted");
  document.table(estimate_table(fit.estimates, fit.device.parameters().motion));
  document.list(hardly_told_apart(fit, ShownFindings::all));
  document.part("What else explains the record, and the limit over its range");
  document.table(rival_table(identified, ShownFindings::all));
  document.part("The fit");
  if (!fit.frequencies.empty()) {
    document.figure("fit", "The fitted device over what was measured, and what the fit leaves.",
                    [&] { return draw_identification(identified, FigureFormat::svg); });
  }
  document.paragraph(quality_of_fit(identified));
}

std::string identification_page(const Identification& identified) {
  Document document(Medium::page);
  add_identification(document, identified);
  return page_of(identified.fit.device, identified.source, identified.trust, identified.remarks, std::move(document));
}

std::string identification_page(const RigidBodyIdentification& identified) {
  const Device& device = identified.device;
  Document document(Medium::page);
  document.verbatim(answer_box({device, analyze_fit(identified)}));
  document.part("The numbers that were fitted");
  document.table(estimate_table(estimates(identified.fit), device.parameters().motion));
  document.part("The fit");
  document.figure("fit", "The measured force and that of the fitted body, and what the fit leaves.",
                  [&] { return draw_identification(identified, FigureFormat::svg); });
  return page_of(device, identified.source, identified.trust, identified.remarks, std::move(document));
}

}  // namespace zwidth::report

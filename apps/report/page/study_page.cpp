#include "report/page/study_page.hpp"

#include <fmt/format.h>

#include <optional>

#include "report/figure/study_figures.hpp"
#include "report/page/html_page.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/study_text.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::report {
namespace {

std::string figure(const std::optional<std::string>& svg, std::string_view name, std::string_view caption) {
  return svg ? html_figure(*svg, name, caption) : std::string();
}

std::string section(std::string_view heading, const TextTable& table) {
  return table.rows.size() < 2 ? std::string() : element("h2", heading) + html_table(table);
}

}  // namespace

std::string study_page(const StudyRun& run, const Study& study) {
  const std::string title = fmt::format("{}: a study of {} units", display_name(run.device()), study.samples);
  std::string body = element("h1", title) + "<div class=\"answer\">\n";
  if (const auto note = trust_note(study.trust)) body += element("p", *note);
  body += element("p", yield_sentence(run, study));
  const std::string rare = rare_sentence(study);
  if (!rare.empty()) body += element("p", rare);
  const std::string tightening = tightening_sentence(study);
  if (!tightening.empty()) body += element("p", tightening);
  body += "</div>\n";
  body += figure(draw_study_distribution(run, study, FigureFormat::svg), "distribution",
                 "Bars: units by their critical stiffness. Line: the yield of a specification at each stiffness.");
  body += section("Critical stiffness", quantile_table(run, study));
  body += section("What it depends on", parameter_table(study));
  body += figure(draw_study_tornado(study, FigureFormat::svg), "tornado",
                 study.sobol_indices ? "First-order and total Sobol indices: shares of the variance of K_CR."
                                     : "Yield gained where one parameter has half its spread, the others theirs.");
  body += figure(draw_study_scatter(run, study, FigureFormat::svg), "scatter",
                 "The two parameters that matter most; every point a unit, coloured by what limits it.");
  if (study.regions) {
    body += section(region_heading(run, study), region_table(run, study));
    if (const auto note = trust_note(study.regions->trust)) body += element("p", *note);
    body += figure(draw_study_regions(run, study, FigureFormat::svg), "regions",
                   "A wall below a line is stable, with every softer one of its damping, for that share of the units.");
  }
  body += section("Units that miss the specification", cluster_table(study));
  const std::string worst = worst_sentence(run, study);
  if (!worst.empty()) body += element("h2", "The worst unit") + element("p", worst);
  if (!study.remarks.empty()) body += element("h2", "Remarks");
  for (const Remark& remark : study.remarks) body += element("p", remark_line(remark));
  body +=
      "<footer>" + element("p", fmt::format("zwidth {}, seed {}", ZWIDTH_VERSION, run.options().seed)) + "</footer>";
  return html_page(title, body);
}

std::string worst_device_file(const StudyRun& run, const Study& study) {
  DeviceParameters device = study.worst->device;
  device.name = fmt::format("{}, worst unit of a study", display_name(run.device())).substr(0, max_name_size);
  Trust whole = study.trust;
  whole.inherit(study.worst->critical.trust);
  if (!whole.sound()) {
    Uncertainty& uncertainty = device.uncertainty.emplace();
    uncertainty.verdict = whole.verdict;
    uncertainty.reasons = whole.reasons;
  }
  return write_device(device);
}

}  // namespace zwidth::report

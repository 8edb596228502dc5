#include "report/study_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/document.hpp"
#include "report/figure/study_figures.hpp"
#include "report/page/html_page.hpp"
#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "report/worst_device.hpp"
#include "zwidth/model/mechanism_key.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::report {
namespace {

std::string unit_stiffness_text(const StudyRun& run, double value) {
  if (std::isnan(value)) return "not known";
  if (std::isinf(value)) return "unbounded";
  return quantity(value, units_of(run.device().parameters().motion).stiffness);
}

std::string wanted_text(const StudyRun& run) {
  const Specification& wanted = run.options().specification;
  std::string text;
  if (wanted.critical_stiffness) text = fmt::format("K_CR of {}", unit_stiffness_text(run, *wanted.critical_stiffness));
  if (wanted.any_user) {
    text += fmt::format("{}{} with any passive user", text.empty() ? "" : " and ",
                        unit_stiffness_text(run, *wanted.any_user));
  }
  return text;
}

std::string yield_sentence(const StudyRun& run, const Study& study) {
  if (!study.yield) return "Nothing is specified: there is no yield to state.";
  const Proportion& share = *study.yield;
  return fmt::format("{} of the units reach a {} (95 % interval {} to {}; {} of {} miss it).",
                     share_of_all_text(share.value), wanted_text(run), share_of_all_text(share.lower),
                     share_of_all_text(share.upper), share.total - share.count, share.total);
}

TextTable quantile_table(const StudyRun& run, const Study& study) {
  TextTable table{{Align::right, Align::right, Align::left}, {{"of the units", "have less than", "95 % interval"}}};
  if (run.options().any_user) {
    table.alignment.push_back(Align::right);
    table.rows[0].emplace_back(words_of(Holder::any_user));
  }
  const auto end = [&](const std::optional<double>& value) {
    return value ? unit_stiffness_text(run, *value) : std::string("?");
  };
  for (std::size_t i = 0; i < study.quantiles.size(); ++i) {
    const QuantileEstimate& each = study.quantiles[i];
    table.rows.push_back({fmt::format("{:g} %", 100.0 * each.probability), end(each.value),
                          each.value ? fmt::format("{} to {}", end(each.lower), end(each.upper))
                          : each.lower || each.upper
                              ? fmt::format("too few units: {} to {}", end(each.lower), end(each.upper))
                              : std::string("too few units")});
    if (run.options().any_user) table.rows.back().push_back(end(study.absolute_stability_quantiles[i].value));
  }
  return table;
}

TextTable parameter_table(const Study& study) {
  TextTable table{{Align::left}, {{"parameter"}}};
  if (study.sobol_indices) {
    table.alignment.insert(table.alignment.end(), 2, Align::right);
    table.rows[0].insert(table.rows[0].end(), {"share of variance alone", "with others"});
  }
  if (study.tightening) {
    table.alignment.push_back(Align::right);
    table.rows[0].emplace_back("yield gained by half the spread");
  }
  if (table.alignment.size() == 1) return table;
  for (std::size_t j = 0; j < study.keys.size(); ++j) {
    std::vector<std::string> row{study.keys[j]};
    if (study.sobol_indices) {
      const SobolIndex& index = (*study.sobol_indices)[j];
      constexpr double shown = 0.0005;  // less is 0, not -0
      const auto share = [](double value) { return std::abs(value) < shown ? 0.0 : value; };
      row.push_back(fmt::format("{:.3f} ± {:.3f}", share(index.first), index.first_error));
      row.push_back(fmt::format("{:.3f} ± {:.3f}", share(index.total), index.total_error));
    }
    if (study.tightening) {
      const TighteningGain& gain = (*study.tightening)[j];
      row.push_back(fmt::format("{:+.2f} ± {:.2f} %", 100.0 * gain.yield_gain, 100.0 * gain.error));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

TextTable cluster_table(const Study& study) {
  TextTable table{{Align::left, Align::right, Align::right, Align::left, Align::left},
                  {{"limited by", "units", "of failures", "at", "what they have in common"}}};
  for (const FailureCluster& each : study.clusters) {
    std::vector<std::pair<double, std::string>> marks;
    for (std::size_t j = 0; j < study.keys.size(); ++j) {
      const double score = each.mean_scores[j];
      constexpr double telling = 0.3;  // standard deviations off the middle
      if (std::abs(score) < telling) continue;
      marks.emplace_back(-std::abs(score),
                         fmt::format("{} {} ({:+.1f} s)", score > 0.0 ? "large" : "small", study.keys[j], score));
    }
    std::ranges::sort(marks);
    std::string common;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, marks.size()); ++i) {
      common += (i > 0 ? ", " : "") + marks[i].second;
    }
    const std::string at = each.lowest_frequency
                               ? fmt::format("{} to {}", quantity(hertz(*each.lowest_frequency), "Hz"),
                                             quantity(hertz(*each.highest_frequency), "Hz"))
                               : std::string("-");
    table.rows.push_back({oscillator_of(each.status, each.limited_by ? each.limited_by->mode : -1),
                          std::to_string(each.count), share_of_all_text(each.share), at,
                          common.empty() ? "nothing" : common});
  }
  return table;
}

std::string region_heading(const StudyRun& run, const Study& study) {
  if (!study.regions) return {};
  const Units units = units_of(run.device().parameters().motion);
  const std::string asked = fmt::format("Walls (K, B) of {} units", study.regions->units);
  if (study.regions->contours.empty()) return asked;
  return fmt::format("{}, at dampings in steps of {} {}", asked, number(study.regions->damping_step), units.damping);
}

TextTable region_table(const StudyRun& run, const Study& study) {
  TextTable table{{Align::right, Align::right, Align::left, Align::right, Align::right},
                  {{"of the units", "render K up to", "95 % interval", "at B of", "and B up to"}}};
  if (!study.regions) return table;
  const Units units = units_of(run.device().parameters().motion);
  const std::vector<double>& dampings = study.regions->dampings;
  for (const RegionContour& each : study.regions->contours) {
    std::size_t best = 0;
    std::size_t last = 0;
    for (std::size_t i = 0; i < dampings.size(); ++i) {
      if (each.stiffness[i] > each.stiffness[best]) best = i;
      if (each.stiffness[i] > 0.0) last = i;
    }
    std::vector<std::string> row{fmt::format("{:g} %", 100.0 * each.share), "none", "", "", ""};
    if (each.stiffness[best] > 0.0) {
      row[1] = unit_stiffness_text(run, each.stiffness[best]);
      row[2] = fmt::format("{} to {}", unit_stiffness_text(run, each.lower[best]),
                           unit_stiffness_text(run, each.upper[best]));
      row[3] = fmt::format("{} {}", number(dampings[best]), units.damping);
      row[4] = fmt::format("{} {}", number(dampings[last]), units.damping);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string worst_sentence(const StudyRun& run, const Study& study) {
  std::string text;
  for (const std::optional<WorstDevice>* found : {&study.worst, &study.worst_any_user}) {
    if (!*found) continue;
    const bool any_user = found == &study.worst_any_user;
    const WorstDevice& worst = **found;
    std::string numbers;
    for (std::size_t j = 0; j < study.keys.size(); ++j) {
      const Motion motion = motion_of_key(run.device().parameters(), study.keys[j]);
      numbers += fmt::format("{}{} {}", j > 0 ? ", " : "", study.keys[j],
                             parameter_text(study.keys[j], worst.values[j], motion));
    }
    const int mode = worst.critical.limit ? worst.critical.limit->limited_by.mode : -1;
    const std::string critical =
        fmt::format("K_CR {}, limited by {}", unit_stiffness_text(run, worst.critical.stiffness),
                    oscillator_of(worst.critical.status, mode));
    const std::string limits =
        any_user         ? fmt::format("{} ({})", unit_stiffness_text(run, *worst.any_user), critical)
        : worst.any_user ? fmt::format("{} ({} with any user)", critical, unit_stiffness_text(run, *worst.any_user))
                         : critical;
    const auto note = trust_note(worst.trust);
    text += fmt::format(
        "{}Worst unit{}: {}, where {}. The worst of the samples has {}; the search looked at the ends of the "
        "distributions, "
        "or at all but one unit in {:.0f}, and {} of its {} descents ended here.{}",
        text.empty() ? "" : " ", any_user ? " with any user" : "", limits, numbers,
        unit_stiffness_text(run, worst.sampled), 1.0 / worst.outside, worst.agreeing, worst.descents,
        note ? " " + *note : std::string());
  }
  return text;
}

std::string tightening_sentence(const Study& study) {
  if (!study.tightening) return {};
  if (!study.tighten_first) return "Half the spread of no single parameter raises the yield by more than chance.";
  return fmt::format("Tighten {} first: half its spread raises the yield by {:.2f} %.",
                     study.keys[*study.tighten_first], 100.0 * (*study.tightening)[*study.tighten_first].yield_gain);
}

std::string rare_sentence(const Study& study) {
  if (!study.rare_failures) return {};
  const RareFailures& rare = *study.rare_failures;
  const auto note = trust_note(rare.trust);
  return fmt::format("By importance sampling a share of {:.3g} misses it (95 % interval {:.3g} to {:.3g}).{}",
                     rare.share, rare.lower, rare.upper, note ? " " + *note : std::string());
}

/// What is said first.
std::string study_answer(const StudyRun& run, const Study& study, Medium medium) {
  Document document(medium);
  document.paragraph(trust_note(study.trust));
  if (study.trust.refused()) return std::move(document).str();
  document.paragraph(yield_sentence(run, study));
  if (study.reached_by_95_percent) {
    document.paragraph(fmt::format("95 % of all units reach {}, with 95 % confidence.",
                                   unit_stiffness_text(run, *study.reached_by_95_percent)));
  }
  if (study.none_stable + study.unbounded + study.failed_count > 0) {
    document.paragraph(fmt::format("Units without any stable wall: {}; unbounded: {}; without an answer: {}.",
                                   study.none_stable, study.unbounded, study.failed_count));
  }
  document.paragraph(rare_sentence(study));
  if (!document.is_page()) document.paragraph(worst_sentence(run, study));
  document.paragraph(tightening_sentence(study));
  return std::move(document).str();
}

std::string study_report(const StudyRun& run, const Study& study, Medium medium) {
  Document document(medium);
  const std::string answer = study_answer(run, study, medium);
  document.verbatim(document.is_page() ? answer_element(study.trust.verdict, answer)
                                       : shortened(display_name(run.device()), line_width) + "\n" + answer);
  if (study.trust.refused()) return std::move(document).str();
  document.figure("distribution",
                  "Bars: units by their critical stiffness. Line: the yield of a specification at each stiffness.",
                  [&] { return draw_study_distribution(run, study, FigureFormat::svg); });
  document.part(fmt::format("Critical stiffness K_CR with {}", words_of(holder_of(study.limits))));
  document.table(quantile_table(run, study));
  document.part("What it depends on");
  document.table(parameter_table(study));
  document.figure("tornado",
                  study.sobol_indices ? "First-order and total Sobol indices: shares of the variance of K_CR."
                                      : "Yield gained where one parameter has half its spread, the others theirs.",
                  [&] { return draw_study_tornado(study, FigureFormat::svg); });
  document.figure("scatter", "The two parameters that matter most; every point a unit, coloured by what limits it.",
                  [&] { return draw_study_scatter(run, study, FigureFormat::svg); });
  if (study.regions) {
    document.part(region_heading(run, study));
    document.table(region_table(run, study));
    document.paragraph(trust_note(study.regions->trust));
    document.figure("regions",
                    "A wall below a line is stable, with every softer one of its damping, for that share of the units.",
                    [&] { return draw_study_regions(run, study, FigureFormat::svg); });
  }
  document.part("Units that miss the specification (s: standard deviations from the middle)");
  document.table(cluster_table(study));
  document.part("The worst unit");
  if (document.is_page()) document.paragraph(worst_sentence(run, study));
  document.part("", "Remarks");
  for (const Remark& remark : study.remarks) document.paragraph(remark_line(remark));
  return std::move(document).str();
}

}  // namespace

std::string oscillator_of(StiffnessStatus status, int mode) {
  switch (status) {
    case StiffnessStatus::none_stable:
      return "no wall is stable";
    case StiffnessStatus::unbounded:
      return "unbounded";
    case StiffnessStatus::refused:
      return "no answer";
    case StiffnessStatus::finite:
      break;
  }
  return mode == 0 ? "the rigid body" : fmt::format("vibration mode {}", mode);
}

std::string study_text(const StudyRun& run, const Study& study) { return study_report(run, study, Medium::text); }

std::string study_page(const StudyRun& run, const Study& study) {
  const std::string title = fmt::format("{}: a study of {} units", display_name(run.device()), study.samples);
  return html_page(title, element("h1", title) + study_report(run, study, Medium::page),
                   fmt::format("Seed {}.", run.options().seed));
}

std::string worst_device_file(const Study& study) {
  Trust whole = study.trust;
  whole.inherit(study.worst->critical.trust);
  return worst_device_text(study.worst->device, "worst unit of a study", whole);
}

}  // namespace zwidth::report

#include <fmt/format.h>

#include <algorithm>

#include "report/page/html_page.hpp"
#include "report/text/text_table.hpp"
#include "reproduce/reproduction.hpp"

namespace zwidth::report {
namespace {

std::string numbers_table(const std::vector<PaperNumber>& numbers) {
  TextTable table{{Align::left, Align::left, Align::left, Align::left, Align::left, Align::left},
                  {{"where", "what", "printed", "ours", "difference", "reason"}}};
  for (const PaperNumber& number : numbers) {
    table.rows.push_back({number.place, number.what, number.printed, number.ours, number.difference, number.reason});
  }
  return "<div class=\"reasons\">\n" + html_table(table) + "</div>\n";
}

/// How many numbers and claims agree, and which do not.
std::string verdicts(const std::vector<PaperNumber>& numbers) {
  const auto count = [&](PaperVerdict verdict) { return std::ranges::count(numbers, verdict, &PaperNumber::verdict); };
  TextTable table{{Align::left, Align::left, Align::left, Align::left}, {{"", "where", "what", "difference"}}};
  for (const PaperVerdict verdict : {PaperVerdict::contradicts, PaperVerdict::differs}) {
    const std::string name = verdict == PaperVerdict::differs ? "differs" : "contradicts";
    for (const PaperNumber& each : numbers) {
      if (each.verdict == verdict) table.rows.push_back({name, each.place, each.what, each.difference});
    }
  }
  return fmt::format(
             "<div class=\"answer\">\n<p>Of the printed numbers and claims that can be compared</p>\n<p><b>{} agree, "
             "{} differ, "
             "{} contradict</b></p>\n",
             count(PaperVerdict::agrees), count(PaperVerdict::differs), count(PaperVerdict::contradicts)) +
         html_table(table) + element("p", "Ours and the reasons stand below the figures.") + "</div>\n";
}

}  // namespace

std::string reproduction_page(const std::vector<PaperFigure>& figures) {
  std::string body = element("h1", "The LHIfAM paper, reproduced");
  body += element("p",
                  "I. Díaz and J. J. Gil, Influence of Internal Vibration Modes on the Stability of Haptic Rendering: "
                  "what it prints, and what this program computes from the same data. Stiffness in decibels is "
                  "20 log10 of its value in N/m.");
  body +=
      element("p",
              "Sections IV to VI rest on a cable whose stiffness and damping appear in an image only. Wherever they "
              "are needed we use k_c = 27.55 kN/m and b_c = 10.5 N s/m (set A), inferred from the one crossover that "
              "is printed.");
  const std::vector<PaperNumber> numbers = paper_numbers();
  body += verdicts(numbers);
  body += element("h2", "Figures");
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const PaperFigure& figure = figures[i];
    body += html_figure(figure.svg, fmt::format("figure{}", i), figure.caption);
  }
  body += element("h2", "Numbers and claims") + numbers_table(numbers);
  body += element("h2", "Not reproduced");
  body += element("p", "Figures 1, 2, 5, 6 and 13: a photograph and diagrams.");
  return html_page("The LHIfAM paper, reproduced", body);
}

}  // namespace zwidth::report

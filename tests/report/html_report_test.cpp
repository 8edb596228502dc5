#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "report/analysis_report.hpp"
#include "report/example_analyses.hpp"
#include "report/figure/figures.hpp"
#include "report/page/html_page.hpp"
#include "report/text/quantity.hpp"
#include "report/text/text_table.hpp"

namespace zwidth::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string report_of(std::vector<AnalysedDevice> devices) { return html_report(devices); }

/// Nothing is fetched from anywhere, and no id is used twice.
void expect_self_contained(const std::string& page) {
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(page, Not(HasSubstr("<link")));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("src=")));
  std::set<std::string> ids;
  for (const std::string quote : {"\"", "'"}) {
    const std::string start = " id=" + quote;
    for (std::size_t at = page.find(start); at != std::string::npos; at = page.find(start, at + 1)) {
      const std::size_t from = at + start.size();
      const std::string id = page.substr(from, page.find(quote, from) - from);
      EXPECT_TRUE(ids.insert(id).second) << id;
    }
  }
}

std::size_t count_of(const std::string& page, std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = page.find(text); at != std::string::npos; at = page.find(text, at + 1)) ++count;
  return count;
}

TEST(HtmlReport, AnswersOnTopWithFiguresAndNumbers) {
  const std::string page = report_of({lhifam()});
  expect_self_contained(page);
  const std::size_t answer = page.find("8.849 kN/m");
  const std::size_t figure = page.find("<svg");
  ASSERT_NE(answer, std::string::npos);
  ASSERT_NE(figure, std::string::npos);
  EXPECT_LT(answer, figure);
  EXPECT_EQ(count_of(page, "<svg"), 2U);
  for (const char* text :
       {"then shakes at 6.143 Hz: the rigid body", "140.4 kN/m", "33.9 kN/m", "135.2 MN/m", "84.31 Hz",
        "With rigid links", "Nobody holds", "motor to handle: stiffness", "79500 N/m",
        "1   K = 78.94 dB (8.849 kN/m) at 38.6 rad/s (6.143 Hz), rigid body: critical, nobody holding",
        "3   K = 90.60 dB (33.9 kN/m) at 618.1 rad/s (98.37 Hz), vibration mode 1", "Magnitude (dB re 1 m/N)",
        "Phase (degrees)", "Frequency (Hz)", "Frequency (rad/s)", "Nyquist, 3142 rad/s (500 Hz)"}) {
    EXPECT_THAT(page, HasSubstr(text));
  }
}

TEST(HtmlReport, IsReadableOnDarkPaperAndOnAPhone) {
  const std::string page = html_page("a title", html_table({{Align::left}, {{"K_CR"}, {"1 kN/m"}}}));
  // Figures are drawn on white: they are turned round where the paper is dark.
  EXPECT_THAT(page, HasSubstr("@media screen and (prefers-color-scheme: dark)"));
  EXPECT_THAT(page, HasSubstr("figure svg image { filter: invert("));
  EXPECT_THAT(page, HasSubstr("width=device-width"));
  EXPECT_THAT(page, HasSubstr("<div class=\"wide\"><table>"));  // scrolls within
  EXPECT_THAT(page, HasSubstr("<th>K<sub>CR</sub></th>"));
}

TEST(HtmlReport, HoldsTheRegionAndTheDayOfWriting) {
  AnalysedDevice analysed = analysed_device(lhifam().device);
  analysed.walls = wall_summary(analysed.device, analysed.analysis);
  analysed.region = region_of_page(analysed);
  ASSERT_TRUE(analysed.region && analysed.walls->with_margins);
  ASSERT_EQ(setenv("SOURCE_DATE_EPOCH", "86400", 1), 0);  // NOLINT(concurrency-mt-unsafe): one thread
  const std::string page = report_of({analysed});
  unsetenv("SOURCE_DATE_EPOCH");  // NOLINT(concurrency-mt-unsafe)
  EXPECT_EQ(count_of(page, "<svg"), 3U);
  EXPECT_THAT(page, HasSubstr("on 1970-01-02."));
  EXPECT_THAT(page, HasSubstr(quantity(*analysed.walls->with_margins->wall.stiffness, "N/m")));
}

TEST(HtmlReport, TheEdgeOfTheAnswerIsItsVerdicts) {
  AnalysedDevice analysed = lhifam();
  EXPECT_THAT(report_of({analysed}), HasSubstr(R"(<div class="answer sound">)"));
  analysed.analysis.trust.doubt({.code = FindingCode::delay_not_shown});
  EXPECT_THAT(report_of({analysed}), HasSubstr(R"(<div class="answer doubtful">)"));
  analysed.analysis.trust.refuse({.code = FindingCode::delay_not_shown});
  EXPECT_THAT(report_of({analysed}), HasSubstr(R"(<div class="answer refused">)"));
}

TEST(HtmlReport, JudgesTheWall) {
  const std::string page = report_of({lhifam_with_wall()});
  EXPECT_THAT(page, HasSubstr("The wall of the file"));
  EXPECT_THAT(page, HasSubstr("gain margin"));
  EXPECT_THAT(page, HasSubstr("The virtual damper of 5 N s/m behind its 100 Hz filter is closed"));
  EXPECT_THAT(page, HasSubstr("the wall, 5 kN/m"));
}

TEST(HtmlReport, SaysWhatUsersLeave) {
  AnalysedDevice analysed = lhifam();
  EXPECT_THAT(report_of({analysed}), Not(HasSubstr("Users asked for")));
  analysed.analysis.any_user = AbsoluteStabilityLimit{5776.09, 259.9, 0.0};
  analysed.analysis.worst_user = WorstUser{{1.25, 0.0, {}}, 5776.5, 259.9};
  analysed.analysis.user_family =
      UserFamilyAnswer{{{0.0, 2.0}, {0.0, 1.0}, {0.0, 1e3}}, {{0.0, 0.0, 1e3}, 8829.0}, analysed.analysis.critical};
  const std::string page = report_of({analysed});
  for (const char* text : {"Users asked for", "any passive user", "5.776 kN/m, worst at 41.36 Hz", "a mass of 1.25 kg",
                           "users as given", "8.829 kN/m, least found, with mass 0 kg",
                           "asked for: mass 0 to 2 kg, damping 0 to 1 N s/m, stiffness 0 to 1000 N/m"}) {
    EXPECT_THAT(page, HasSubstr(text));
  }
}

TEST(HtmlReport, SpeaksOfRotaryUnitsAndOfNoStableWall) {
  const std::string page = report_of({undamped_paddle()});
  EXPECT_THAT(page, HasSubstr("none: the softest walls are unstable, stiffer ones are stable"));
  EXPECT_THAT(page, HasSubstr("dB re 1 rad/(N m)"));
  EXPECT_THAT(page, HasSubstr("K (N m/rad), from 0 on the left"));
  EXPECT_THAT(page, HasSubstr("kg m²"));
}

TEST(HtmlReport, EscapesWhatComesFromTheFile) {
  AnalysedDevice hostile = lhifam();
  DeviceParameters parameters = hostile.device.parameters();
  parameters.name = R"(<script>alert("1")</script>)";
  parameters.bodies[0].name = "<img src=x onerror=alert(1)>";
  hostile.device = Device(parameters);
  const std::string page = report_of({hostile});
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;"));
  EXPECT_THAT(page, Not(HasSubstr("<img")));
}

TEST(HtmlReport, ComparesSeveralDevicesFirst) {
  const std::string page = report_of({lhifam(), lhifam_with_wall()});
  expect_self_contained(page);
  EXPECT_LT(page.find("Critical stiffness of 2 devices"), page.find("1. LHIfAM"));
  EXPECT_THAT(page, HasSubstr("2. LHIfAM"));
  EXPECT_EQ(count_of(page, "<svg"), 5U);
  EXPECT_THAT(page, HasSubstr("A: LHIfAM, translational axis"));
}

TEST(HtmlReport, LinearAndRotaryDevicesShareNoFigure) {
  const std::string page = report_of({lhifam(), undamped_paddle(), unlimited_transfer_function()});
  EXPECT_EQ(count_of(page, "<svg"), 6U);
  EXPECT_THAT(page, HasSubstr("&lt;b&gt;red &amp; &quot;name&quot; µ"));
  EXPECT_THAT(page, HasSubstr("unbounded: every wall is stable"));
  EXPECT_THAT(page, HasSubstr("There is none."));
}

TEST(StiffnessAxis, ShowsEveryInterval) {
  const std::string svg = draw_stiffness_axis(undamped_paddle(), FigureFormat::svg);
  EXPECT_EQ(count_of(svg, "'rgb(219, 231, 246)'"), 2U);  // stable alone only: the interval, and the legend
  EXPECT_EQ(count_of(svg, ">stable alone only<"), 1U);   // too narrow for the words: in the legend
  EXPECT_EQ(count_of(svg, ">unstable<"), 3U);
}

// The report printed the limit with the user as its headline.
TEST(HtmlReport, TheFirstLimitIsTheOneThatHoldsWhenTheUserLetsGo) {
  const std::string page = report_of({knob_in_a_hand()});
  const std::size_t alone = page.find("<dt>nobody holding</dt><dd>14.21 N m/rad</dd>");
  EXPECT_NE(alone, std::string::npos);
  EXPECT_LT(alone, page.find("<dt>the file&#39;s user</dt>"));
  for (const char* text : {"nobody holding", "the file&#39;s user", "any passive user"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
}

// Between the two limits the wall is not stable: a person lets go.
TEST(StiffnessAxis, IsStableOnlyWhereItIsWithAndWithoutTheUser) {
  const std::string svg = draw_stiffness_axis(knob_in_a_hand(), FigureFormat::svg);
  EXPECT_EQ(count_of(svg, ">unstable<"), 2U);  // one of them in the legend
  EXPECT_THAT(svg, HasSubstr("nobody holding, 14.21 N m/rad"));
}

TEST(StiffnessAxis, NamesTheCriticalAndTheApproximateOnes) {
  const std::string svg = draw_stiffness_axis(lhifam(), FigureFormat::svg);
  EXPECT_THAT(svg, HasSubstr("1: nobody holding, 8.849 kN/m"));
  EXPECT_THAT(svg, HasSubstr("rigid model, 7.001 kN/m"));
  EXPECT_THAT(svg, HasSubstr("Q, 8.469 kN/m"));
}

}  // namespace
}  // namespace zwidth::report

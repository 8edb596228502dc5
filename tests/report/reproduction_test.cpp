#include "reproduce/reproduction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace zwidth::report {
namespace {

using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::StartsWith;

const std::vector<PaperNumber>& numbers() {
  static const std::vector<PaperNumber> computed_once = paper_numbers();
  return computed_once;
}

/// The row whose `what` starts so.
PaperNumber row(const std::string& what) {
  for (const PaperNumber& number : numbers()) {
    if (number.what.starts_with(what)) return number;
  }
  ADD_FAILURE() << "no row " << what;
  return {};
}

TEST(Reproduction, DrawsTheFigures) {
  std::set<std::string> files;
  for (const PaperFigure& figure : paper_figures()) {
    files.insert(figure.file);
    EXPECT_THAT(figure.svg, HasSubstr("</svg>"));
    EXPECT_FALSE(figure.caption.empty());
    EXPECT_THAT(figure.svg, HasSubstr(figure.title));
  }
  EXPECT_THAT(files, IsSupersetOf({"figure_03.svg", "figure_07.svg", "figure_09.svg", "figure_10.svg", "figure_11.svg",
                                   "figure_12.svg", "figure_14.svg"}));
}

TEST(Reproduction, LockedChirpsFindTheCableAndSayThatTheyAreSynthetic) {
  const auto figures = paper_figures();
  for (const char* file : {"figure_04.svg", "figure_08.svg"}) {
    const auto figure =
        std::find_if(figures.begin(), figures.end(), [&](const auto& each) { return each.file == file; });
    ASSERT_NE(figure, figures.end()) << file;
    EXPECT_THAT(figure->svg, HasSubstr("synthetic record"));
    EXPECT_THAT(figure->caption, StartsWith("Synthetic"));
  }
  struct Cable {
    std::string place;
    double stiffness;  // kN/m
    double damping;    // N s/m
  };
  for (const Cable& cable : {Cable{"Fig. 4", 79.5, 15.0}, Cable{"Fig. 8", 27.55, 10.5}}) {
    int rows = 0;
    for (const PaperNumber& number : numbers()) {
      if (!number.place.starts_with(cable.place)) continue;
      ++rows;
      const bool stiffness = number.what.starts_with("Cable stiffness");
      const double truth = stiffness ? cable.stiffness : cable.damping;
      EXPECT_NEAR(std::stod(number.ours), truth, (stiffness ? 0.01 : 0.05) * truth) << number.what;
      EXPECT_THAT(number.reason, HasSubstr("seed 1"));
    }
    EXPECT_EQ(rows, 2) << cable.place;
  }
}

// Ours as the theory notes give them, section 2 and section 3.
TEST(Reproduction, OursAreTheKnownValues) {
  EXPECT_EQ(row("Mass m").ours, "5.4 kg");
  EXPECT_EQ(row("Damping b").ours, "3.5 N s/m");
  EXPECT_EQ(row("Q of Table I").ours, "78.5565 dB (8468.9 N/m)");
  EXPECT_EQ(row("Q of Table I").printed, "78.16 dB");
  EXPECT_EQ(row("Q of Table I").difference, "+0.40 dB");
  EXPECT_THAT(row("Q of Table I").reason, HasSubstr("79.044 dB for G_m and 79.146 dB for Z[H G_m]"));
  EXPECT_EQ(row("Gain margin with the mode").ours, "78.938 dB with, 76.903 dB rigid");
  EXPECT_THAT(row("Gain margin with the mode").reason, HasSubstr("26 %"));
  EXPECT_EQ(row("Phase crossover with reduced").ours, "411.2257 rad/s");
  EXPECT_THAT(row("Number of phase crossovers").ours, StartsWith("1 below Nyquist"));
  EXPECT_EQ(row("Inherent delay").ours, "80.216 dB at 37.7 rad/s with 250 µs");
  EXPECT_THAT(row("Inherent delay").reason, HasSubstr("60.5 Hz and 83.83 dB"));
  EXPECT_EQ(row("Margin computed for Fig. 9").ours, "6.98 dB");
  EXPECT_EQ(row("Handle sensed").ours, "the rigid body: 76.638 dB at 35.69 rad/s");
  EXPECT_THAT(row("Factorised form").ours, HasSubstr("2.1e-08"));
}

TEST(Reproduction, ThePageHoldsEveryRowAndFigure) {
  const auto figures = paper_figures();
  const std::string page = reproduction_page(figures);
  EXPECT_THAT(page, ::testing::Not(HasSubstr("http")));
  for (const PaperFigure& figure : figures) EXPECT_THAT(page, HasSubstr(figure.title));
  EXPECT_THAT(page, HasSubstr("411.2257 rad/s"));
  EXPECT_THAT(page, HasSubstr("Not reproduced"));
  EXPECT_LT(page.find("<b>"), page.find("<svg"));
}

TEST(Reproduction, EachNumberHasAVerdict) {
  const auto count = [](PaperVerdict verdict) { return std::ranges::count(numbers(), verdict, &PaperNumber::verdict); };
  EXPECT_EQ(row("Mass m").verdict, PaperVerdict::agrees);
  EXPECT_EQ(row("Q of Table I").verdict, PaperVerdict::differs);
  EXPECT_EQ(row("When the mode matters").verdict, PaperVerdict::contradicts);
  EXPECT_EQ(row("Phase crossover with reduced").verdict, PaperVerdict::none);  // ours is inferred from it
  EXPECT_EQ(count(PaperVerdict::contradicts), 1);
  EXPECT_GE(count(PaperVerdict::agrees), 10);
}

}  // namespace
}  // namespace zwidth::report

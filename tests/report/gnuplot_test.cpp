#include "report/figure/gnuplot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <string>

#include "report/figure/canvas.hpp"
#include "report/output_file.hpp"
#include "report/text/markup.hpp"

namespace zwidth::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string failure_of(const std::string& script, std::chrono::milliseconds limit = std::chrono::seconds(20)) {
  try {
    (void)run_gnuplot(script, limit);
  } catch (const OutputFailed& failure) {
    return failure.what();
  }
  return "no failure";
}

TEST(Gnuplot, ReturnsThePicture) { EXPECT_THAT(run_gnuplot("set terminal svg\nplot x\n"), HasSubstr("<svg")); }

TEST(Gnuplot, AScriptErrorIsReportedOnOneLine) {
  const std::string failure = failure_of("plot nonsense(\n");
  EXPECT_THAT(failure, StartsWith("gnuplot failed: "));
  EXPECT_THAT(failure, Not(HasSubstr("\n")));
}

TEST(Gnuplot, AHangingOneIsKilled) {
  EXPECT_THAT(failure_of("pause 30\n", std::chrono::milliseconds(300)), HasSubstr("did not finish"));
}

TEST(Gnuplot, OneThatStopsReadingALongScriptIsNoCrash) {
  EXPECT_THAT(failure_of("exit\n" + std::string(4 << 20, '#')), StartsWith("gnuplot failed"));
}

TEST(Gnuplot, MissingIsSaidWithTheRemedy) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", "/nonexistent", 1);
  const std::string failure = failure_of("plot x\n");
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(failure, HasSubstr("apt-get install gnuplot-nox"));
}

TEST(Canvas, TextFromAFileIsDrawnAsItIs) {
  const std::string hostile = R"(<b> & {/Symbol a} a_b ^2 \n `touch /tmp/zwidth_must_not_exist` 'quoted' "%s" µ)";
  Canvas canvas(hostile, 400, 100);
  canvas.text(10, 50, hostile);
  canvas.commands("set xrange [0:1]\nset yrange [0:1]");
  canvas.plot({20, 380, 10, 90}, "NaN notitle");
  const std::string svg = canvas.draw(FigureFormat::svg);
  EXPECT_THAT(svg,
              HasSubstr("&lt;b> &amp; {/Symbol a} a_b ^2 \\n `touch /tmp/zwidth_must_not_exist` 'quoted' \"%s\" µ"));
  EXPECT_THAT(svg, Not(HasSubstr("<b>")));
}

TEST(Canvas, DrawsEveryFormat) {
  Canvas canvas("title", 400, 100);
  canvas.plot({20, 380, 10, 90}, "x");
  EXPECT_THAT(canvas.draw(FigureFormat::svg), HasSubstr("</svg>"));
  EXPECT_THAT(canvas.draw(FigureFormat::png), StartsWith("\x89PNG"));
  EXPECT_THAT(canvas.draw(FigureFormat::pdf), StartsWith("%PDF"));
}

TEST(Canvas, FormatsAreToldByExtension) {
  EXPECT_EQ(figure_format("a.b/c.SVG"), FigureFormat::svg);
  EXPECT_EQ(figure_format("x.png"), FigureFormat::png);
  EXPECT_EQ(figure_format("x.pdf"), FigureFormat::pdf);
  EXPECT_EQ(figure_format("x.jpg"), std::nullopt);
  EXPECT_EQ(figure_format("svg"), std::nullopt);
}

TEST(Canvas, LongTextIsCutBetweenLetters) {
  EXPECT_EQ(Canvas::fitted("short", 12, 400), "short");
  const std::string cut = Canvas::fitted(std::string(50, 'x').append("µµµµ"), 12, 380);
  EXPECT_THAT(cut, ::testing::EndsWith("…"));
  EXPECT_LE(Canvas::text_width(cut, 12), 380);
}

TEST(Markup, InlineFiguresKeepTheirIdsApart) {
  const std::string svg =
      R"(<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg"><g id="a"/><use xlink:href='#a'/></svg>)";
  EXPECT_EQ(inline_svg(svg, "f1"), R"(<svg><g id="f1-a"/><use xlink:href='#f1-a'/></svg>)");
}

TEST(Markup, EscapesWhatHtmlWouldRead) {
  EXPECT_EQ(escape_markup("<script>'x' & \"y\"\x01</script>"),
            "&lt;script&gt;&#39;x&#39; &amp; &quot;y&quot; &lt;/script&gt;");
}

TEST(Gnuplot, SymbolsHaveSubscriptsAndNamesStandAsTheyAre) {
  EXPECT_EQ(gnuplot_text("motor_2, 5 kN/m^2"), "'motor_2, 5 kN/m^2' noenhanced");
  EXPECT_EQ(gnuplot_text("K_CR (kN/m)"), "'K_{CR} (kN/m)' enhanced");
  EXPECT_EQ(gnuplot_text("K_CR of it's a_b {c}^@&~\\"), "'K_{CR} of it''s a\\_b \\{c\\}\\^\\@\\&\\~\\\\' enhanced");
  EXPECT_EQ(gnuplot_text("Z[H G e^(-t_d s)]"), "'Z[H G e^{-t_d s}]' enhanced");
  EXPECT_EQ(gnuplot_text("G_m(s), k_c"), "'G_{m}(s), k_{c}' enhanced");
  EXPECT_EQ(html_text("K_CR < 5 & t_d', MAX_K_CR"), "K<sub>CR</sub> &lt; 5 &amp; t<sub>d</sub>&#39;, MAX_K_CR");
  EXPECT_EQ(gnuplot_text("MAX_K_CR, t_delay"), "'MAX_K_CR, t_delay' noenhanced");
}

}  // namespace
}  // namespace zwidth::report

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "report/figure/figures.hpp"
#include "report/text/frf_text.hpp"
#include "results/frf_json.hpp"

namespace zwidth::report {
namespace {

using results::frf_csv;
using results::frf_json;
using results::FrfContent;
using results::FrfUnits;

using ::testing::HasSubstr;

/// A rigid body of 5.4 kg whose phase falls evenly from -170 to -190 degrees between 1 and 41 Hz: -180 at 21 Hz.
FrequencyResponse falling_phase(double relative_deviation) {
  FrequencyResponse response;
  response.sampling_period = 1e-3;
  response.averages = 10.0;
  for (int line = 1; line <= 41; ++line) {
    const double w = 2.0 * std::numbers::pi * line;
    const double degrees = -170.0 - 0.5 * (line - 1);
    const double magnitude = 1.0 / (5.4 * w * w);
    response.points.push_back({w, std::polar(magnitude, degrees * std::numbers::pi / 180.0),
                               std::pow(relative_deviation * magnitude, 2), 0.99});
  }
  return response;
}

const double stiffness_at_21_hz = 5.4 * std::pow(2.0 * std::numbers::pi * 21.0, 2);

MeasuredResponse example(double relative_deviation = 1e-3) {
  return judged_response("run.csv", falling_phase(relative_deviation), {{Remark::Severity::note, "a note", ""}});
}

TEST(FrfUnits, AreQuotientsWithBracketsWhereNeeded) {
  EXPECT_EQ((FrfUnits{"N", "m"}).stiffness(), "N/m");
  EXPECT_EQ((FrfUnits{"N m", "rad"}).stiffness(), "N m/rad");
  EXPECT_EQ((FrfUnits{"N m", "rad"}).compliance(), "rad/(N m)");
}

TEST(FrfPoints, UnwrapThePhaseAndLeaveOpenBoundsOut) {
  FrequencyResponse response = falling_phase(1e-3);
  response.points[3].variance = std::norm(response.points[3].value);  // the disc holds 0
  const auto points = response_lines(response);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points[i].phase * 180.0 / std::numbers::pi, -170.0 - 0.5 * static_cast<double>(i), 1e-9);
  }
  EXPECT_EQ(points[3].magnitude_lower, 0.0);
  EXPECT_FALSE(points[3].phase_lower);
  EXPECT_NEAR(*points[4].phase_upper - points[4].phase, points[4].phase - *points[4].phase_lower, 1e-12);
  response.averages = 0.0;
  response.points[5].variance = 0.0;
  EXPECT_FALSE(response_lines(response)[5].magnitude_upper);
}

TEST(FrfJson, HoldsTheAnswerAndOnlyOnRequestTheLines) {
  const auto document = frf_json(example());
  EXPECT_EQ(document["status"], "found");
  EXPECT_NEAR(document["critical_stiffness"], stiffness_at_21_hz, 3e-3 * stiffness_at_21_hz);
  EXPECT_LT(document["critical_stiffness_interval"][0], stiffness_at_21_hz);
  EXPECT_GT(document["critical_stiffness_interval"][1], stiffness_at_21_hz);
  EXPECT_LT(document["critical_frequency_interval_hz"][0], 21.0);
  EXPECT_GT(document["critical_frequency_interval_hz"][1], 21.0);
  EXPECT_NEAR(document["critical_stiffness_db"], 20.0 * std::log10(document["critical_stiffness"].get<double>()), 1e-9);
  EXPECT_EQ(document["crossovers"].size(), 1U);
  EXPECT_EQ(document["remarks"][0]["what"], "a note");
  EXPECT_FALSE(document.contains("magnitude"));
  const auto with_lines = frf_json(example(), {}, FrfContent::with_lines);
  EXPECT_EQ(with_lines["magnitude"].size(), 41U);
  EXPECT_EQ(with_lines["phase_upper_rad"].size(), 41U);
}

TEST(FrfJson, AnUndeterminedStiffnessIsNullAndBoundedAbove) {
  MeasuredResponse frf = example();
  frf.stiffness->status = MeasuredStiffnessStatus::undetermined;
  frf.stiffness->doubtful_bands = {{6.0, 12.0}};
  const auto document = frf_json(frf);
  EXPECT_EQ(document["status"], "undetermined");
  EXPECT_TRUE(document["critical_stiffness"].is_null());
  EXPECT_TRUE(document["critical_stiffness_interval"].is_null());
  EXPECT_NEAR(document["softest_proven"]["stiffness"], stiffness_at_21_hz, 3e-3 * stiffness_at_21_hz);
  EXPECT_NEAR(document["doubtful_bands_hz"][0][0], 6.0 / (2.0 * std::numbers::pi), 1e-12);
  EXPECT_THAT(frf_text(frf), HasSubstr("unknown, at most"));
}

TEST(FrfJson, ASingleLineAndAContinuousResponseHaveNoStiffness) {
  FrequencyResponse response = falling_phase(1e-3);
  response.points.resize(1);
  EXPECT_TRUE(frf_json(judged_response("run.csv", response), {}, FrfContent::with_lines)["status"].is_null());
  response = falling_phase(1e-3);
  response.sampling_period.reset();
  const MeasuredResponse continuous = judged_response("run.csv", response);
  EXPECT_TRUE(frf_json(continuous)["critical_stiffness"].is_null());
  EXPECT_THAT(frf_text(continuous), HasSubstr("not to be had"));
}

TEST(FrfText, SaysTheAnswerWithItsIntervalAndEveryRemark) {
  const std::string text = frf_text(example());
  EXPECT_THAT(text, HasSubstr("critical stiffness  94."));
  EXPECT_THAT(text, HasSubstr("95 % between"));
  EXPECT_THAT(text, HasSubstr("<- critical"));
  EXPECT_THAT(text, HasSubstr("  - a note\n"));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
}

TEST(FrfCsv, HasOneRowPerLineWithAllDigits) {
  MeasuredResponse measured = example();
  measured.trust.doubt({.code = FindingCode::limit_outside_band,
                        .evidence = {{"frequency", 50.0}, {"lowest", 1.0}, {"highest", 41.0}},
                        .subjects = {{"side", "above"}}});
  const FrequencyResponse& response = measured.response;
  std::istringstream rows(frf_csv(measured));
  std::string row;
  std::getline(rows, row);
  EXPECT_THAT(row, HasSubstr("frequency_hz,magnitude"));
  std::size_t count = 0;
  for (; std::getline(rows, row); ++count) {
    const auto reasons = row.find('"');  // of the verdict, in the first row: the last column
    EXPECT_EQ(count == 0, reasons != std::string::npos);
    EXPECT_EQ(std::ranges::count(row.substr(0, reasons), ','), 12);
    EXPECT_EQ(std::stod(row), response.points[count].frequency);
  }
  EXPECT_EQ(count, response.points.size());
}

TEST(FrfFigure, IsDrawnWithDoubtsUnknownBoundsAndManyLines) {
  MeasuredResponse frf = example();
  EXPECT_THAT(draw_frf(frf, {}, FigureFormat::svg), HasSubstr("Coherence"));
  frf.stiffness->doubtful_bands = {{6.0, 12.0}};
  frf.response.averages = 1.0;
  frf.response.points[4].value = 0.0;
  EXPECT_THAT(draw_frf(frf, {}, FigureFormat::svg), HasSubstr("</svg>"));

  FrequencyResponse fine = falling_phase(1e-3);
  std::vector<ResponsePoint> many;
  for (int i = 0; i < 100000; ++i) {
    many.push_back(fine.points[static_cast<std::size_t>(i) * 41 / 100000]);
    many.back().frequency = 1.0 + 0.01 * i;
  }
  many[50000].value *= 1e3;  // a peak of one line is still seen
  fine.points = many;
  const std::string figure = draw_frf({"run.csv", fine, std::nullopt, {}, {}}, {}, FigureFormat::svg);
  EXPECT_LT(figure.size(), 1000000U);
}

}  // namespace
}  // namespace zwidth::report

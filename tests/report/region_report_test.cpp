// Text, JSON, csv and figure of a region. Computed once: the absolute stability limit takes most of the time.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "lhifam.hpp"
#include "report/figure/figures.hpp"
#include "report/json_keys.hpp"
#include "report/text/region_text.hpp"
#include "results/region_json.hpp"

namespace zwidth::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Json = results::Json;

/// A device and its region.
struct Drawn {
  explicit Drawn(const DeviceParameters& parameters) : device(parameters), walls(zwidth::region(device)) {}
  Device device;
  WallRegion walls;
};

const Drawn& lhifam_region() {
  static const Drawn drawn(test::lhifam_parameters());
  return drawn;
}

Drawn transfer_function_region() { return Drawn(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1.0)); }

Json region_json(const Drawn& drawn) { return results::region_json(drawn.device, drawn.walls); }
std::string region_text(const Drawn& drawn) { return report::region_text(drawn.device, drawn.walls); }
std::string draw_region(const Drawn& drawn) {
  return report::draw_region(drawn.device, drawn.walls, FigureFormat::svg);
}

/// Negative damping: unstable whatever the wall.
Drawn hopeless_region() { return Drawn(test::transfer_function_parameters({1.0}, {1.0, -8.0, 0.0}, 1.0)); }

TEST(RegionJson, EveryKeyIsDocumented) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/docs/region.md");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::set<std::string> keys;
  collect_keys(region_json(lhifam_region()), keys);
  EXPECT_GT(keys.size(), 30U);
  for (const std::string& key : keys) {
    if (key == "kind" || key == "mode" || key == "stiffness" || key == "damping") continue;
    EXPECT_NE(text.find("`" + key + "`"), std::string::npos) << key;
  }
}

TEST(RegionJson, GivesTheNumbersWithoutLoss) {
  const WallRegion& region = lhifam_region().walls;
  const Json document = Json::parse(region_json(lhifam_region()).dump());
  EXPECT_EQ(document["schema"], "zwidth.region/1");
  EXPECT_EQ(document["status"], "bounded");
  EXPECT_EQ(document["critical_stiffness"].get<double>(), region.region.critical_stiffness);
  EXPECT_EQ(document["stiffest"]["stiffness"].get<double>(), region.region.stiffest->stiffness);
  EXPECT_EQ(document["stiffest"]["limited_by"]["kind"], "vibration_mode");
  EXPECT_EQ(document["area"].get<double>(), region.region.area);
  ASSERT_EQ(document["components"].size(), 1U);
  const Json& outline = document["components"][0]["outline"];
  ASSERT_EQ(outline.size(), region.region.components[0].outline.arcs.size());
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const BoundaryArc& arc = region.region.components[0].outline.arcs[i];
    EXPECT_EQ(outline[i]["boundary"], results::name_of(arc.kind));
    ASSERT_EQ(outline[i]["points"].size(), arc.points.size());
    EXPECT_EQ(outline[i]["points"][0]["stiffness"].get<double>(), arc.points[0].stiffness);
    EXPECT_EQ(outline[i]["points"][0]["frequency_rad_s"].is_null(), !arc.points[0].frequency.has_value());
  }
  EXPECT_EQ(document["any_user"]["limits"].size(), 1U);
  EXPECT_EQ(document["approximations"][0]["formula"], "colgate_schenkel");
  EXPECT_EQ(document["approximations"][0]["not_met"][0], "flexible links");
  EXPECT_TRUE(document["approximations"][1]["largest_damping"].is_null());
  EXPECT_TRUE(document["approximations"][2]["unsafe_share"].is_null());
}

TEST(RegionJson, WhatDoesNotExistIsNull) {
  const Json transfer = region_json(transfer_function_region());
  EXPECT_TRUE(transfer["any_user"].is_null());
  EXPECT_TRUE(transfer["approximations"].empty());
  const Json hopeless = region_json(hopeless_region());
  EXPECT_EQ(hopeless["status"], "none_stable");
  EXPECT_TRUE(hopeless["stiffest"].is_null());
  EXPECT_EQ(hopeless["area"], 0.0);
  EXPECT_TRUE(hopeless["components"].empty());
}

TEST(RegionText, SaysWhatLimitsAndHowFarFormulasAreOff) {
  const std::string text = region_text(lhifam_region());
  EXPECT_THAT(text, StartsWith("LHIfAM\n"));
  EXPECT_THAT(text, HasSubstr("188.3 kN/m"));
  EXPECT_THAT(text, HasSubstr("8.849 kN/m (K_CR at B = 0)"));
  EXPECT_THAT(text, HasSubstr("vibration mode 1"));
  EXPECT_THAT(text, HasSubstr("5.776 kN/m without a"));
  EXPECT_THAT(text, Not(HasSubstr("UNSAFE")));
  const std::string with_formulas =
      report::region_text(lhifam_region().device, lhifam_region().walls, {.formulas = true});
  EXPECT_THAT(with_formulas, HasSubstr("+1.67 dB, UNSAFE"));
  EXPECT_THAT(with_formulas, HasSubstr("this device has flexible links"));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110U) << line;
}

TEST(RegionText, SaysFirstWhatIsDoubtful) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.uncertainty = Uncertainty{{}, {}, "the limiting crossover lies above the excited band"};
  const Drawn drawn(parameters);
  EXPECT_THAT(region_text(drawn), HasSubstr("DOUBTFUL: the limiting crossover lies above the excited band"));
  EXPECT_EQ(region_json(drawn)["trust"]["verdict"], "doubtful");
  EXPECT_THAT(draw_region(drawn), HasSubstr("(DOUBTFUL)"));
}

TEST(RegionJson, OfARefusedDeviceHoldsNoNumber) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.uncertainty = Uncertainty{{}, {}, "nothing was determined"};
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  const Json document = region_json(Drawn(parameters));
  EXPECT_EQ(document["status"], "refused");
  for (const char* key : {"critical_stiffness", "stiffest", "most_damped", "area", "any_user"}) {
    EXPECT_TRUE(document[key].is_null()) << key;
  }
  EXPECT_TRUE(document["components"].empty());
}

TEST(RegionText, OfADeviceWithoutStableWallsSaysSo) {
  EXPECT_THAT(region_text(hopeless_region()), HasSubstr("No wall is stable"));
}

TEST(RegionCsv, HasALinePerPoint) {
  const StableRegion& region = lhifam_region().walls.region;
  std::size_t points = 0;
  for (const BoundaryArc& arc : region.components[0].outline.arcs) points += arc.points.size();
  const std::string csv = results::region_csv(lhifam_region().walls);
  EXPECT_THAT(csv,
              StartsWith("component,boundary,stiffness,damping,frequency_rad_s,mode,trust,holder\n1,oscillation,"));
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), points + 1);
}

TEST(RegionCsv, OfARasterIsTheGrid) {
  const std::string csv = results::region_raster_csv(wall_raster(lhifam_region().walls, 20), Trust{});
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "stiffness,damping,stable,trust");
  std::size_t rows = 0;
  std::size_t stable = 0;
  while (std::getline(lines, line)) {
    ++rows;
    stable += line.ends_with(",1,sound") ? 1U : 0U;
  }
  EXPECT_EQ(rows, 400U);
  // The area of the region in a box a tenth larger than its extent, by 400 cells.
  const StableRegion& region = lhifam_region().walls.region;
  const double share = region.area / (1.21 * region.stiffest->stiffness * region.most_damped->damping);
  EXPECT_NEAR(static_cast<double>(stable) / 400.0, share, 0.02);
}

TEST(RegionFigure, OfTwoRatesShowsBothAtTheSlowerRate) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.damper = LoopDamper{1e-4, 2e-4};
  const WallRegion& walls = lhifam_region().walls;
  const auto drawn = [&](const WallRegion* slower) {
    return report::draw_region(Device(parameters), walls, FigureFormat::svg, std::nullopt, slower);
  };
  const std::string svg = drawn(&walls);
  for (const char* number : {"1 ms", "100 µs", "200 µs", "1 kHz"}) EXPECT_THAT(svg, HasSubstr(number));
  EXPECT_THAT(drawn(nullptr), Not(HasSubstr("1 kHz")));
  EXPECT_THAT(draw_region(lhifam_region()), Not(HasSubstr("100 µs")));
}

TEST(RegionFigure, ShowsTheRegionAndTheFormulas) {
  const std::string svg = draw_region(lhifam_region());
  for (const char* text : {"Stable walls of LHIfAM", "stable for anyone", "Colgate &amp; Schenkel", "Gil, Hulin",
                           "Diolaiti", "Virtual damping B (N s/m)", "Stiffness K (kN/m)"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

TEST(RegionFigure, OfNothingIsStillAFigure) {
  const std::string svg = draw_region(hopeless_region());
  EXPECT_THAT(svg, HasSubstr("no wall is stable"));
  EXPECT_THAT(svg, Not(HasSubstr("Colgate")));
}

}  // namespace
}  // namespace zwidth::report

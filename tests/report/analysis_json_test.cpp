#include "results/analysis_json.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "report/example_analyses.hpp"

namespace zwidth::report {
namespace {

using Json = results::Json;

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

TEST(AnalysisJson, KeysStandInTheirDocumentedOrder) {
  const std::vector<std::string> expected = {"schema",
                                             "device",
                                             "units",
                                             "status",
                                             "critical_stiffness",
                                             "critical_stiffness_db",
                                             "critical_frequency_rad_s",
                                             "critical_frequency_hz",
                                             "limited_by",
                                             "limits",
                                             "stable_intervals",
                                             "crossovers",
                                             "modes",
                                             "suspended_rigid_body",
                                             "rigid_approximation",
                                             "q_criterion",
                                             "any_user",
                                             "user_family",
                                             "virtual_damper",
                                             "wall_filters",
                                             "wall",
                                             "walls",
                                             "force_per_count",
                                             "quantisation_passivity",
                                             "critical_stiffness_interval",
                                             "other_mechanism_share",
                                             "uncertainty_warning",
                                             "assumed",
                                             "trust",
                                             "remarks",
                                             "findings"};
  for (const auto& analysed : {lhifam(), lhifam_with_wall(), undamped_paddle(), unlimited_transfer_function()}) {
    EXPECT_EQ(keys_of(document_of(analysed)), expected) << analysed.device.name();
  }
}

TEST(AnalysisJson, GivesTheNumbersOfAFiniteAnswerWithoutLoss) {
  const Json document = Json::parse(document_of(lhifam()).dump());
  EXPECT_EQ(document["schema"], "zwidth.analysis/1");
  EXPECT_EQ(document["status"], "finite");
  EXPECT_EQ(document["units"], (Json{{"stiffness", "N/m"}, {"damping", "N s/m"}}));
  EXPECT_EQ(document["critical_stiffness"].get<double>(), 8848.70869499712);
  EXPECT_NEAR(document["critical_stiffness_db"].get<double>(), 78.93759796, 1e-8);
  EXPECT_EQ(document["critical_frequency_rad_s"].get<double>(), 38.5965268731856);
  EXPECT_NEAR(document["critical_frequency_hz"].get<double>(), 6.1428, 5e-5);
  EXPECT_EQ(document["limited_by"], (Json{{"kind", "rigid_body"}}));
  EXPECT_EQ(document["stable_intervals"], Json::parse("[[0.0,8848.70869499712]]"));
  ASSERT_EQ(document["crossovers"].size(), 4U);
  EXPECT_EQ(document["crossovers"][2]["limited_by"], (Json{{"kind", "vibration_mode"}, {"mode", 1}}));
  EXPECT_EQ(document["crossovers"][3]["frequency_rad_s"].get<double>(), std::numbers::pi / 1e-3);
  EXPECT_EQ(document["crossovers"][3]["stiffness"].get<double>(), 135171032.89);
  ASSERT_EQ(document["modes"].size(), 1U);
  EXPECT_EQ(keys_of(document["modes"][0]),
            (std::vector<std::string>{"frequency_rad_s", "frequency_hz", "damping_ratio"}));
  EXPECT_EQ(document["rigid_approximation"]["mass"].get<double>(), 5.4);
  EXPECT_EQ(document["rigid_approximation"]["critical_stiffness"].get<double>(), 7000.75625452837);
  EXPECT_EQ(document["q_criterion"]["mode_matters"], false);
  EXPECT_NEAR(document["q_criterion"]["db"].get<double>(), 78.5565, 5e-4);
  EXPECT_TRUE(document["any_user"].is_null());  // not in this hand-made answer
  EXPECT_TRUE(document["wall"].is_null());
  EXPECT_TRUE(document["virtual_damper"].is_null());
}

TEST(AnalysisJson, AnyUserLimitHasNullsWhereThereIsNone) {
  AnalysedDevice analysed = lhifam();
  analysed.analysis.any_user = AbsoluteStabilityLimit{5776.09, 259.9, 1e-12};
  const auto expected = [](const Json& stiffness, const Json& frequency, double truncation) {
    return Json{{"critical_stiffness", stiffness},
                {"frequency_rad_s", frequency},
                {"truncation", truncation},
                {"critical_stiffness_interval", nullptr},
                {"worst_user", nullptr}};
  };
  EXPECT_EQ(document_of(analysed)["any_user"], expected(5776.09, 259.9, 1e-12));
  analysed.analysis.any_user->interval = StiffnessInterval{5000.0, 6000.0};
  EXPECT_EQ(document_of(analysed)["any_user"]["critical_stiffness_interval"], (Json{5000.0, 6000.0}));
  analysed.analysis.any_user = AbsoluteStabilityLimit{0.0, 0.0, 0.0};
  EXPECT_EQ(document_of(analysed)["any_user"], expected(0.0, nullptr, 0.0));
  analysed.analysis.any_user->stiffness = std::numeric_limits<double>::infinity();
  EXPECT_EQ(document_of(analysed)["any_user"], expected(nullptr, nullptr, 0.0));
}

TEST(AnalysisJson, UsersAreWrittenAsTheyAre) {
  AnalysedDevice analysed = lhifam();
  analysed.analysis.any_user = AbsoluteStabilityLimit{5776.09, 259.9, 0.0};
  analysed.analysis.worst_user = WorstUser{{0.0, 362e3, {{0.1, 5e6}}}, 5776.1, 259.9};
  EXPECT_EQ(document_of(analysed)["any_user"]["worst_user"],
            (Json{{"mass", 0.0},
                  {"damping", 0.0},
                  {"stiffness", 362e3},
                  {"absorbers", Json::array({Json{{"mass", 0.1}, {"stiffness", 5e6}}})},
                  {"critical_stiffness", 5776.1},
                  {"frequency_rad_s", 259.9}}));
  EXPECT_TRUE(document_of(analysed)["user_family"].is_null());
  analysed.analysis.user_family =
      UserFamilyAnswer{{{0.0, 2.0}, {1.0, 1.0}, {0.0, 1e3}}, {{0.5, 1.0, 20.0}, 8000.0}, {}};
  analysed.analysis.user_family->free.stiffness = std::numeric_limits<double>::infinity();
  EXPECT_EQ(document_of(analysed)["user_family"],
            (Json{{"mass", {0.0, 2.0}},
                  {"damping", {1.0, 1.0}},
                  {"stiffness", {0.0, 1e3}},
                  {"worst_user", {{"mass", 0.5}, {"damping", 1.0}, {"stiffness", 20.0}}},
                  {"critical_stiffness", 8000.0},
                  {"free_critical_stiffness", nullptr}}));
}

TEST(AnalysisJson, WallMarginsAreInTheirUnits) {
  const Json wall = document_of(lhifam_with_wall())["wall"];
  EXPECT_EQ(wall["stiffness"], 5000.0);
  EXPECT_EQ(wall["damping"], 5.0);
  EXPECT_EQ(wall["stable"], true);
  EXPECT_NEAR(wall["gain_margin_db"].get<double>(), 6.0205999, 1e-6);         // 20 log10 2
  EXPECT_NEAR(wall["lower_gain_margin_db"].get<double>(), -6.0205999, 1e-6);  // 20 log10 0.5
  EXPECT_EQ(wall["phase_margin_rad"], 0.1);
  EXPECT_EQ(wall["delay_margin_s"], 1.5e-3);
  EXPECT_EQ(wall["spectral_radius"], 0.999);
}

TEST(AnalysisJson, FiltersHaveTheirKeysAndTheirSections) {
  AnalysedDevice analysed = lhifam_with_wall();
  DeviceParameters parameters = analysed.device.parameters();
  parameters.wall.filters = {
      {.kind = WallFilter::Kind::notch, .frequency_hz = 60.0},
      {.kind = WallFilter::Kind::digital, .numerator = {1.0, 0.5}, .denominator = {2.0, -1.0, 0.25}}};
  analysed.device = Device(parameters);
  const Json filters = document_of(analysed)["wall_filters"];
  ASSERT_EQ(filters.size(), 2U);
  EXPECT_EQ(keys_of(filters[0]),
            (std::vector<std::string>{"type", "frequency_hz", "damping_ratio", "depth", "z", "delta"}));
  EXPECT_EQ(filters[0]["type"], "notch");
  EXPECT_EQ(filters[1]["z"], (Json{{"numerator", {0.0, 0.5, 0.25}}, {"denominator", {1.0, -0.5, 0.125}}}));
  EXPECT_EQ(filters[1]["delta"], (Json{{"numerator", {0.75, 0.5, 0.0}}, {"denominator", {0.625, 1.5, 1.0}}}));
}

TEST(AnalysisJson, NoneStableIsZeroWithoutFrequencyOrLimit) {
  const Json document = document_of(undamped_paddle());
  EXPECT_EQ(document["status"], "none_stable");
  EXPECT_EQ(document["units"], (Json{{"stiffness", "N m/rad"}, {"damping", "N m s/rad"}}));
  EXPECT_EQ(document["critical_stiffness"].get<double>(), 0.0);
  for (const char* key : {"critical_stiffness_db", "critical_frequency_rad_s", "critical_frequency_hz", "limited_by"}) {
    EXPECT_TRUE(document[key].is_null()) << key;
  }
  EXPECT_EQ(document["stable_intervals"], Json::parse("[[2.0,5.0]]"));
  EXPECT_EQ(document["wall"]["stable"], false);
  EXPECT_TRUE(document["wall"]["gain_margin_db"].is_null());
  EXPECT_TRUE(document["wall"]["delay_margin_s"].is_null());
}

TEST(AnalysisJson, UnboundedIsNullNeverInfinity) {
  const Json document = document_of(unlimited_transfer_function());
  EXPECT_EQ(document["status"], "unbounded");
  EXPECT_TRUE(document["critical_stiffness"].is_null());
  EXPECT_TRUE(document["critical_stiffness_db"].is_null());
  EXPECT_TRUE(document["rigid_approximation"].is_null());
  EXPECT_TRUE(document["q_criterion"].is_null());
  EXPECT_EQ(document["stable_intervals"], Json::parse("[[0.0,null]]"));
}

TEST(AnalysisJson, AnUndecidedQCriterionIsNull) {
  AnalysedDevice analysed = lhifam();
  analysed.analysis.q_criterion = QCriterion{0.0, std::nullopt};
  const Json criterion = document_of(analysed)["q_criterion"];
  EXPECT_TRUE(criterion["mode_matters"].is_null());
  EXPECT_TRUE(criterion["db"].is_null());
}

}  // namespace
}  // namespace zwidth::report

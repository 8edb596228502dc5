#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "results/csv.hpp"
#include "results/json.hpp"
#include "results/stability_json.hpp"

// Linked with zwidth_results alone: no prose, no figures behind it.
namespace zwidth::results {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Json, WhatDoesNotExistIsNull) {
  const Json json = {{"nan", std::nan("")},
                     {"infinity", infinity},
                     {"absent", std::optional<double>()},
                     {"absent_infinity", std::optional(infinity)},
                     {"list", std::vector<double>{1.5, -infinity}},
                     {"present", std::optional(2.5)}};
  EXPECT_EQ(json.dump(),
            R"({"nan":null,"infinity":null,"absent":null,"absent_infinity":null,"list":[1.5,null],"present":2.5})");
}

TEST(Json, NumbersReadBackAsTheyWere) {
  for (const double value : {0.1, 1e-300, 8848.70869499712, 1.0 / 3.0, -0.0}) {
    EXPECT_EQ(Json::parse(Json(value).dump()).get<double>(), value);
  }
}

TEST(Json, ARemarkJoinsConsequenceAndRemedy) {
  const std::vector<Remark> remarks{{Remark::Severity::warning, "a", "b", "c"},
                                    {Remark::Severity::note, "a", "b", ""},
                                    {Remark::Severity::note, "a", "", "c"}};
  EXPECT_EQ(Json(remarks).dump(),
            R"([{"severity":"warning","what":"a","meaning":"b; c","consequence":"b","remedy":"c"},)"
            R"({"severity":"note","what":"a","meaning":"b","consequence":"b","remedy":""},)"
            R"({"severity":"note","what":"a","meaning":"c","consequence":"","remedy":"c"}])");
}

TEST(Json, TrustAndEnumsHaveTheirNames) {
  Trust trust;
  EXPECT_EQ(Json(trust).dump(), R"({"verdict":"sound","reasons":[]})");
  trust.refuse({.code = FindingCode::stated, .subjects = {{"reason", "no data"}}});
  EXPECT_EQ(Json(trust)["verdict"], "refused");
  EXPECT_EQ(name_of(StiffnessStatus::none_stable), "none_stable");
  EXPECT_EQ(name_of(StiffnessStatus::unbounded), "unbounded");
  EXPECT_EQ(Json(Oscillator{Oscillator::Kind::rigid_body, 0}).dump(), R"({"kind":"rigid_body"})");
  EXPECT_EQ(Json(Oscillator{Oscillator::Kind::vibration_mode, 2}).dump(), R"({"kind":"vibration_mode","mode":2})");
}

TEST(Json, FindingsAreListedOnceWithTheirNumbers) {
  Trust trust;
  trust.doubt({.code = FindingCode::file_promises_more,
               .evidence = {{"at_most", 800.0, "N/m"}, {"promised", infinity, "N/m"}},
               .key = "wall.stiffness",
               .effect = {{"critical_stiffness", 800.0}}});
  trust.refuse({.code = FindingCode::stated, .subjects = {{"reason", "no data"}}});
  const Remark coarse = warning({.code = FindingCode::encoder_stands_still, .evidence = {{"resolution", 1e-4, "m"}}});
  const Json findings = findings_json(trust, {coarse, {Remark::Severity::note, "a", "b", "c"}, coarse});
  ASSERT_EQ(findings.size(), 4U);
  EXPECT_EQ(
      findings[1].dump(),
      R"({"code":"file_promises_more","severity":"doubt","key":"wall.stiffness",)"
      R"("evidence":{"at_most":800.0,"promised":null},"effect":{"critical_stiffness":800.0},"remedy":"",)"
      R"("text":"the device's file promises every stiffness, more than was measured: identify the device before any )"
      R"(of its limits is used"})");
  EXPECT_EQ(findings[0]["code"], "stated");
  EXPECT_EQ(findings[0]["severity"], "refusal");
  EXPECT_EQ(findings[0]["text"], "no data");
  EXPECT_TRUE(findings[0]["key"].is_null() && findings[0]["effect"].is_null());
  EXPECT_EQ(findings[2]["code"], "encoder_stands_still");
  EXPECT_EQ(findings[2]["severity"], "note");
  EXPECT_EQ(findings[2]["remedy"], coarse.remedy);
  EXPECT_EQ(findings[3]["code"], "stated");
  EXPECT_EQ(findings[3]["text"], "a; b; c");
}

TEST(Json, ADocumentIsOneLineAndBeginsWithItsSchema) {
  Json json = document("zwidth.analysis/1");
  json["device"] = "two\nlines, \xff";
  EXPECT_EQ(line(json), "{\"schema\":\"zwidth.analysis/1\",\"device\":\"two\\nlines, \xef\xbf\xbd\"}\n");
}

TEST(Csv, CellsAreExactQuotedOrEmpty) {
  Csv csv({"time_s", "a,b"});
  csv.row(0.1, "say \"so\"");
  csv.row(std::optional<double>(), infinity);
  csv.row(3, Rounded{1.0 / 3.0, 3});
  csv.row(Shortest{0.1}, std::optional(2));
  EXPECT_EQ(csv.text(), "time_s,\"a,b\"\n0.10000000000000001,\"say \"\"so\"\"\"\n,\n3,0.333\n0.1,2\n");
}

TEST(Csv, PiecesAreTheWhole) {
  std::string written;
  std::size_t pieces = 0;
  Csv in_pieces(
      [&](std::string_view piece) {
        written += piece;
        ++pieces;
      },
      {"k"});
  Csv whole({"k"});
  for (int k = 0; k < 50000; ++k) {
    in_pieces.row(k);
    whole.row(k);
  }
  in_pieces.flush();
  EXPECT_EQ(written, whole.text());
  EXPECT_GT(pieces, 2U);
}

}  // namespace
}  // namespace zwidth::results

#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "zwidth/io/input_error.hpp"
#include "zwidth/words/problem_text.hpp"

/// Refusals as data: their codes, numbers, names and places, not their sentences.
namespace zwidth {

/// "bytes_missing bytes=24 left=21 part=name": a problem's code, its numbers and its names.
inline std::string data_of(const Problem& problem) {
  std::string data(name_of(problem.code));
  for (const Evidence& each : problem.evidence) data += fmt::format(" {}={:.6g}", each.name, each.value);
  for (const Subject& each : problem.subjects) data += fmt::format(" {}={}", each.name, each.text);
  return data;
}

/// The same behind its place in the file: "13:1: force: bytes_missing ...".
inline std::string data_of(const InputError& refusal) {
  const InputPlace& place = refusal.place;
  const std::string line = place.line > 0 ? fmt::format("{}:{}: ", place.line, place.column) : "";
  const std::string key = place.key.empty() ? "" : place.key + ": ";
  return line + key + (refusal.problem ? data_of(*refusal.problem) : "no data");
}

namespace test {

/// A refusal as data: where it lies, its code, and of its numbers and names those that are known.
struct RefusedProblem {
  InputPlace place;
  Problem problem;
};

/// Of a key in an override.
inline InputPlace of_override(std::string key) { return {.file = override_source, .key = std::move(key)}; }

inline void expect_refused(const InputProblem& told, const RefusedProblem& expected) {
  EXPECT_EQ(told.place.file, expected.place.file) << told.str();
  EXPECT_EQ(told.place.line, expected.place.line) << told.str();
  EXPECT_EQ(told.place.column, expected.place.column) << told.str();
  EXPECT_EQ(told.place.key, expected.place.key) << told.str();
  ASSERT_TRUE(told.problem) << told.str();
  EXPECT_EQ(name_of(told.problem->code), name_of(expected.problem.code)) << told.str();
  for (const Evidence& each : expected.problem.evidence) {
    const auto found = std::ranges::find(told.problem->evidence, each.name, &Evidence::name);
    ASSERT_NE(found, told.problem->evidence.end()) << each.name << ": " << told.str();
    if (!std::isnan(each.value) || !std::isnan(found->value)) {
      EXPECT_DOUBLE_EQ(found->value, each.value) << each.name << ": " << told.str();
    }
  }
  for (const Subject& each : expected.problem.subjects) {
    const auto found = std::ranges::find(told.problem->subjects, each.name, &Subject::name);
    ASSERT_NE(found, told.problem->subjects.end()) << each.name << ": " << told.str();
    EXPECT_EQ(found->text, each.text) << each.name << ": " << told.str();
  }
}

}  // namespace test
}  // namespace zwidth

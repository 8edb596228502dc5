#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "zwidth/io/input_error.hpp"
#include "zwidth/words/problem_text.hpp"

namespace zwidth::test {

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

}  // namespace zwidth::test

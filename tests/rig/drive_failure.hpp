#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>

#include "rig/driver.hpp"
#include "zwidth/words/drive_problem_text.hpp"

namespace zwidth {

inline void PrintTo(DriveProblemCode code, std::ostream* out) { *out << name_of(code); }
inline void PrintTo(const DriveProblem& problem, std::ostream* out) { *out << text(problem); }

namespace test {

/// Of which the work fails; nothing where it does not.
template <typename Work>
std::optional<DriveProblem> failure_of(const Work& work) {
  try {
    work();
  } catch (const rig::DriverFailed& failed) {
    return failed.problem;
  }
  return std::nullopt;
}

inline std::optional<DriveProblemCode> code_of(const std::optional<DriveProblem>& problem) {
  return problem ? std::optional(problem->code) : std::nullopt;
}

/// Of the problem, by its name; nothing where it has none of that name.
inline std::optional<double> number_of(const std::optional<DriveProblem>& problem, std::string_view name) {
  if (!problem) return std::nullopt;
  const auto found = std::ranges::find(problem->evidence, name, &Evidence::name);
  return found == problem->evidence.end() ? std::nullopt : std::optional(found->value);
}

inline std::string subject_of(const std::optional<DriveProblem>& problem, std::string_view name) {
  if (!problem) return "";
  const auto found = std::ranges::find(problem->subjects, name, &Subject::name);
  return found == problem->subjects.end() ? "" : found->text;
}

}  // namespace test
}  // namespace zwidth

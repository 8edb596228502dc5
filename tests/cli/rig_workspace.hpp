#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {

/// `zwidth rig` on devices of the project.
class Rig : public Workspace {
 protected:
  nlohmann::json json(const std::string& arguments) const {
    const Outcome outcome = run("zwidth rig --json " + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output, nullptr, false);
  }
  void expect_refused(const std::string& arguments, int status, const std::string& message) const {
    const Outcome outcome = run("zwidth rig " + arguments);
    EXPECT_EQ(outcome.status, status) << arguments;
    EXPECT_THAT(outcome.output, ::testing::IsEmpty()) << arguments;
    EXPECT_THAT(outcome.errors, ::testing::HasSubstr(message)) << arguments;
  }
};

inline const std::string lhifam = "devices/lhifam.toml ";
inline const std::string doubtful = "--set uncertainty.warning=\"'fitted to half a record'\" ";

}  // namespace zwidth::cli

#include "zwidth/batch/batch_stiffness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth {
namespace {

const Device device{test::lhifam_parameters()};

Device with(const std::vector<ParameterValues>& changes, std::size_t i) {
  DeviceParameters parameters = device.parameters();
  for (const ParameterValues& each : changes) set_parameter(parameters, each.key, each.values[i]);
  return Device(parameters);
}

TEST(BatchStiffness, HoldsTheAnyUserLimitWhereAsked) {
  const std::vector<ParameterValues> changes{{"link.stiffness", {4e4, 8e4, -1.0}}};
  BatchOptions options;
  options.any_user = true;
  const BatchStiffness columns = batch_stiffness(device, changes, options);
  ASSERT_EQ(columns.any_user.size(), 3U);
  for (const std::size_t i : {0U, 1U}) {
    const Device one = with(changes, i);
    const AbsoluteStabilityLimit limit = absolute_stability_limit(one, virtual_damper(one));
    EXPECT_EQ(columns.any_user[i], limit.stiffness);
    EXPECT_EQ(columns.absolute_stability_frequency[i], limit.frequency);
  }
  EXPECT_TRUE(std::isnan(columns.any_user[2]));
  EXPECT_TRUE(batch_stiffness(device, changes).any_user.empty());
}

TEST(BatchStiffness, WhatMakesNoDeviceIsRefusedAndSaysWhy) {
  const BatchStiffness columns =
      batch_stiffness(device, std::vector<ParameterValues>{{"loop.delay", {0.0, -1.0, 1e-3}}});
  ASSERT_EQ(columns.exceptions.size(), 1U);
  EXPECT_EQ(columns.exceptions[0].index, 1U);
  EXPECT_TRUE(columns.failure_of(1).starts_with("loop.delay")) << columns.failure_of(1);
  EXPECT_EQ(columns.failure_of(2), "");
  EXPECT_EQ(columns.status[1], StiffnessStatus::refused);
  EXPECT_EQ(columns.verdict[1], Trust::Verdict::refused);
  EXPECT_TRUE(std::isnan(columns.stiffness[1]));
  EXPECT_FALSE(columns.limited_by(1));
}

TEST(BatchStiffness, TakesTheTrustOfTheDevice) {
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty = Uncertainty{};
  parameters.uncertainty->warning = "friction";
  const std::vector<ParameterValues> changes{{"loop.delay", {0.0, 1e-3}}};
  const BatchStiffness doubtful = batch_stiffness(Device(parameters), changes);
  EXPECT_EQ(doubtful.verdict[1], Trust::Verdict::doubtful);
  EXPECT_FALSE(doubtful.trust_of(1).reasons.empty());
  EXPECT_TRUE(std::isfinite(doubtful.stiffness[1]));
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  const BatchStiffness refused = batch_stiffness(Device(parameters), changes);
  EXPECT_EQ(refused.verdict[0], Trust::Verdict::refused);
  EXPECT_TRUE(std::isnan(refused.stiffness[0]));
}

TEST(BatchStiffness, SaysWhatCannotBeAsked) {
  const std::vector<ParameterValues> changes{{"loop.delay", {0.0}}};
  EXPECT_THROW((void)batch_stiffness(device, {}), Error);
  BatchOptions options;
  options.threads = most_batch_threads + 1;
  EXPECT_EQ(find_problem(options, device)->member, "threads");
  EXPECT_THROW((void)batch_stiffness(device, changes, options), Error);
}

TEST(BatchStiffness, EndsWhereTheProgressThrows) {
  const std::vector<ParameterValues> changes{{"loop.delay", std::vector<double>(1000, 1e-3)}};
  const Progress stop = [](double) { throw std::runtime_error("enough"); };
  EXPECT_THROW((void)batch_stiffness(device, changes, {}, stop), std::runtime_error);
}

}  // namespace
}  // namespace zwidth

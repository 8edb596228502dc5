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

// The kernel knows one rate alone: it must never answer for a damper in a loop of its own.
TEST(BatchStiffness, TakesTwoRatesOneByOne) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.damping = 100.0;
  parameters.loop.damper = LoopDamper{.sampling_period = 1e-4, .delay = 0.0};
  const std::vector<ParameterValues> periods{{"loop.damper.sampling_period", {1e-4, 5e-4, 3e-4, 1e-3, 2e-3}}};
  const BatchStiffness columns = batch_stiffness(Device(parameters), periods);
  EXPECT_EQ(columns.scalar_count, 5U);
  EXPECT_NEAR(columns.stiffness[0], 252107.311, 1e-3);
  for (const std::size_t i : {0U, 1U, 3U, 4U}) {
    DeviceParameters each = parameters;
    each.loop.damper->sampling_period = periods[0].values[i];
    EXPECT_EQ(columns.stiffness[i], critical_stiffness(Device(each)).stiffness) << i;
  }
  EXPECT_TRUE(columns.failure_of(2).starts_with("loop.damper.sampling_period")) << columns.failure_of(2);
  EXPECT_EQ(columns.status[2], StiffnessStatus::refused);
  // The damper's loop alone in the base, other numbers in the rows; and the damper's alone in the rows.
  const BatchStiffness delays =
      batch_stiffness(Device(parameters), std::vector<ParameterValues>{{"loop.delay", {0.0, 1e-3}}});
  EXPECT_EQ(delays.scalar_count, 2U);
  EXPECT_EQ(delays.stiffness[0], columns.stiffness[0]);
}

TEST(BatchStiffness, SaysWhichOfTwoRatesHaveNoAnyUserLimit) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.damping = 50.0;
  parameters.loop.damper = LoopDamper{.sampling_period = 1e-4, .delay = 0.0};
  const std::vector<ParameterValues> periods{{"loop.damper.sampling_period", {1e-4, 2e-3}}};
  BatchOptions options;
  options.any_user = true;
  const BatchStiffness columns = batch_stiffness(Device(parameters), periods, options);
  EXPECT_NEAR(columns.any_user[0] / 109169.96, 1.0, 1e-5);
  EXPECT_TRUE(std::isnan(columns.any_user[1]));
  EXPECT_EQ(columns.verdict[1], Trust::Verdict::refused);
  EXPECT_FALSE(columns.failure_of(1).empty());
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

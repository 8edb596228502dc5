#include "zwidth/design/critical_stiffness_many.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "lhifam.hpp"
#include "zwidth/design/parameter_sweep.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

const Device device{test::lhifam_parameters()};

TEST(CriticalStiffnessMany, EachIsTheOneOfThatDeviceAlone) {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> share(0.2, 3.0);
  std::vector<ParameterValues> changes{{"link.stiffness", {}}, {"loop.delay", {}}};
  for (int i = 0; i < 200; ++i) {
    changes[0].values.push_back(79.5e3 * share(engine));
    changes[1].values.push_back(1e-3 * share(engine));
  }
  const auto many = critical_stiffness_many(device, changes);
  ASSERT_EQ(many.size(), 200U);
  for (std::size_t i = 0; i < many.size(); ++i) {
    DeviceParameters parameters = device.parameters();
    for (const ParameterValues& each : changes) set_parameter(parameters, each.key, each.values[i]);
    const CriticalStiffness alone = critical_stiffness(Device(parameters));
    EXPECT_NEAR(many[i].stiffness, alone.stiffness, 1e-12 * alone.stiffness);  // as batch_stiffness() promises
    ASSERT_TRUE(many[i].limited_by);
    EXPECT_EQ(many[i].limited_by->mode, alone.limit->limited_by.mode);
    EXPECT_EQ(many[i].status, alone.status);
    EXPECT_EQ(many[i].trust, alone.trust);
  }
}

TEST(CriticalStiffnessMany, WhatMakesNoDeviceSaysWhyAndEndsNothing) {
  const std::vector<ParameterValues> changes{{"link.stiffness", {8e4, -1.0, std::nan("")}}};
  const auto many = critical_stiffness_many(device, changes);
  EXPECT_EQ(many[0].failure, "");
  EXPECT_TRUE(std::isfinite(many[0].stiffness));
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_EQ(many[i].status, StiffnessStatus::refused);
    EXPECT_TRUE(std::isnan(many[i].stiffness));
    EXPECT_TRUE(many[i].failure.starts_with("link.0.stiffness")) << many[i].failure;
  }
}

TEST(CriticalStiffnessMany, RefusesKeysAndCounts) {
  const auto problem = [](const std::vector<ParameterValues>& changes) { return find_problem(device, changes); };
  EXPECT_TRUE(problem({}));
  EXPECT_EQ(problem({{"link.stifness", {1.0}}})->key, "link.stifness");
  EXPECT_EQ(problem({{"link.stiffness", {1.0}}, {"link.0.stiffness", {1.0}}})->what, "is given twice");
  EXPECT_TRUE(problem({{"link.stiffness", {1.0}}, {"loop.delay", {0.0, 1e-3}}}));
  EXPECT_FALSE(problem({{"link.stiffness", {1.0}}, {"loop.delay", {0.0}}}));
  EXPECT_THROW((void)critical_stiffness_many(device, {}), Error);
}

TEST(ParameterSweep, OfARefusedDeviceHoldsNoNumber) {
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty = Uncertainty{};
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  parameters.uncertainty->reasons = {"noise"};
  const ParameterSweep sweep = parameter_sweep(Device(parameters), {{"loop.delay", 0.0, 1e-3, 3}});
  EXPECT_TRUE(sweep.trust.refused());
  for (const SweepPoint& point : sweep.points) {
    EXPECT_EQ(point.status, StiffnessStatus::refused);
    EXPECT_TRUE(std::isnan(point.stiffness));
  }
}

}  // namespace
}  // namespace zwidth

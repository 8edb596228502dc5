#include "identification/verdict/assumed_experiment.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace zwidth::internal {
namespace {

DeviceParameters rigid_device() {
  DeviceParameters device;
  device.bodies = {{.name = "motor", .mass = 0.1, .damping = 2.0}};
  device.loop.sampling_period = 1e-3;
  return device;
}

std::vector<FindingCode> codes_of(const std::vector<Remark>& remarks) {
  std::vector<FindingCode> codes;
  for (const Remark& each : remarks) codes.push_back(each.finding->code);
  return codes;
}

TEST(AssumedExperiment, IsSaidOfAStructureWithoutAFile) {
  using enum FindingCode;
  const Device device(rigid_device());
  EXPECT_EQ(codes_of(assumptions_of_experiment(device, false, {})),
            (std::vector{nobody_taken_to_hold, force_taken_for_command}));
  EXPECT_EQ(codes_of(assumptions_of_experiment(device, false, {"handle"})), (std::vector{force_taken_for_command}));
  EXPECT_TRUE(assumptions_of_experiment(device, true, {}).empty());
}

TEST(AssumedExperiment, AnOperatorOfTheFileHoldsTheDevice) {
  DeviceParameters held = rigid_device();
  held.user.stiffness = 100.0;
  const std::vector<Remark> remarks = assumptions_of_experiment(Device(held), true, {});
  EXPECT_EQ(codes_of(remarks), (std::vector{FindingCode::operator_taken_to_hold}));
  EXPECT_EQ(remarks[0].severity, Remark::Severity::warning);
}

}  // namespace
}  // namespace zwidth::internal

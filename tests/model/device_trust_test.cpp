#include "zwidth/model/device_trust.hpp"

#include <gtest/gtest.h>

#include "lhifam.hpp"

namespace zwidth {
namespace {

Trust trust_with(Uncertainty uncertainty) {
  DeviceParameters device = test::lhifam_parameters();
  device.uncertainty = std::move(uncertainty);
  return trust_of(Device(device));
}

TEST(DeviceTrust, IsSoundUnlessTheFileSaysOtherwise) {
  EXPECT_EQ(trust_of(Device(test::lhifam_parameters())), Trust{});
  EXPECT_EQ(trust_with({{"link.0.stiffness"}, {{1.0}}}), Trust{});
}

// Files of before the verdict have a warning alone.
TEST(DeviceTrust, AWarningIsDoubtfulAtLeast) {
  const Trust warned = trust_with({{"link.0.stiffness"}, {{1.0}}, "misfit"});
  EXPECT_EQ(warned.verdict, Trust::Verdict::doubtful);
  EXPECT_EQ(warned.reasons, std::vector<std::string>{"misfit"});
  EXPECT_EQ(trust_with({{}, {}, "misfit"}).verdict, Trust::Verdict::doubtful);
}

TEST(DeviceTrust, ARefusedFitStaysRefused) {
  const Trust refused = trust_with({{}, {}, "nothing is determined", Trust::Verdict::refused, {"120 % unexplained"}});
  EXPECT_TRUE(refused.refused());
  EXPECT_EQ(refused.reasons, (std::vector<std::string>{"nothing is determined", "120 % unexplained"}));
  EXPECT_EQ(trust_with({{}, {}, "", Trust::Verdict::refused, {}}).reasons.size(), 1U);
}

// A number to begin with carries no answer, whatever else is known.
TEST(DeviceTrust, AssumedNumbersAreDoubtful) {
  Uncertainty uncertainty;
  uncertainty.assumed = {"body.motor.mass", "loop.sampling_period"};
  const Trust assumed = trust_with(uncertainty);
  EXPECT_EQ(assumed.verdict, Trust::Verdict::doubtful);
  EXPECT_EQ(assumed.reasons, std::vector<std::string>{"assumed, not measured: body.motor.mass, loop.sampling_period; "
                                                      "give the device's own"});
  uncertainty.warning = "misfit";
  EXPECT_EQ(trust_with(uncertainty).reasons.size(), 2U);
}

TEST(DeviceTrust, AnEmptyTableIsNoUncertainty) {
  DeviceParameters device = test::lhifam_parameters();
  device.uncertainty = Uncertainty{};
  ASSERT_TRUE(find_problem(device).has_value());
  EXPECT_EQ(find_problem(device)->key, "uncertainty.parameters");
}

}  // namespace
}  // namespace zwidth

#include "zwidth/design/region_approximation.hpp"

#include <gtest/gtest.h>

#include "lhifam.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using Formula = RegionApproximation::Formula;

TEST(RegionApproximation, AreTheFormulasOfTheLiterature) {
  DeviceParameters parameters = test::with_delay(test::lhifam_parameters(), 1e-3);
  parameters.user.damping = 2.0;
  const auto formulas = region_approximations(Device(parameters), 0.0);
  ASSERT_EQ(formulas.size(), 3U);
  EXPECT_EQ(formulas[0].formula, Formula::colgate_schenkel);
  EXPECT_NEAR(stiffness_at(formulas[0], 1.0), 5000.0, 1e-9);  // 2 b/T - 2 B/T, b = 3.5, B = 1
  EXPECT_EQ(stiffness_at(formulas[0], 3.6), 0.0);
  EXPECT_EQ(formulas[1].formula, Formula::gil_hulin);
  EXPECT_NEAR(stiffness_at(formulas[1], 3.0), (5.5 + 3.0) / 1.5e-3, 1e-9);
  EXPECT_EQ(formulas[2].formula, Formula::diolaiti);
  EXPECT_NEAR(stiffness_at(formulas[2], 0.0), 2333.3333333333335, 1e-9);  // b/(T/2 + t_d)
  EXPECT_EQ(stiffness_at(formulas[2], 0.1), 0.0);
}

TEST(RegionApproximation, ThereAreNoneForATransferFunction) {
  const Device device(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1.0));
  EXPECT_TRUE(region_approximations(device, 0.0).empty());
  EXPECT_THROW((void)region_approximations(device, -1.0), Error);
}

// Where it holds, Colgate & Schenkel is exact.
TEST(ApproximationError, IsNoneForARigidDeviceWithAnyUser) {
  const Device device(test::rigid_parameters());
  const AbsoluteStabilityRegion region =
      absolute_stability_region(device, StableWalls(filtered_plant(device), 50.0), 100.0);
  const ApproximationError error = approximation_error(region_approximations(device, 50.0)[0], region);
  EXPECT_NEAR(*error.ratio, 1.0, 1e-5);
  EXPECT_NEAR(*error.unsafe_share, 0.0, 1e-4);
  EXPECT_NEAR(*error.missed_share, 0.0, 1e-4);
}

// Walls K < 3/2, B < 1 against K = 1 + B, B < 1.
TEST(ApproximationError, SharesAreAreas) {
  AbsoluteStabilityRegion square;
  square.ranges = {{{0.0, 1.5, 1.0}, {1.0, 1.5, 1.0}}};
  square.most_damped = square.ranges[0][1];
  const RegionApproximation formula{Formula::gil_hulin, true, 1.0, 1.0, 1.0};
  const ApproximationError error = approximation_error(formula, square);
  // Formula 3/2, exact 3/2, both 3/2 - 1/8.
  EXPECT_NEAR(*error.unsafe_share, (1.0 / 8.0) / 1.5, 1e-5);
  EXPECT_NEAR(*error.missed_share, (1.0 / 8.0) / 1.5, 1e-5);
  EXPECT_NEAR(*error.ratio, 1.0 / 1.5, 1e-12);
}

// Table I: the rigid formulas are unsafe by 7000 / 5776.09 for any user, safe by 7000 / 8848.71 for the device alone.
TEST(ApproximationError, OfTableI) {
  const Device device(test::lhifam_parameters());
  const StableWalls walls(filtered_plant(device));
  const AbsoluteStabilityRegion any_user =
      absolute_stability_region(device, StableWalls(filtered_plant(device)), 600.0);
  const auto formulas = region_approximations(device, 0.0);
  EXPECT_NEAR(*approximation_error(formulas[0], any_user).ratio, 7000.0 / 5776.09, 1e-4);
  EXPECT_TRUE(approximation_error(formulas[0], any_user).unsafe);
  EXPECT_FALSE(approximation_error(formulas[1], walls, 556.9).unsafe);
  EXPECT_NEAR(*approximation_error(formulas[1], walls, 556.9).ratio, 7000.0 / 8848.70869499712, 1e-9);
  EXPECT_NEAR(*approximation_error(formulas[2], any_user).ratio, 7000.0 / 5776.09, 1e-4);
  EXPECT_FALSE(approximation_error(formulas[2], any_user).unsafe_share.has_value());
}

}  // namespace
}  // namespace zwidth

#include "zwidth/design/notch_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

// Limited by its first vibration mode, so that a notch can help: light bodies, a soft cable.
Device mode_limited() {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies[0].mass = 0.1;
  device.bodies[1].damping = 30.0;
  device.links[0] = {0, 1, 20e3, 2.0};
  device.loop.delay = 1e-3;
  return Device(std::move(device));
}

Device with_notch(const Device& device, const WallFilter& notch) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.filters.push_back(notch);
  return Device(std::move(parameters));
}

// Stability alone, as far as any notch can raise it.
NotchOptions without_margins(double uncertainty = 0.0) {
  NotchOptions options;
  options.modal_frequency_uncertainty = uncertainty;
  options.gain_margin = 1.0;
  options.phase_margin = 0.0;
  options.far_from_modes = true;
  options.lower_absolute_stability_limit = true;
  return options;
}

double excess(const Device& device, double stiffness) {
  Wall wall = device.parameters().wall;
  wall.stiffness = stiffness;
  return stability_excess(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), wall);
}

TEST(NotchDesign, RaisesTheWorstWallAndEigenvaluesAgree) {
  const Device device = mode_limited();
  ASSERT_EQ(critical_stiffness(device).limit->limited_by.kind, Oscillator::Kind::vibration_mode);
  const NotchDesign design = design_notch(device, without_margins(0.1));
  ASSERT_TRUE(design.notch);
  EXPECT_GT(design.with, 1.5 * design.without);
  ASSERT_EQ(design.over_modal_shift.size(), 41u);
  double least = std::numeric_limits<double>::infinity();
  for (const NotchAtModalShift& each : design.over_modal_shift) {
    const Device notched = with_notch(with_modal_shift(device, each.modal_shift), *design.notch);
    EXPECT_NEAR(critical_stiffness(notched).stiffness / each.with, 1.0, 1e-12);
    EXPECT_LT(excess(notched, design.with * (1.0 - 1e-6)), 0.0) << each.modal_shift;
    EXPECT_GE(each.with, design.with);
    least = std::min(least, each.with);
  }
  EXPECT_LE(design.with, least);
  EXPECT_GT(design.with, 0.999 * least);
}

// Its worst lies between the modal shifts of the table.
TEST(NotchDesign, KeepsItsPromiseBetweenTheDriftsOfTheTable) {
  const Device device(test::reduced_pretension_parameters());
  const NotchDesign design = design_notch(device, without_margins(0.1));
  ASSERT_TRUE(design.notch);
  for (int i = -400; i <= 400; ++i) {
    const double modal_shift = 0.1 * i / 400.0;
    const Device notched = with_notch(with_modal_shift(device, modal_shift), *design.notch);
    ASSERT_GE(critical_stiffness(notched).stiffness, design.with) << modal_shift;
    if (i % 20 == 0) {
      ASSERT_LT(excess(notched, design.with), 0.0) << modal_shift;
    }
  }
}

// The margin asked for is met only far below the critical stiffness; a notch must not win by finding it at all.
TEST(NotchDesign, ComparesWithTheTrueWallWithoutANotch) {
  NotchOptions options;
  options.gain_margin = 2.0;
  options.phase_margin = 30.0 * std::numbers::pi / 180.0;
  const Device device(test::reduced_pretension_parameters());
  const double without = stiffest_wall(device, options);
  EXPECT_GT(without, 7.0);
  EXPECT_LT(without, 9.0);
  DeviceParameters parameters = device.parameters();
  parameters.wall.stiffness = without;
  EXPECT_NEAR(wall_margins(Device(parameters)).phase_margin.value(), options.phase_margin, 1e-6);
}

TEST(NotchDesign, IsALocalOptimum) {
  const Device device = mode_limited();
  const NotchDesign design = design_notch(device, without_margins(0.1));
  ASSERT_TRUE(design.notch);
  for (int i = 0; i < 6; ++i) {
    WallFilter moved = *design.notch;
    const double factor = i % 2 == 0 ? 1.02 : 1.0 / 1.02;
    if (i / 2 == 0) moved.frequency_hz *= factor;
    if (i / 2 == 1) moved.damping_ratio *= factor;
    if (i / 2 == 2) moved.depth *= factor;
    double least = std::numeric_limits<double>::infinity();
    for (const NotchAtModalShift& each : design.over_modal_shift) {
      least =
          std::min(least, critical_stiffness(with_notch(with_modal_shift(device, each.modal_shift), moved)).stiffness);
    }
    EXPECT_LE(least, design.with * 1.001) << i;
  }
}

TEST(NotchDesign, KeepsTheMarginsAskedFor) {
  const Device device = mode_limited();
  NotchOptions options = without_margins(0.05);
  options.gain_margin = 2.0;
  options.phase_margin = 0.1;
  const NotchDesign design = design_notch(device, options);
  ASSERT_TRUE(design.notch);
  for (const NotchAtModalShift& each : design.over_modal_shift) {
    DeviceParameters parameters = with_notch(with_modal_shift(device, each.modal_shift), *design.notch).parameters();
    parameters.wall.stiffness = each.with;
    const WallMargins margins = wall_margins(Device(std::move(parameters)));
    EXPECT_TRUE(margins.stable);
    EXPECT_GE(margins.gain_margin.value(), 2.0 * (1.0 - 1e-9));
    EXPECT_GE(margins.phase_margin.value(), 0.1 * (1.0 - 1e-6));
  }
}

TEST(NotchDesign, RaisesTheAnyUserLimit) {
  const Device device = mode_limited();
  NotchOptions options = without_margins();
  options.goal = StiffnessGoal::absolute_stability_limit;
  const NotchDesign design = design_notch(device, options);
  EXPECT_GE(design.with, design.without);
  if (design.notch) {
    EXPECT_NEAR(absolute_stability_limit(with_notch(device, *design.notch)).stiffness / design.with, 1.0, 2e-6);
  }
}

// The rigid body limits: a notch only delays.
TEST(NotchDesign, NeverMakesAWorseWall) {
  for (const double delay : {0.0, 0.25e-3, 2e-3, 6e-3}) {
    for (DeviceParameters parameters : {test::lhifam_parameters(), test::reduced_pretension_parameters()}) {
      parameters.loop.delay = delay;
      const NotchDesign design = design_notch(Device(parameters), without_margins(0.1));
      EXPECT_GE(design.with, design.without) << delay;
      EXPECT_EQ(design.notch.has_value(), design.with > design.without);
    }
  }
}

// Asked for nothing: the margins of a wall that one can run, near a mode, and no user is worse off.
TEST(NotchDesign, KeepsTheDefaultMarginsAtEveryDrift) {
  DeviceParameters damped = mode_limited().parameters();
  damped.wall.damping = 8.0;
  const Device device(damped);
  NotchOptions options;
  options.modal_frequency_uncertainty = 0.1;
  const NotchDesign design = design_notch(device, options);
  EXPECT_TRUE(design.trust.sound());
  ASSERT_GT(design.with, 0.0);
  for (const NotchAtModalShift& each : design.over_modal_shift) {
    const Device plain = with_modal_shift(device, each.modal_shift);
    const Device notched = design.notch ? with_notch(plain, *design.notch) : plain;
    EXPECT_LT(excess(notched, design.with), 0.0);
    EXPECT_LT(excess(notched, 2.0 * design.with * (1.0 - 1e-5)), 0.0) << "the stiffness alone, twice";
    DeviceParameters parameters = notched.parameters();
    parameters.wall.stiffness = design.with;
    const WallMargins margins = wall_margins(Device(parameters));
    EXPECT_TRUE(margins.stable);
    EXPECT_GE(margins.gain_margin.value(), 2.0 * (1.0 - 1e-5));
    EXPECT_GE(margins.phase_margin.value(), std::numbers::pi / 6.0 * (1.0 - 1e-5));
    EXPECT_GE(absolute_stability_limit(notched, virtual_damper(notched)).stiffness,
              absolute_stability_limit(plain, virtual_damper(plain)).stiffness * (1.0 - 1e-9));
  }
  if (design.notch) {
    const double mode = modal_form(device).modes.at(0).frequency / (2.0 * std::numbers::pi);
    EXPECT_GT(design.notch->frequency_hz, 0.499 * mode);
    EXPECT_LT(design.notch->frequency_hz, 2.001 * mode);
  }
}

TEST(NotchDesign, NeverLowersTheAnyUserLimitUnasked) {
  const Device device(test::reduced_pretension_parameters());
  const double free = absolute_stability_limit(device).stiffness;
  NotchOptions options = without_margins(0.1);
  const NotchDesign lowering = design_notch(device, options);
  ASSERT_TRUE(lowering.notch);
  EXPECT_LT(absolute_stability_limit(with_notch(device, *lowering.notch)).stiffness, free);
  options.lower_absolute_stability_limit = false;
  const NotchDesign keeping = design_notch(device, options);
  if (keeping.notch) {
    EXPECT_GE(absolute_stability_limit(with_notch(device, *keeping.notch)).stiffness, free * (1.0 - 1e-9));
  }
}

TEST(NotchDesign, DriftMovesTheModesByItsFactor) {
  DeviceParameters free = test::lhifam_parameters();
  for (Body& body : free.bodies) body.damping = 0.0;
  const double nominal = modal_form(Device(free)).modes.at(0).frequency;
  const Mode moved = modal_form(with_modal_shift(Device(free), 0.2)).modes.at(0);
  EXPECT_NEAR(moved.frequency / nominal, 1.2, 1e-12);
  EXPECT_NEAR(moved.damping_ratio, modal_form(Device(free)).modes.at(0).damping_ratio, 1e-12);
}

TEST(NotchDesign, RefusesWhatItCannotDo) {
  const Device device = mode_limited();
  NotchOptions options;
  options.modal_frequency_uncertainty = -0.1;
  EXPECT_THROW((void)design_notch(device, options), Error);
  options.modal_frequency_uncertainty = 0.95;
  EXPECT_THROW((void)design_notch(device, options), Error);
  options = {};
  options.gain_margin = 0.5;
  EXPECT_THROW((void)design_notch(device, options), Error);
  options = {};
  options.phase_margin = std::nan("");
  EXPECT_THROW((void)design_notch(device, options), Error);
  EXPECT_THROW((void)design_notch(Device(test::rigid_parameters()), {}), Error);
  EXPECT_THROW((void)with_modal_shift(Device(test::rigid_parameters()), 0.1), Error);
}

}  // namespace
}  // namespace zwidth

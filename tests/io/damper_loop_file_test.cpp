// [loop.damper] of a device file: read, overridden, refused and written.

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "zwidth/io/device_file.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth {
namespace {

constexpr const char* one_body = "[[body]]\nname = \"a\"\nmass = 1\ndamping = 2\n";

std::string device_text(std::string_view loop, std::string_view after = "") {
  return std::string(one_body) + "[loop]\nsampling_period = 1e-3\n" + std::string(loop) + "\n" + std::string(after);
}

TEST(DamperLoopFile, IsReadWithItsUnits) {
  const auto device =
      parse_device(device_text("[loop.damper]\nsampling_period = \"100 us\"\ndelay = \"0.25 ms\""), "f.toml");
  ASSERT_TRUE(device) << device.error().str();
  ASSERT_TRUE(device->loop().damper.has_value());
  EXPECT_EQ(device->loop().damper->sampling_period, 100e-6);
  EXPECT_EQ(device->loop().damper->delay, 0.25e-3);
  EXPECT_TRUE(has_damper_loop(device->loop()));
}

TEST(DamperLoopFile, WhatItLeavesOutIsThatOfTheLoop) {
  const auto device = parse_device(device_text("delay = 2e-3\n[loop.damper]\nsampling_period = 2e-3"), "f.toml");
  ASSERT_TRUE(device) << device.error().str();
  const DamperTiming damper = damper_timing(device->loop());
  EXPECT_EQ(damper.sampling_period, 2e-3);
  EXPECT_EQ(damper.delay, 2e-3);
  EXPECT_TRUE(has_damper_loop(device->loop()));

  const auto same = parse_device(device_text("[loop.damper]"), "f.toml");
  ASSERT_TRUE(same) << same.error().str();
  EXPECT_FALSE(has_damper_loop(same->loop()));
}

TEST(DamperLoopFile, AnOverrideMakesTheTable) {
  const std::vector<std::string> overrides{"loop.damper.sampling_period=125 us"};
  const auto device = parse_device(device_text(""), "f.toml", overrides);
  ASSERT_TRUE(device) << device.error().str();
  EXPECT_EQ(damper_timing(device->loop()).sampling_period, 125e-6);
}

TEST(DamperLoopFile, IsWrittenAsItWasRead) {
  const auto device = parse_device(device_text("[loop.damper]\nsampling_period = 2.5e-4"), "f.toml");
  ASSERT_TRUE(device) << device.error().str();
  const std::string written = write_device(device->parameters());
  const auto again = parse_device(written, "f.toml");
  ASSERT_TRUE(again) << again.error().str();
  EXPECT_EQ(damper_timing(again->loop()).sampling_period, 2.5e-4);
  EXPECT_FALSE(again->loop().damper->delay.has_value());
  EXPECT_EQ(write_device(again->parameters()), written);
  EXPECT_EQ(write_device(with_one_rate(*again).parameters()).find("[loop.damper]"), std::string::npos);
}

TEST(DamperLoopFile, APeriodThatIsNoPartNamesTheNearest) {
  const auto device = parse_device(device_text("[loop.damper]\nsampling_period = 3e-4"), "f.toml");
  ASSERT_FALSE(device);
  const InputError& error = device.error();
  EXPECT_EQ(error.place.key, "loop.damper.sampling_period");
  ASSERT_TRUE(error.problem.has_value());
  EXPECT_EQ(error.problem->code, ProblemCode::no_whole_ratio);
  EXPECT_EQ(error.problem->evidence.back(), (Evidence{"nearest", 1e-3 / 3.0}));
  ASSERT_TRUE(error.suggestion.has_value());
  EXPECT_EQ(std::stod(*error.suggestion), 1e-3 / 3.0);
}

TEST(DamperLoopFile, AVelocityFiltersTimeConstantIsAtTheDampersRate) {
  const std::string wall = "[wall]\ndamping = 5\nvelocity_filter_tau = 1e-3\n";
  const auto apart = parse_device(device_text("[loop.damper]\nsampling_period = 1e-4", wall), "f.toml");
  ASSERT_TRUE(apart) << apart.error().str();
  const auto together = parse_device(std::string(one_body) + "[loop]\nsampling_period = 1e-4\n" + wall, "f.toml");
  ASSERT_TRUE(together) << together.error().str();
  EXPECT_EQ(apart->parameters().wall.velocity_filter_hz, together->parameters().wall.velocity_filter_hz);
}

}  // namespace
}  // namespace zwidth

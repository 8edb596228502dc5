#include "zwidth/io/number_with_unit.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "zwidth/io/device_file.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

constexpr double pi = std::numbers::pi;

struct Known {
  std::string text;
  Measure measure;
  Motion motion;
  double value;
};

using enum Measure;
using enum Motion;

TEST(NumberWithUnit, KnownValues) {
  const Known all[] = {
      {"22 kg cm^2", mass, rotary, 0.0022},
      {"22 kg\u00b7cm\u00b2", mass, rotary, 0.0022},
      {"22 kg cm2", mass, rotary, 0.0022},
      {"220 g", mass, linear, 0.22},
      {"1 lb", mass, linear, 0.45359237},
      {"1 oz in^2", mass, rotary, 0.028349523125 * 0.0254 * 0.0254},
      {"0.4 N m/deg", stiffness, rotary, 0.4 * 180.0 / pi},
      {"3 N m", stiffness, rotary, 3.0},
      {"5 kN/m", stiffness, linear, 5000.0},
      {"5 N/mm", stiffness, linear, 5000.0},
      {"10 lbf/in", stiffness, linear, 44.482216152605 / 0.0254},
      {"400 us", time, linear, 400e-6},
      {"400 \u00b5s", time, linear, 400e-6},
      {"400us", time, linear, 400e-6},
      {"1.5 ms", time, linear, 1.5e-3},
      {"-1.5e-1 ms", time, linear, -1.5e-4},
      {"0.3 seconds", time, linear, 0.3},
      {"0.2 kHz", frequency_hz, linear, 200.0},
      {"3000 rpm", frequency_hz, linear, 50.0},
      {"100 rad/s", frequency_hz, linear, 100.0 / (2.0 * pi)},  // not 100 Hz
      {"10 Hz", angular_frequency, linear, 20.0 * pi},
      {"1 turn/4096", position, rotary, 2.0 * pi / 4096.0},
      {"1/4096 turn", position, rotary, 2.0 * pi / 4096.0},
      {"1 rev/(4096 counts)", position, rotary, 2.0 * pi / 4096.0},
      {"0.5\u00b0", position, rotary, pi / 360.0},
      {"5 um/count", position, linear, 5e-6},
      {"30 ozf in", force, rotary, 30.0 * 0.27801385095378125 * 0.0254},
      {"30 mN", force, linear, 0.03},
      {"30 mNm", force, rotary, 0.03},
      {"0.1 mN.m.s/rad", damping, rotary, 1e-4},
      {"5 mN m/krpm", damping, rotary, 5e-3 * 60.0 / (2.0 * pi * 1000.0)},
      {"5 N/(m/s)", damping, linear, 5.0},
      {"20 %", ratio, linear, 0.2},
  };
  for (const Known& each : all) {
    const auto value = number_with_unit(each.text, each.measure, each.motion);
    ASSERT_TRUE(value.has_value()) << each.text << ": " << value.error().what;
    EXPECT_NEAR(*value, each.value, 4e-16 * std::abs(each.value)) << each.text;
  }
}

TEST(NumberWithUnit, DecimalPrefixesLoseNothing) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const int digits = static_cast<int>(random() % 1'000'000);
    const std::pair<std::string, std::string> all[] = {{"ms", "e-3"}, {"us", "e-6"}, {"ns", "e-9"}};
    for (const auto& [unit, exponent] : all) {
      EXPECT_EQ(number_with_unit(fmt::format("{} {}", digits, unit), time, linear).value(),
                std::stod(std::to_string(digits) + exponent));
    }
  }
}

TEST(NumberWithUnit, OtherKindsAndWhatIsNoFactorAreRefused) {
  const Known all[] = {
      {"5 kg", damping, linear, 0},
      {"5 kg", mass, rotary, 0},
      {"5 kg m^2", mass, linear, 0},
      {"5 N m/rad", stiffness, linear, 0},
      {"5 N/m", stiffness, rotary, 0},
      {"2 kHz", time, linear, 0},
      {"2 ms", frequency_hz, linear, 0},
      {"2 s^-1", frequency_hz, linear, 0},  // cycles or radians?
      {"2 rad", position, linear, 0},
      {"2 mm", position, rotary, 0},
      {"2 count", position, rotary, 0},
      {"4096 counts/turn", position, rotary, 0},
      {"20 degC", ratio, linear, 0},
      {"20 dB", ratio, linear, 0},
      {"3 s since 1990-01-01", time, linear, 0},
      {"3 s after 5", time, linear, 0},
      {"3 m from 5", position, linear, 0},
      {"3 m @ 5", position, linear, 0},
      {"3 lg(re 1 m)", position, linear, 0},
      {"3 lb(re 1 m)", position, linear, 0},
      {"1 000 N/m", stiffness, linear, 0},
      {"1,5 ms", time, linear, 0},
      {"5 kg cm 2", mass, rotary, 0},
      {"5 m^4294967297", position, linear, 0},
      {"5 m/0", position, linear, 0},
      {"5 m^", position, linear, 0},
      {"5", time, linear, 0},
      {"", time, linear, 0},
      {"s", time, linear, 0},
      {"nan s", time, linear, 0},
      {"inf s", time, linear, 0},
      {"1e400 s", time, linear, 0},
      {"1e-400 s", time, linear, 0},
      {"1e300 km km km", position, linear, 0},
      {"5 KN/m", stiffness, linear, 0},
      {"0x10 s", time, linear, 0},
      {std::string("5 s\0", 4), time, linear, 0},
  };
  testing::internal::CaptureStderr();
  for (const Known& each : all) {
    const auto value = number_with_unit(each.text, each.measure, each.motion);
    EXPECT_FALSE(value.has_value()) << each.text << " is " << value.value_or(0.0);
    if (!value) {
      EXPECT_TRUE(value.error().problem) << each.text;
      EXPECT_FALSE(value.error().what.empty() || value.error().allowed.empty()) << each.text;
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(NumberWithUnit, ProductsOfUnitsAgreeWithTheirFactors) {
  struct Base {
    std::string name;
    double factor;
    std::array<int, 4> dimensions;  // kg, m, s, rad
  };
  const std::vector<Base> bases = {
      {"kg", 1.0, {1, 0, 0, 0}},       {"g", 1e-3, {1, 0, 0, 0}},        {"m", 1.0, {0, 1, 0, 0}},
      {"mm", 1e-3, {0, 1, 0, 0}},      {"in", 0.0254, {0, 1, 0, 0}},     {"s", 1.0, {0, 0, 1, 0}},
      {"ms", 1e-3, {0, 0, 1, 0}},      {"min", 60.0, {0, 0, 1, 0}},      {"N", 1.0, {1, 1, -2, 0}},
      {"kN", 1e3, {1, 1, -2, 0}},      {"rad", 1.0, {0, 0, 0, 1}},       {"deg", pi / 180.0, {0, 0, 0, 1}},
      {"Hz", 2.0 * pi, {0, 0, -1, 1}}, {"turn", 2.0 * pi, {0, 0, 0, 1}}, {"count", 1.0, {0, 0, 0, 0}}};
  struct Wanted {
    Measure measure;
    Motion motion;
    std::vector<std::array<int, 4>> dimensions;
    double si;  // what the SI unit is in the bases above
  };
  const std::vector<Wanted> wanted = {
      {time, linear, {{0, 0, 1, 0}}, 1.0},
      {frequency_hz, linear, {{0, 0, -1, 1}}, 2.0 * pi},
      {position, linear, {{0, 1, 0, 0}}, 1.0},
      {force, linear, {{1, 1, -2, 0}}, 1.0},
      {mass, linear, {{1, 0, 0, 0}}, 1.0},
      {damping, linear, {{1, 0, -1, 0}}, 1.0},
      {stiffness, linear, {{1, 0, -2, 0}}, 1.0},
      {position, rotary, {{0, 0, 0, 1}}, 1.0},
      {mass, rotary, {{1, 2, 0, 0}, {1, 2, 0, -1}}, 1.0},
      {damping, rotary, {{1, 2, -1, -1}, {1, 2, -1, 0}}, 1.0},
      {stiffness, rotary, {{1, 2, -2, -1}, {1, 2, -2, 0}}, 1.0},
  };
  std::mt19937_64 random(7);
  int matches = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string text;
    double factor = 1.0;
    std::array<int, 4> dimensions{};
    const auto parts = 1 + random() % 4;
    for (std::uint64_t part = 0; part < parts; ++part) {
      const Base& base = bases[random() % bases.size()];
      const bool divides = part > 0 && random() % 2 == 0;
      const int power = random() % 4 == 0 ? 2 : 1;
      if (part > 0) text += divides ? "/" : (random() % 2 == 0 ? " " : ".");
      text += base.name + (power == 2 ? "^2" : "");
      const int exponent = divides ? -power : power;
      factor *= std::pow(base.factor, exponent);
      for (std::size_t d = 0; d < dimensions.size(); ++d) dimensions[d] += exponent * base.dimensions[d];
    }
    for (const Wanted& each : wanted) {
      const bool fits = std::ranges::find(each.dimensions, dimensions) != each.dimensions.end();
      const auto value = number_with_unit("3 " + text, each.measure, each.motion);
      ASSERT_EQ(value.has_value(), fits) << text << " seed 7, case " << i;
      if (!fits) continue;
      ++matches;
      EXPECT_NEAR(*value, 3.0 * factor / each.si, 1e-14 * std::abs(*value)) << text;
    }
  }
  EXPECT_GT(matches, 1000);
}

TEST(NumberWithUnit, AnyBytesAreReadOrRefused) {
  const std::vector<std::string> pieces = {"1",     "kg",     " ",      "m",  "/",    "^",           "(",    ")",
                                           "since", "@",      "lg(re ", "-",  "+",    ".",           "e9",   "s",
                                           "2",     "\u00b5", "\xff",   "**", "1990", ":",           "Hz",   "%",
                                           "0",     "N",      "rad",    "\n", "\t",   "99999999999", "from", "1-1-1"};
  std::mt19937_64 random(3);
  testing::internal::CaptureStderr();
  for (int i = 0; i < 20000; ++i) {
    std::string text = "3 ";
    for (std::uint64_t length = random() % 12; length > 0; --length) text += pieces[random() % pieces.size()];
    const auto value = number_with_unit(text, static_cast<Measure>(random() % 9), random() % 2 ? linear : rotary);
    if (value) {
      EXPECT_TRUE(std::isfinite(*value)) << text;
    }
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(NumberWithUnit, ThreadsDoNotDisturbEachOther) {
  std::vector<std::thread> threads;
  std::array<int, 4> wrong{};
  for (std::size_t t = 0; t < wrong.size(); ++t) {
    threads.emplace_back([&wrong, t] {
      for (int i = 0; i < 500; ++i) {
        const auto good = number_with_unit(fmt::format("{} kg cm^2", i), mass, rotary);
        const auto bad = number_with_unit("5 furlong", position, linear);
        if (!good || *good != i / 1e4 || bad) ++wrong[t];
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, (std::array<int, 4>{}));
}

TEST(DeviceFile, ReadsUnitsWhereverItReadsNumbers) {
  const std::string with_units = R"(
motion = "rotary"
[[body]]
name = "motor"
inertia = "22 kg cm^2"
damping = "5 mN m s/rad"
stiffness = "0.25 N m"
coulomb = "30 mN m"
[[body]]
name = "handle"
mass = "0.1 kg m^2"
[[link]]
between = ["motor", "handle"]
stiffness = "2 N m/rad"
damping = "4 mN m s/rad"
[loop]
sampling_period = "400 us"
delay = "1.5 ms"
[actuator]
time_constant = "2 ms"
force_limit = "800 mN m"
[sensor]
resolution = "2 mrad"
[wall]
stiffness = "3 N m/rad"
damping = "6 mN m s/rad"
velocity_filter_hz = "0.06 kHz"
[[wall.filter]]
type = "notch"
frequency_hz = "0.1 kHz"
damping_ratio = "50 %"
depth = "20 %"
[[wall.filter]]
type = "lead_lag"
frequency_hz = "80 Hz"
ratio = "300 %"
[operator]
inertia = "10 g m^2"
damping = "7 mN m s"
stiffness = "9 N m/rad"
)";
  const std::string with_numbers = R"(
motion = "rotary"
[[body]]
name = "motor"
inertia = 22e-4
damping = 5e-3
stiffness = 0.25
coulomb = 30e-3
[[body]]
name = "handle"
mass = 0.1
[[link]]
between = ["motor", "handle"]
stiffness = 2
damping = 4e-3
[loop]
sampling_period = 400e-6
delay = 1.5e-3
[actuator]
time_constant = 2e-3
force_limit = 0.8
[sensor]
resolution = 2e-3
[wall]
stiffness = 3
damping = 6e-3
velocity_filter_hz = 60
[[wall.filter]]
type = "notch"
frequency_hz = 100
damping_ratio = 0.5
depth = 0.2
[[wall.filter]]
type = "lead_lag"
frequency_hz = 80
ratio = 3
[operator]
inertia = 10e-3
damping = 7e-3
stiffness = 9
)";
  const auto units = parse_device(with_units, "device.toml");
  const auto numbers = parse_device(with_numbers, "device.toml");
  ASSERT_TRUE(units.has_value()) << units.error().str();
  ASSERT_TRUE(numbers.has_value()) << numbers.error().str();
  EXPECT_EQ(write_device(units->parameters()), write_device(numbers->parameters()));
  EXPECT_EQ(write_device(units->parameters()).find("kg"), std::string::npos);
}

TEST(NumberWithUnit, ACommaIsToldToBeAPoint) {
  for (const char* text : {"0,01", "0,01 kg", "1,000 kg"}) {
    const auto number = number_with_unit(text, mass, linear);
    ASSERT_FALSE(number.has_value()) << text;
    ASSERT_TRUE(number.error().problem) << text;
    EXPECT_EQ(number.error().problem->code, ProblemCode::decimal_comma);
    EXPECT_EQ(number.error().suggestion, with_decimal_point(text)) << text;
  }
}

TEST(NumberWithUnit, EveryNumberOfADeviceMeasuresSomething) {
  const auto device = parse_device(
      "[[body]]\nname = \"a b.c\"\nmass = 1\n[loop]\nsampling_period = 1e-3\n[actuator]\nforce_limit = 1\n[wall]\n"
      "stiffness = 1\n[[wall.filter]]\ntype = \"notch\"\nfrequency_hz = 60\n[[wall.filter]]\ntype = \"lead_lag\"\n"
      "frequency_hz = 60\nratio = 2\n",
      "device.toml");
  ASSERT_TRUE(device.has_value()) << device.error().str();
  for (const std::string& key : parameter_keys(device->parameters())) {
    const auto measure = measure_of(key);
    ASSERT_TRUE(measure.has_value()) << key;
    const std::string value = fmt::format("1 {}", *measure == ratio ? "count" : si_unit(*measure, linear));
    EXPECT_EQ(number_with_unit(value, *measure, linear).value_or(0.0), 1.0) << key;
  }
  EXPECT_EQ(measure_of("delay"), time);
  EXPECT_FALSE(measure_of("loop.sensed").has_value());
}

TEST(DeviceFile, ATimeConstantOfTheVelocityFilterIsBackwardEulers) {
  for (const double tau : {1e-4, 1e-3, 7e-3, 0.5}) {
    for (const double period : {1e-4, 1e-3, 0.02}) {
      const auto device = parse_device(
          fmt::format(
              "[[body]]\nname = \"a\"\nmass = 1\n[loop]\nsampling_period = {}\n[wall]\nvelocity_filter_tau = {}\n",
              period, tau),
          "device.toml");
      ASSERT_TRUE(device.has_value()) << device.error().str();
      // v[k] = v[k-1] + (T/(tau + T)) (u[k] - v[k-1]): tau (v[k] - v[k-1])/T + v[k] = u[k]
      EXPECT_NEAR(std::exp(-2.0 * pi * device->parameters().wall.velocity_filter_hz * period), tau / (tau + period),
                  1e-15);
    }
  }
  const std::vector<std::string> other{"wall.velocity_filter_hz=20"};
  const auto device = parse_device(
      "[[body]]\nname = \"a\"\nmass = 1\n[loop]\nsampling_period = 1e-3\n[wall]\nvelocity_filter_tau = \"2 ms\"\n",
      "device.toml", other);
  ASSERT_TRUE(device.has_value()) << device.error().str();
  EXPECT_EQ(device->parameters().wall.velocity_filter_hz, 20.0);
}

}  // namespace
}  // namespace zwidth

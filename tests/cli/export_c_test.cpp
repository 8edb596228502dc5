// `zwidth export --format c`: the code compiles without a warning, and runs as SampledController does.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "cli/workspace.hpp"
#include "zwidth/control/sampled_controller.hpp"
#include "zwidth/control/sampled_damper.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr int samples = 10'000;

struct CodeCase {
  std::string name;
  std::string text;
  std::string identifier;
  bool one_sided = false;
};

void PrintTo(const CodeCase& each, std::ostream* stream) { *stream << each.name; }

std::string device_named(const std::string& name, const std::string& rest) {
  return fmt::format("name = '{}'\n[[body]]\nname = \"handle\"\nmass = 2.0\ndamping = 3.0\n{}", name, rest);
}

const std::string loop = "[loop]\nsampling_period = 1e-3\n";
const std::string every_filter = R"([[wall.filter]]
type = "low_pass"
frequency_hz = 0.5
[[wall.filter]]
type = "low_pass"
frequency_hz = 180
order = 2
[[wall.filter]]
type = "notch"
frequency_hz = 60
damping_ratio = 0.2
[[wall.filter]]
type = "lead_lag"
frequency_hz = 30
ratio = 4
[[wall.filter]]
type = "biquad"
numerator = [1e-6, 1e-3, 1.0]
denominator = [4e-6, 2e-3, 1.0]
[[wall.filter]]
type = "digital"
numerator = [0.4, -0.2]
denominator = [1.0, -1.2, 0.5]
)";

std::vector<CodeCase> cases() {
  const std::string wall = loop + "[wall]\nstiffness = 1234.5\n";
  return {
      {"spring", device_named("Spring", wall), "spring"},
      {"spring_one_sided", device_named("9 */ lives? /* ?\?/", wall), "device_9_lives", true},
      {"damper", device_named("µ-é", wall + "damping = 7\n"), "device"},
      {"filtered_damper",
       device_named("a rather long name of a device", wall + "damping = 7\nvelocity_filter_hz = 40\n"),
       "a_rather_long_name_o", true},
      {"filters", device_named("int", wall + "damping = 7\nvelocity_filter_hz = 40\n" + every_filter), "int"},
      {"filters_one_sided", device_named("X__Y", wall + "damping = 7\n" + every_filter), "x_y", true},
      {"filters_limited",
       device_named("limit", loop + "[actuator]\nforce_limit = 0.03\n[wall]\nstiffness = 900\n" + every_filter),
       "limit"},
      {"fast",
       device_named("fast", "[loop]\nsampling_period = 2e-5\n[wall]\nstiffness = 5e4\ndamping = 11\n" + every_filter),
       "fast"},
  };
}

class ExportC : public Workspace, public ::testing::WithParamInterface<CodeCase> {};

TEST_P(ExportC, RunsAsTheController) {
  const CodeCase& each = GetParam();
  write("device.toml", each.text);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> anywhere(-2e-3, 2e-3);
  std::vector<double> positions;
  std::string lines;
  for (int k = 0; k < samples; ++k) {
    positions.push_back(anywhere(random));
    lines += fmt::format("{:.17g}\n", positions.back());
  }
  write("positions.txt", lines);
  write("main.c", fmt::format(R"(#include <stdio.h>
#include "wall.c"
int main(void) {{
  {0}_wall_t wall;
  double position;
  int k = 0;
  {0}_wall_reset(&wall);
  while (scanf("%lf", &position) == 1) {{
    if (++k == 5000) {0}_wall_reset(&wall);
    printf("%.17g\n", {0}_wall_force(&wall, position));
  }}
  return 0;
}}
)",
                              each.identifier));
  const Outcome outcome =
      run(fmt::format("zwidth export device.toml --format c --contact {} --output wall.c && "
                      "cc -std=c99 -Wall -Wextra -Werror -pedantic -Wmissing-prototypes -c wall.c && "
                      "cc -std=c99 -Wall -Wextra -Werror -pedantic -o wall main.c && ./wall < positions.txt",
                      each.one_sided ? "unilateral" : "bilateral"));
  ASSERT_EQ(outcome.status, 0) << outcome.errors;

  const Device device = *parse_device(each.text, "test");
  ControllerOptions options = wall_controller(device.parameters().wall);
  if (each.one_sided) options.contact = ControllerOptions::Contact::unilateral;
  SampledController controller(options, device.loop().sampling_period);
  const double limit = device.parameters().actuator.force_limit.value_or(1e300);
  std::istringstream forces(outcome.output);
  double largest = 0.0;
  bool saturates = false;
  for (int k = 0; k < samples; ++k) {
    if (k == 4999) controller.reset();
    const double expected = std::clamp(controller.update(positions[static_cast<std::size_t>(k)]), -limit, limit);
    double force = 0.0;
    ASSERT_TRUE(forces >> force) << k;
    ASSERT_NEAR(force, expected, 1e-12 * std::abs(expected)) << k;
    largest = std::max(largest, std::abs(expected));
    saturates = saturates || std::abs(expected) == limit;
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_EQ(saturates, device.parameters().actuator.force_limit.has_value());
}

INSTANTIATE_TEST_SUITE_P(Walls, ExportC, ::testing::ValuesIn(cases()),
                         [](const auto& each) { return each.param.name; });

struct TwoRateCodeCase {
  std::string name;
  std::string damper;  // keys of [loop.damper]
  std::string wall;    // keys of [wall], and tables behind it
  bool one_sided = false;
};

void PrintTo(const TwoRateCodeCase& each, std::ostream* stream) { *stream << each.name; }

class ExportCOfTwoRates : public Workspace, public ::testing::WithParamInterface<TwoRateCodeCase> {};

// Both steps at their instants, on any positions.
TEST_P(ExportCOfTwoRates, RunsAsSpringAndDamper) {
  const TwoRateCodeCase& each = GetParam();
  const std::string text =
      device_named("two", loop + "[loop.damper]\n" + each.damper + "[wall]\nstiffness = 1234.5\n" + each.wall);
  write("device.toml", text);
  const Device device = *parse_device(text, "test");
  const double spring_period = device.loop().sampling_period;
  const double damper_period = damper_timing(device.loop()).sampling_period;
  const bool is_fast = damper_period < spring_period;
  const int ratio =
      static_cast<int>(std::lround(is_fast ? spring_period / damper_period : damper_period / spring_period));
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> anywhere(-2e-3, 2e-3);
  std::vector<double> positions;
  std::string lines;
  for (int k = 0; k < samples; ++k) {
    positions.push_back(anywhere(random));
    lines += fmt::format("{:.17g}\n", positions.back());
  }
  write("positions.txt", lines);
  write("main.c", fmt::format(R"(#include <stdio.h>
#include "wall.c"
int main(void) {{
  two_damper_t damper;
  double position, of_damper = 0.0, of_spring = 0.0;
  int k = 0;
  two_damper_reset(&damper);
  for (; scanf("%lf", &position) == 1; ++k) {{
    if (k == 5000) two_damper_reset(&damper);
    if (k % {0} == 0) of_damper = two_damper_step(&damper, position);
    if (k % {1} == 0) of_spring = two_spring_step(position);
    printf("%.17g\n", two_wall_sum(of_spring, of_damper));
  }}
  return 0;
}}
)",
                              is_fast ? 1 : ratio, is_fast ? ratio : 1));
  const Outcome outcome =
      run(fmt::format("zwidth export device.toml --format c --contact {} --output wall.c && "
                      "cc -std=c99 -Wall -Wextra -Werror -pedantic -Wmissing-prototypes -c wall.c && "
                      "cc -std=c99 -Wall -Wextra -Werror -pedantic -o wall main.c && ./wall < positions.txt",
                      each.one_sided ? "unilateral" : "bilateral"));
  ASSERT_EQ(outcome.status, 0) << outcome.errors;

  ControllerOptions options = wall_controller(device.parameters().wall);
  if (each.one_sided) options.contact = ControllerOptions::Contact::unilateral;
  SampledController spring(without_damper(options), spring_period);
  SampledDamper damper(options, damper_period);
  const double limit = device.parameters().actuator.force_limit.value_or(1e300);
  std::istringstream forces(outcome.output);
  double of_spring = 0.0;
  double of_damper = 0.0;
  bool saturates = false;
  for (int k = 0; k < samples; ++k) {
    const double position = positions[static_cast<std::size_t>(k)];
    if (k == 5000) damper.reset();
    if (is_fast || k % ratio == 0) of_damper = damper.update(position);
    if (!is_fast || k % ratio == 0) of_spring = spring.update(position);
    const double expected = std::clamp(sum_of_paths(of_spring, of_damper, each.one_sided), -limit, limit);
    double force = 0.0;
    ASSERT_TRUE(forces >> force) << k;
    ASSERT_NEAR(force, expected, 1e-12 * (std::abs(of_spring) + std::abs(of_damper))) << k;
    saturates = saturates || std::abs(expected) == limit;
  }
  EXPECT_EQ(saturates, device.parameters().actuator.force_limit.has_value());
}

INSTANTIATE_TEST_SUITE_P(
    Walls, ExportCOfTwoRates,
    ::testing::Values(
        TwoRateCodeCase{"damper_on_the_drive", "sampling_period = 1e-4\n", "damping = 7\n"},
        TwoRateCodeCase{"filtered", "sampling_period = 2e-4\ndelay = 1e-4\n", "damping = 7\nvelocity_filter_hz = 40\n"},
        TwoRateCodeCase{"slow", "sampling_period = 5e-3\n", "damping = 7\n"},
        TwoRateCodeCase{"one_sided", "sampling_period = 1e-4\n", "damping = 7\n", true},
        TwoRateCodeCase{"limited", "sampling_period = 1e-4\n", "damping = 7\n[actuator]\nforce_limit = 0.03\n"}),
    [](const auto& each) { return each.param.name; });

class ExportCCommand : public Workspace {};

TEST_F(ExportCCommand, ADamperInALoopOfItsOwnHasAStepOfItsOwn) {
  const std::string device = "zwidth export devices/lhifam.toml --format c --set wall.stiffness=1000 ";
  const Outcome apart = run(device + "--set wall.damping=5 --set loop.damper.sampling_period=1e-4");
  ASSERT_EQ(apart.status, 0) << apart.errors;
  EXPECT_THAT(apart.output, HasSubstr("_spring_step per 0.001 s"));
  EXPECT_THAT(apart.output, HasSubstr("_damper_step per 0.0001 s"));
  EXPECT_THAT(apart.output, Not(HasSubstr("_wall_force")));
  // One that runs with the spring, or does nothing, has none.
  const Outcome together = run(device + "--set wall.damping=5");
  EXPECT_EQ(run(device + "--set wall.damping=5 --set loop.damper.sampling_period=1e-3").output, together.output);
  EXPECT_THAT(run(device + "--set loop.damper.sampling_period=1e-4").output, HasSubstr("_wall_force"));
}

TEST_F(ExportCCommand, SaysWhatItIsValidFor) {
  const Outcome outcome =
      run("zwidth export devices/lhifam.toml --format c --set wall.stiffness=1000 --set loop.delay=0.25e-3 "
          "--set 'wall.filter=[{type=\"notch\", frequency_hz=83}]'");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
  EXPECT_THAT(outcome.output, HasSubstr("/* Virtual wall for LHIfAM, translational axis\n"));
  EXPECT_THAT(outcome.output, HasSubstr("stiffness K         1000 N/m (wall.stiffness)"));
  EXPECT_THAT(outcome.output, HasSubstr("notch 83 Hz, depth 0.1"));
  EXPECT_THAT(outcome.output, HasSubstr("one call per sampling period of 0.001 s, at a delay of 0.00025 s"));
  EXPECT_THAT(outcome.output, HasSubstr("critical stiffness"));
  EXPECT_THAT(outcome.output, HasSubstr("any passive user"));
  EXPECT_THAT(outcome.output, Not(HasSubstr("UNSTABLE")));
}

TEST_F(ExportCCommand, AnUnstableWallIsWrittenAndSaid) {
  const Outcome outcome = run("zwidth export devices/lhifam.toml --format c --stiffness 20000");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.errors, HasSubstr("UNSTABLE"));
  EXPECT_THAT(outcome.output, HasSubstr("WARNING: with this wall the loop is UNSTABLE"));
  EXPECT_THAT(outcome.output, HasSubstr("20000 N/m (--stiffness)"));
}

TEST_F(ExportCCommand, ASafetyFactorSetsTheStiffness) {
  const Outcome outcome = run("zwidth export devices/lhifam.toml --format c --safety-factor 0.5");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("(0.5 of the limit for any user)"));
  EXPECT_THAT(outcome.output, HasSubstr("stiffness K         2888."));  // of 5776.09 N/m
}

TEST_F(ExportCCommand, AShareOfAnUncertainLimitSaysOfWhat) {
  write("uncertain.toml", contents("devices/lhifam.toml") +
                              "\n[uncertainty]\nparameters = ['body.handle.damping']\ncovariance = [[0.04]]\n");
  const Outcome outcome = run("zwidth export uncertain.toml --format c --safety-factor 0.5");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("(0.5 of the limit for any user, at 0.85"));
  EXPECT_THAT(outcome.output, HasSubstr(" of it: the lower end of the limits' 95 % intervals)"));
}

TEST_F(ExportCCommand, WhereTheSoftestWallsAreUnstableThereIsNoShare) {
  write("none.toml", "[[body]]\nname = 'a'\nmass = 1\n[loop]\nsampling_period = 1e-3\n");
  const Outcome outcome = run("zwidth export none.toml --format c --safety-factor 0.5");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("--safety-factor: no wall is stable from K = 0 on: there is no limit"));
}

TEST_F(ExportCCommand, WhatDoesNotFitIsRefused) {
  const auto refusal = [&](const std::string& rest) {
    const Outcome outcome = run("zwidth export devices/lhifam.toml " + rest);
    EXPECT_EQ(outcome.status, 2) << rest;
    EXPECT_EQ(outcome.output, "");
    return outcome.errors;
  };
  EXPECT_THAT(refusal("--format c"), HasSubstr("wall.stiffness: is missing"));
  EXPECT_THAT(refusal("--format c --stiffness -3"), HasSubstr("--stiffness: is -3; must be a number of N/m > 0"));
  EXPECT_THAT(refusal("--format c --stiffness 1e40"), HasSubstr("--stiffness: wall.stiffness is 1e+40"));
  EXPECT_THAT(refusal("--format c --stiffness nan"), HasSubstr("--stiffness"));
  EXPECT_THAT(refusal("--format c --safety-factor 1"), HasSubstr("above 0 and below 1"));
  EXPECT_THAT(refusal("--format c --stiffness 3 --safety-factor 0.5"), HasSubstr("give one of them"));
  EXPECT_THAT(refusal("--format c --contact both --stiffness 3"), HasSubstr("--contact"));
  EXPECT_THAT(refusal("--format json --contact unilateral"), HasSubstr("--contact: is for --format c"));
  EXPECT_THAT(refusal("--format python --safety-factor 0.5"),
              HasSubstr("--safety-factor: is for --format c and chai3d"));
  EXPECT_THAT(refusal("--format chai3d --stiffness 3"), HasSubstr("--stiffness: is for --format c"));
}

TEST_F(ExportCCommand, Chai3dCeilings) {
  const Outcome linear = run("zwidth export devices/lhifam.toml --format chai3d");
  ASSERT_EQ(linear.status, 0) << linear.errors;
  EXPECT_THAT(linear.output, HasSubstr("m_specifications.m_maxLinearStiffness = 2888.0;  // [N/m]\n"));
  EXPECT_THAT(linear.output, HasSubstr("m_specifications.m_maxLinearDamping = "));
  EXPECT_THAT(linear.output, HasSubstr("the limit for any passive user"));
  write("rotary.toml",
        "motion = 'rotary'\n[[body]]\nname = 'a'\ninertia = 1e-4\ndamping = 1e-3\n[loop]\nsampling_period = 1e-3\n");
  const Outcome rotary = run("zwidth export rotary.toml --format chai3d --safety-factor 0.8");
  ASSERT_EQ(rotary.status, 0) << rotary.errors;
  EXPECT_THAT(rotary.output, HasSubstr("m_specifications.m_maxAngularStiffness = 1.6;  // [N m/rad]\n"));  // 2 b/T
  EXPECT_THAT(rotary.output, HasSubstr("m_maxAngularDamping"));
  write("none.toml", "[[body]]\nname = 'a'\nmass = 1\n[loop]\nsampling_period = 1e-3\n");
  const Outcome none = run("zwidth export none.toml --format chai3d");
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.errors, HasSubstr("none.toml: there is no ceiling to declare"));
}

}  // namespace
}  // namespace zwidth::cli

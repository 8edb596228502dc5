#include "rig/rig_actions.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "lhifam.hpp"
#include "rig/measured_as_predicted.hpp"
#include "rig/rig_devices.hpp"
#include "rig/simulated_driver.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::rig {
namespace {

constexpr std::uint64_t devices = 20;

class OnDevice : public testing::TestWithParam<std::uint64_t> {
 protected:
  Device device = test::bench_device(GetParam());
  SimulatedDriver driver{device, 0.0, false};
};

// A mode that may oscillate is played: that of the LHIfAM at 98.37 Hz, though its limit is at 6.143 Hz.
TEST(DefaultMeasurement, ReachesAboveEveryCrossover) {
  const auto band_of = [](const DeviceParameters& parameters) {
    const ExcitationOptions excitation = default_measurement(Device(parameters)).excitation;
    return std::pair(excitation.lowest_hz, excitation.highest_hz);
  };
  DeviceParameters parameters = test::lhifam_parameters();
  const auto [lowest, highest] = band_of(parameters);
  EXPECT_NEAR(lowest, 6.143 / 5.0, 1e-3);
  EXPECT_NEAR(highest, 2.5 * 98.37, 0.1);
  parameters.user.mass = 50.0;  // in hand its crossovers lie elsewhere: those with nobody holding count all the same
  EXPECT_GE(band_of(parameters).second, highest * (1.0 - 1e-9));
  parameters.user = {};
  parameters.loop.sampling_period = 4e-3;
  EXPECT_LE(band_of(parameters).second, 0.8 * 125.0);
  parameters = test::lhifam_parameters();
  parameters.links.clear();
  parameters.bodies = {{"body", 5.4, 3.5, 0.0, 0.0}};
  parameters.loop.held = 0;
  const auto rigid = band_of(parameters);
  EXPECT_NEAR(rigid.second / rigid.first, 5.0 * 8.0, 1e-9);
}

TEST_P(OnDevice, TheLimitIsMeasuredWhereItIsPredicted) { expect_limit(device, driver); }

// A step of 0.001 to 0.3 of the swing that the force makes: the coarsest hide a growth that is not there or is.
TEST(OnDeviceWithAnEncoder, TheLimitLiesWithinItsInterval) {
  int sound = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    DeviceParameters parameters = test::bench_device(seed).parameters();
    const double truth = critical_stiffness(Device(parameters)).stiffness;
    std::mt19937_64 engine(seed);
    const double share = std::exp(std::uniform_real_distribution(std::log(1e-3), std::log(0.3))(engine));
    parameters.sensor.resolution = share * default_force(Device(parameters)) / truth;
    const Device device(parameters);
    SimulatedDriver driver{device, 0.0, false};
    const LimitMeasurement measured = measure_limit(device, driver, {}, default_limit(device), {}).measured;
    ASSERT_TRUE(measured.stiffness && measured.interval);
    EXPECT_LE(measured.interval->lower, truth);
    EXPECT_GE(measured.interval->upper, truth);
    if (!measured.trust.sound()) continue;
    ++sound;
    EXPECT_NEAR(*measured.stiffness / truth, 1.0, 0.02);
  }
  EXPECT_GT(sound, 30);
}

// Of a linear device all swings grow alike, and the limit is sure. With dry friction of a thousandth to some hundredths of
// the impulse, of which the file knows nothing, limits of 3 to 48 % too much were called sound.
TEST_P(OnDevice, ALimitByFrictionThatTheFileDoesNotKnowIsNotSure) {
  const LimitOptions limit = default_limit(device);
  EXPECT_TRUE(measure_limit(device, driver, {}, limit, {}).measured.trust.sound());
  const double truth = critical_stiffness(device).stiffness;
  for (const double share : {0.001, 0.003, 0.01, 0.02}) {
    SCOPED_TRACE(share);
    DeviceParameters parameters = device.parameters();
    parameters.bodies.front().coulomb = share * limit.impulse;
    SimulatedDriver with_friction{Device(parameters), 0.0, false};
    const LimitMeasurement measured = measure_limit(device, with_friction, {}, limit, {}).measured;
    if (measured.interval) {
      EXPECT_LE(measured.interval->lower, truth);
    }
    if (!measured.trust.sound()) continue;
    ASSERT_TRUE(measured.stiffness && measured.interval);
    EXPECT_NEAR(*measured.stiffness / truth, 1.0, 0.02);
    EXPECT_LT(share, 0.01);
  }
}

// Three of them have one body and two, turn and slide, with and without delay and lag. ZWIDTH_CAMPAIGN_DEVICES=20: as many.
std::vector<std::uint64_t> identified_seeds() {
  const char* campaign = std::getenv("ZWIDTH_CAMPAIGN_DEVICES");
  if (campaign == nullptr) return {5, 6, 10};
  std::vector<std::uint64_t> seeds(std::strtoul(campaign, nullptr, 10));
  std::iota(seeds.begin(), seeds.end(), std::uint64_t{1});
  return seeds;
}

class IdentifiedDevice : public OnDevice {};
TEST_P(IdentifiedDevice, IdentifyingItClosesTheCircle) { expect_identified(device, driver); }
INSTANTIATE_TEST_SUITE_P(Bench, IdentifiedDevice, testing::ValuesIn(identified_seeds()));

// All trials begin at rest with the whole force, as those of the simulation do. The rest is not perfect, and a sampled relay
// holds many oscillations side by side: the later trials may settle at a neighbour of the first one's.
TEST_P(OnDevice, TheRelayReadsWhatItReadsInSimulation) {
  RelayTrialsOptions trials;
  trials.relay.amplitude = default_force(device);
  const RigRelay measured = relay_on_rig(device, driver, {}, trials, {});
  RelayOptions options;
  options.relay = trials.relay;
  const RelayResult simulated = relay(device, options);
  ASSERT_TRUE(measured.relay && measured.relay->mean);
  ASSERT_EQ(measured.relay->trials.size(), 4U);
  ASSERT_TRUE(simulated.mean);
  const RelayReading& first = *measured.relay->trials.front().result;
  EXPECT_NEAR(first.frequency / simulated.mean->frequency, 1.0, 1e-9);
  EXPECT_NEAR(first.stiffness / simulated.mean->stiffness, 1.0, 1e-9);
  EXPECT_NEAR(measured.relay->mean->frequency / simulated.mean->frequency, 1.0, 0.05);
  EXPECT_NEAR(measured.relay->mean->stiffness / simulated.mean->stiffness, 1.0, 0.05);
}

// One that seeks the limit's oscillation has nothing to seek where there is one body, and so no faster one.
TEST_P(OnDevice, ARelayThatSeeksTheLimitReadsTheSameOfARigidDevice) {
  if (device.bodies().size() > 1) return;
  RelayTrialsOptions trials;
  trials.relay.amplitude = default_force(device);
  trials.seek_limit = true;
  const RigRelay measured = relay_on_rig(device, driver, {}, trials, {});
  RelayOptions options;
  options.relay = trials.relay;
  const RelayResult simulated = relay(device, options);
  ASSERT_TRUE(measured.relay && measured.relay->mean && simulated.mean);
  EXPECT_NEAR(measured.relay->mean->frequency / simulated.mean->frequency, 1.0, 0.05);
  EXPECT_NEAR(measured.relay->mean->stiffness / simulated.mean->stiffness, 1.0, 0.05);
}

// Their trials found different oscillations: the first began with a force that grew, the later ones from what was left of
// the one before, on dry friction from where the device stuck.
TEST(RigRelay, ShippedDevicesReadWhatTheyReadInSimulation) {
  for (const char* name : {"emps", "two_mass_drive", "quanser_torsion", "lhifam_rigid"}) {
    SCOPED_TRACE(name);
    const auto device = read_device_file(fmt::format(ZWIDTH_SOURCE_DIR "/devices/{}.toml", name));
    ASSERT_TRUE(device) << device.error().str();
    RelayTrialsOptions trials;
    trials.relay.amplitude = default_force(*device);
    SimulatedDriver driver{*device, 0.0, false};
    const RigRelay measured = relay_on_rig(*device, driver, {}, trials, {});
    RelayOptions options;
    options.relay = trials.relay;
    const RelayResult simulated = relay(*device, options);
    ASSERT_TRUE(measured.relay && measured.relay->mean && simulated.mean);
    EXPECT_NEAR(measured.relay->mean->frequency / simulated.mean->frequency, 1.0, 0.05);
    EXPECT_NEAR(measured.relay->mean->stiffness / simulated.mean->stiffness, 1.0, 0.05);
  }
}

// Within its encoder's step the start decides between 6.35 Hz and 64 Hz, in simulation too (relay --start 3e-5).
TEST(RigRelay, ALoopWithTwoOscillationsNamesBoth) {
  const auto device = read_device_file(ZWIDTH_SOURCE_DIR "/devices/lhifam_reduced_pretension.toml");
  ASSERT_TRUE(device) << device.error().str();
  RelayTrialsOptions trials;
  trials.relay.amplitude = default_force(*device);
  SimulatedDriver driver{*device, 0.0, false};
  const RigRelay measured = relay_on_rig(*device, driver, {}, trials, {});
  ASSERT_TRUE(measured.relay);
  EXPECT_FALSE(measured.relay->mean);
  EXPECT_TRUE(measured.trust.refused());
  EXPECT_THAT(
      measured.trust.reasons,
      testing::Contains(testing::ContainsRegex(
          "6\\.[0-9]+ (to 6\\.[0-9]+ )?Hz \\(1[0-9].* and 6[0-9]\\.[0-9]+ (to 6[0-9]\\.[0-9]+ )?Hz \\(2[0-9]")));
}

// Where a bare relay finds a faster oscillation, one that seeks the limit's finds it.
TEST(RigRelay, SeeksTheOscillationOfTheLimitWhereAsked) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.sensor.resolution = 3.14e-6;
  const Device device(parameters);
  RelayTrialsOptions trials;
  trials.relay.amplitude = 5.0;
  const auto read = [&] {
    SimulatedDriver driver{device, 0.0, false};
    return relay_on_rig(device, driver, {}, trials, {});
  };
  const RigRelay bare = read();
  trials.seek_limit = true;
  const RigRelay sought = read();
  ASSERT_TRUE(bare.relay && bare.relay->mean && sought.relay && sought.relay->mean);
  EXPECT_GT(bare.relay->mean->frequency, 5.0 * sought.relay->mean->frequency);
  EXPECT_EQ(bare.relay->limit_reading, LimitReading::unsafe);
  EXPECT_FALSE(bare.trust.sound());
  const double limit = critical_stiffness(device).limit->frequency;
  EXPECT_NEAR(sought.relay->mean->frequency / limit, 1.0, 0.15);
}

// Trials that began before the force was there read an oscillation of less.
TEST(RigRelay, NoTrialIsReadWhileTheForceGrows) {
  const Device device = test::bench_device(1);
  RelayTrialsOptions trials;
  trials.seek_limit = true;
  trials.relay.amplitude = default_force(device);
  trials.trials = 1;
  trials.duration = 10.0;
  const auto read_with = [&](double ramp) {
    SimulatedDriver driver{device, 0.0, false};
    RigOptions options;
    options.limits.ramp = ramp;
    return relay_on_rig(device, driver, options, trials, {});
  };
  const RigRelay at_once = read_with(0.0);
  const RigRelay slowly = read_with(10.0);
  ASSERT_TRUE(at_once.relay && at_once.relay->mean && slowly.relay && slowly.relay->mean);
  EXPECT_DOUBLE_EQ(slowly.relay->relay.amplitude, trials.relay.amplitude);
  for (const double force : slowly.relay->trials.front().force) {
    ASSERT_DOUBLE_EQ(std::abs(force), trials.relay.amplitude);
  }
  EXPECT_NEAR(slowly.relay->mean->stiffness / at_once.relay->mean->stiffness, 1.0, 0.02);
  EXPECT_NEAR(slowly.relay->mean->amplitude / at_once.relay->mean->amplitude, 1.0, 0.02);
}

// Of trials that began with the bare relay one in six found the oscillation of the cable, near 98 Hz.
TEST(RigRelay, AllTrialsBeginAlike) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.sensor.resolution = 3.14e-6;
  const Device device(parameters);
  RelayTrialsOptions trials;
  trials.seek_limit = true;
  for (const double amplitude : {5.0, 8.0, 10.0, 15.0, 20.0}) {
    for (const double start : {0.0, 1e-4}) {
      SCOPED_TRACE(testing::Message() << amplitude << " N from " << start << " m");
      trials.relay.amplitude = amplitude;
      SimulatedDriver driver{device, start, false};
      const RigRelay measured = relay_on_rig(device, driver, {}, trials, {});
      ASSERT_TRUE(measured.relay && measured.relay->mean);
      ASSERT_EQ(measured.relay->trials.size(), trials.trials);
      const RelayReading& first = *measured.relay->trials.front().result;
      for (const RelayTrial& trial : measured.relay->trials) {
        ASSERT_TRUE(trial.result);
        EXPECT_NEAR(trial.result->frequency / first.frequency, 1.0, 0.15);
        EXPECT_NEAR(trial.result->stiffness / first.stiffness, 1.0, 0.15);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bench, OnDevice, testing::Range(std::uint64_t{1}, devices + 1));

}  // namespace
}  // namespace zwidth::rig

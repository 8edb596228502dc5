// What no number of a structure is, simulated. Such records were sound, and up to 124 % too high (a tester's).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/time_domain.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::suspected_motions_test {
namespace {

constexpr double period = 1e-3;
constexpr int steps = 40;  // of a sample

// A body, or two on a link, on a frame that the motor's reaction shakes; the last body is sensed, against the ground.
struct Rig {
  std::vector<double> masses = {0.667};
  std::vector<double> dampings = {4.46};  // of the first against the frame, of others against the ground
  double link = 0.0;                      // N/m
  double link_damping = 0.0;
  double frame = 0.0;        // kg; 0: it does not move. 13 Hz, damping ratio 0.05
  double skew = 0.0;         // the position's clock is slower by this share
  double slip = 0.0;         // N: of a spring beside the link that slips
  double slip_spring = 0.0;  // N/m
  ExcitationKind kind = ExcitationKind::logarithmic_chirp;
};

Recording record_of(const Rig& rig, std::uint64_t seed) {
  ExcitationOptions excitation;
  excitation.kind = rig.kind;
  excitation.amplitude = 6.0;
  excitation.lowest_hz = 1.0;
  excitation.highest_hz = 200.0;
  excitation.duration = 10.0;
  excitation.seed = seed;
  const std::vector<double> force = excite(excitation).samples;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 2e-6);
  const std::size_t bodies = rig.masses.size();
  const double frame_frequency = 2.0 * std::acos(-1.0) * 13.0;
  constexpr double step = period / steps;
  std::vector<double> x(bodies, 0.0);
  std::vector<double> v(bodies, 0.0);
  double frame = 0.0;
  double frame_speed = 0.0;
  double slipping = 0.0;  // stretch of the spring that slips
  std::vector<double> fine{0.0};
  for (const double command : force) {
    for (int i = 0; i < steps; ++i) {  // leapfrog
      for (std::size_t b = 0; b < bodies; ++b) x[b] += 0.5 * step * v[b];
      frame += 0.5 * step * frame_speed;
      std::vector<double> acting(bodies, 0.0);
      const double rubbing = rig.dampings[0] * (v[0] - frame_speed);
      acting[0] = command - rubbing;
      if (bodies == 2) {
        const double limit = rig.slip_spring > 0.0 ? rig.slip / rig.slip_spring : 0.0;
        slipping = std::fmin(std::fmax(slipping + step * (v[1] - v[0]), -limit), limit);
        const double pull = rig.link * (x[1] - x[0]) + rig.link_damping * (v[1] - v[0]) + rig.slip_spring * slipping;
        acting[0] += pull;
        acting[1] = -pull - rig.dampings[1] * v[1];
      }
      if (rig.frame > 0.0) {
        frame_speed += step * ((rubbing - command) / rig.frame - 0.1 * frame_frequency * frame_speed -
                               frame_frequency * frame_frequency * frame);
      }
      frame += 0.5 * step * frame_speed;
      for (std::size_t b = 0; b < bodies; ++b) {
        v[b] += step * acting[b] / rig.masses[b];
        x[b] += 0.5 * step * v[b];
      }
      fine.push_back(x.back());
    }
  }
  std::vector<double> position;
  for (std::size_t k = 0; k < force.size(); ++k) {
    const double at = static_cast<double>(k) * steps * (1.0 - rig.skew);
    const auto before = static_cast<std::size_t>(at);
    const double between = at - static_cast<double>(before);
    const double exact = (1.0 - between) * fine[before] + between * fine[before + 1];
    constexpr double count = 1e-6;
    position.push_back(count * std::round((exact + normal(random)) / count));
  }
  return {"seed " + std::to_string(seed), period, {{"force", force}, {"position", position}}, {}};
}

Device structure_of(const Rig& rig) {
  DeviceParameters device;
  device.name = "rig";
  for (std::size_t b = 0; b < rig.masses.size(); ++b) {
    device.bodies.push_back({"body " + std::to_string(b), rig.masses[b], rig.dampings[b]});
  }
  if (rig.masses.size() == 2) device.links.push_back({0, 1, rig.link, rig.link_damping});
  device.loop = {0, rig.masses.size() - 1, rig.masses.size() - 1, period, 0.0};
  return Device(device);
}

std::string joined(const std::vector<std::string>& reasons) {
  std::string all;
  for (const std::string& each : reasons) all += each + "\n";
  return all;
}

std::string reasons_in_lines(const Rig& rig) {
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  return joined(identify(record_of(rig, 7), structure_of(rig), options).trust.reasons);
}

std::string reasons_in_time(const Rig& rig) {
  TimeDomainOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  const Recording recording = record_of(rig, 7);
  return joined(identify_in_time(std::span(&recording, 1), structure_of(rig), options).trust.reasons);
}

Rig two_bodies() {
  Rig rig;
  rig.masses = {0.133, 0.52};
  rig.dampings = {0.85, 1.58};
  rig.link = 11300.0;
  rig.link_damping = 1.06;
  rig.kind = ExcitationKind::noise;
  return rig;
}

// It was predicted from its past as if it were noise.
TEST(SuspectedMotions, AFrameThatShakesIsAModeThatTheStructureLacks) {
  Rig rig;
  rig.frame = 2.0;
  rig.kind = ExcitationKind::noise;
  EXPECT_NE(reasons_in_time(rig).find("that the structure lacks"), std::string::npos) << reasons_in_time(rig);
}

TEST(SuspectedMotions, AFrameThatShakesIsSeenInLinesToo) {
  Rig rig;
  rig.frame = 5.0;
  EXPECT_NE(reasons_in_lines(rig).find("that the structure lacks"), std::string::npos) << reasons_in_lines(rig);
}

TEST(SuspectedMotionsCampaign, ClocksThatRunApartAreADelayThatChanges) {
  Rig rig = two_bodies();
  rig.skew = 5e-5;
  EXPECT_NE(reasons_in_lines(rig).find("clocks of force and position run apart"), std::string::npos)
      << reasons_in_lines(rig);
}

TEST(SuspectedMotions, ClocksThatRunApartAreSeenInTimeToo) {
  Rig rig;
  rig.skew = 5e-5;
  rig.kind = ExcitationKind::noise;
  EXPECT_NE(reasons_in_time(rig).find("clocks of force and position run apart"), std::string::npos)
      << reasons_in_time(rig);
}

TEST(SuspectedMotionsCampaign, ASpringThatSlipsBesideTheLinkIsFrictionInIt) {
  Rig rig = two_bodies();
  rig.slip = 0.1;
  rig.slip_spring = 1850.0;
  EXPECT_NE(reasons_in_lines(rig).find("friction in a link"), std::string::npos) << reasons_in_lines(rig);
}

TEST(SuspectedMotions, ASpringThatSlipsIsSeenInTimeToo) {
  Rig rig = two_bodies();
  rig.slip = 0.1;
  rig.slip_spring = 1850.0;
  EXPECT_NE(reasons_in_time(rig).find("friction in a link"), std::string::npos) << reasons_in_time(rig);
}

// What lies before a load cell is in no record of it: 3 to 7 times too high, and sound.
TEST(SuspectedMotions, OfANamedStructureItIsSaidThatTheForceIsTheCommand) {
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  const auto says_so = [](const std::vector<Remark>& remarks) {
    return std::ranges::any_of(remarks, [](const Remark& each) {
      return each.consequence.find("load cell") != std::string::npos &&
             each.remedy.find("loop.delay") != std::string::npos;
    });
  };
  const Recording recording = record_of(Rig{}, 7);
  const Device structure = structure_of(Rig{});
  EXPECT_TRUE(says_so(identify(recording, structure, options).remarks));
  EXPECT_FALSE(says_so(identify(recording, structure).remarks));
  TimeDomainOptions in_time;
  in_time.structure_values = IdentifyOptions::StructureValues::placeholders;
  EXPECT_TRUE(says_so(identify_in_time(std::span(&recording, 1), structure, in_time).remarks));
}

TEST(SuspectedMotions, WithoutThemTheAnswerIsSound) {
  EXPECT_EQ(reasons_in_lines(Rig{}), "");
  EXPECT_EQ(reasons_in_time(Rig{}), "");
}

TEST(SuspectedMotionsCampaign, OfTwoBodiesWithoutThemTheAnswerIsSound) {
  EXPECT_EQ(reasons_in_lines(two_bodies()), "");
}

}  // namespace
}  // namespace zwidth::suspected_motions_test

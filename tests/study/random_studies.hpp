#pragma once

#include <string_view>

#include "property/random_devices.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/study/study_run.hpp"

namespace zwidth::test {

/// A random device of which five numbers vary, each in its own way, by 1 to 15 %, delay included; of a rigid one the two
/// that it has of them.
inline StudyRun random_study(std::uint64_t seed, StudyOptions options, std::string_view kind = "two_mass") {
  RandomDevices random(seed);
  const Device device(random.device(kind));
  StudyDistributions distributions;
  for (const char* key : {"body.motor.mass", "body.handle.damping", "link.0.stiffness", "link.0.damping"}) {
    if (!parameter(device.parameters(), key)) continue;
    const double own = *parameter(device.parameters(), key);
    const double spread = own * random.log_uniform(0.01, 0.15);
    Distribution one{.kind = Distribution::Kind::normal, .centre = own, .deviation = spread};
    if (random.chance(0.5)) {
      one = {.kind = Distribution::Kind::uniform, .lower = own - 2.0 * spread, .upper = own + 2.0 * spread};
    } else {
      one.lower = own - 5.0 * spread, one.upper = own + 5.0 * spread;
    }
    distributions.parameters.push_back({key, one});
  }
  const double period = device.loop().sampling_period;
  distributions.parameters.push_back(
      {"loop.delay", {.kind = Distribution::Kind::uniform, .lower = 0.0, .upper = random.uniform(0.1, 1.5) * period}});
  return {device, distributions, options};
}

}  // namespace zwidth::test

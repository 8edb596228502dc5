#pragma once

#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "identification/campaign/simulator.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/signal/recording.hpp"

/// Records of a device by the campaign's simulator, which shares nothing with the library.
namespace zwidth::test {

/// The device with its friction; its operator rides on the held body.
inline simulated::Plant plant_of(const DeviceParameters& device) {
  simulated::Plant plant;
  for (const Body& body : device.bodies) {
    plant.masses.push_back({.mass = body.mass,
                            .damping = body.damping,
                            .stiffness = body.stiffness,
                            .friction = {.coulomb = body.coulomb}});
  }
  simulated::Mass& held = plant.masses[device.loop.held];
  held.mass += device.user.mass;
  held.damping += device.user.damping;
  held.stiffness += device.user.stiffness;
  for (const Link& link : device.links) {
    plant.joints.push_back(
        {.first = link.first, .second = link.second, .stiffness = link.stiffness, .damping = link.damping});
  }
  plant.drive.delay = device.loop.delay;
  plant.drive.lag = device.actuator.time_constant;
  plant.actuated = device.loop.actuated;
  plant.sensed = device.loop.sensed;
  return plant;
}

/// Of the sensed body from rest, under commands that are held.
inline std::vector<double> simulated_positions(const simulated::Plant& plant, std::span<const double> commands,
                                               double period = 1e-3) {
  simulated::Motion motion(plant, period);
  std::vector<double> positions;
  for (const double command : commands) {
    positions.push_back(motion.position(plant.sensed));
    motion.command(command);
    motion.advance(period);
  }
  return positions;
}

/// What an experiment adds.
struct Reading {
  double step = 1e-6;   ///< of the encoder, m or rad
  double noise = 0.0;   ///< root mean square of each position, in steps
  double force = 0.01;  ///< of the white force beside the commands, share of their root mean square
  std::uint64_t seed = 1;
};

inline Recording simulated_record(const simulated::Plant& plant, std::vector<double> commands, const Reading& reading,
                                  double period = 1e-3) {
  std::mt19937_64 random(reading.seed);
  std::normal_distribution<double> normal;
  const double power = std::inner_product(commands.begin(), commands.end(), commands.begin(), 0.0);
  const double rms = std::sqrt(power / static_cast<double>(commands.size()));
  std::vector<double> acting = commands;
  for (double& each : acting) each += reading.force * rms * normal(random);
  std::vector<double> positions = simulated_positions(plant, acting, period);
  for (double& each : positions) {
    each = reading.step * std::round(each / reading.step + 0.3 + reading.noise * normal(random));
  }
  return {"seed " + std::to_string(reading.seed),
          period,
          {{"force", std::move(commands)}, {"position", std::move(positions)}},
          {}};
}

inline Recording simulated_record(const DeviceParameters& device, std::vector<double> commands,
                                  const Reading& reading) {
  return simulated_record(plant_of(device), std::move(commands), reading, device.loop.sampling_period);
}

/// An excitation's samples at 1 kHz.
inline std::vector<double> commanded(ExcitationKind kind, double peak, double lowest_hz, double highest_hz,
                                     double duration, std::size_t periods = 3) {
  ExcitationOptions options;
  options.kind = kind;
  options.amplitude = peak;
  options.lowest_hz = lowest_hz;
  options.highest_hz = highest_hz;
  options.duration = duration;
  options.periods = periods;
  return excite(options).samples;
}

}  // namespace zwidth::test

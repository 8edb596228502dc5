// Springs and masses against the absolute stability limit of devices that are damped on one body only: where that body hardly
// moves, below Nyquist or far above, Re Y has a narrow dip, and a user who resonates there is hardly damped.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "property/random_devices.hpp"
#include "stability/second_route/pole_count.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr std::size_t usual_devices = 150;
constexpr double beaten = 1e-6;          // relative
constexpr double highest_tuning = 20.0;  // of Nyquist
constexpr double lowest_tuning = 0.02;

std::size_t count_of_damped_on_one_body() {
  const char* wish = std::getenv("ZWIDTH_PROPERTY_CASES");
  return wish != nullptr ? std::max<std::size_t>(1, std::strtoul(wish, nullptr, 10)) : usual_devices;
}

struct DampedOnOneBody {
  DeviceParameters device;
  std::vector<double> antiresonances;  // rad/s, of bodies that hang on one link
};

/// Trees of two to five bodies, some with a loop. The links' stiffnesses place the leaves' antiresonances.
DampedOnOneBody damped_on_one_body(test::RandomDevices& random) {
  DampedOnOneBody result;
  DeviceParameters& device = result.device;
  const std::size_t n = 2 + random.index(4);
  const double period = random.log_uniform(2e-4, 2e-3);
  const double nyquist = std::numbers::pi / period;
  const std::size_t damped = random.index(n);
  const double tiny = random.chance(0.5) ? 0.0 : random.log_uniform(1e-12, 1e-3);
  std::vector<int> links(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const double mass = random.log_uniform(0.02, 4.0);
    const double damping = random.log_uniform(0.1, 100.0);
    device.bodies.push_back({"b" + std::to_string(i), mass, i == damped ? damping : tiny * damping, 0.0, 0.0});
  }
  for (std::size_t i = 1; i < n; ++i) {
    const std::size_t parent = random.index(i);
    const double tuning = nyquist * random.log_uniform(lowest_tuning, highest_tuning);
    device.links.push_back({parent, i, device.bodies[i].mass * tuning * tuning, 0.0});
    ++links[parent];
    ++links[i];
  }
  if (n > 2 && random.chance(0.15)) {  // a second way from one body to another
    const double tuning = nyquist * random.log_uniform(lowest_tuning, highest_tuning);
    const std::size_t first = random.index(n - 1);
    device.links.push_back({first, n - 1, device.bodies[n - 1].mass * tuning * tuning, 0.0});
    ++links[first];
    ++links[n - 1];
  }
  for (const Link& link : device.links) {
    for (const std::size_t leaf : {link.first, link.second}) {
      if (links[leaf] == 1) result.antiresonances.push_back(std::sqrt(link.stiffness / device.bodies[leaf].mass));
    }
  }
  const double delay = random.chance(0.5) ? 0.0 : period * random.log_uniform(0.05, 2.0);
  device.loop = {random.index(n), random.index(n), random.index(n), period, delay};
  if (random.chance(0.2)) device.wall.damping = random.log_uniform(1e-3, 1.0);
  return result;
}

/// Held by the spring or mass that resonates with the device at that frequency.
DeviceParameters held_by_resonant_user(const DeviceParameters& device, const ModalForm& held_motion, double frequency) {
  DeviceParameters held = device;
  // Y + 1/(jX) = 0, Y = jw G
  const double reactance = 1.0 / (frequency * response(held_motion, frequency).real());
  if (reactance > 0.0) held.user.mass = reactance / frequency;
  if (reactance < 0.0) held.user.stiffness = -reactance * frequency;
  return held;
}

/// Whether poles counted with a hundred digits lie outside the unit circle: a critical stiffness in double is rounding
/// where a user's own mode is hardly damped.
bool is_destabilised(const DeviceParameters& held, double stiffness) {
  return internal::PoleCount(Device(held)).in_digits(stiffness).value_or(0) > 0;
}

bool is_possible(const User& user) {
  return std::isfinite(user.mass) && std::isfinite(user.stiffness) && user.mass < 1e6 && user.stiffness < 1e12;
}

TEST(AbsoluteStabilityProperty, NoSpringOrMassBeatsTheLimitWhereOneBodyIsDamped) {
  std::size_t limited = 0;
  std::size_t none = 0;
  std::size_t doubtful = 0;
  std::size_t users = 0;
  std::size_t close = 0;
  double closest = 1e300;
  const std::size_t devices = count_of_damped_on_one_body();
  for (std::size_t seed = 0; seed < devices; ++seed) {
    test::RandomDevices random(seed + 7300000);
    const auto [parameters, antiresonances] = damped_on_one_body(random);
    const Device device(parameters);
    const VirtualDamper damper{parameters.wall.damping, parameters.wall.velocity_filter_hz};
    const AbsoluteStabilityLimit limit = absolute_stability_limit(device, damper);
    if (!limit.trust.sound()) ++doubtful;
    if (limit.trust.sound() && limit.stiffness == 0.0) ++none;
    if (!limit.trust.sound() || !(limit.stiffness > 0.0) || !std::isfinite(limit.stiffness)) continue;
    ++limited;
    const ModalForm motion = modal_form(device, {parameters.loop.held, parameters.loop.held}, ActuatorLag::left_out);
    std::vector<double> frequencies;
    for (const double each : antiresonances) {
      for (const double distance : {0.0, 1e-9, 1e-6, random.log_uniform(1e-8, 1e-2)}) {
        frequencies.push_back(each * (1.0 + distance));
        frequencies.push_back(each * (1.0 - distance));
      }
    }
    frequencies.push_back(random.log_uniform(0.01, 20.0) * std::numbers::pi / parameters.loop.sampling_period);
    double least = 1e300;
    DeviceParameters worst = parameters;
    for (const double frequency : frequencies) {
      const DeviceParameters held = held_by_resonant_user(parameters, motion, frequency);
      if (!is_possible(held.user)) continue;
      ++users;
      const double critical = critical_stiffness(filtered_plant(Device(held)), damper).stiffness;
      const bool is_below = critical < limit.stiffness * (1.0 - beaten);
      if (is_below) {
        EXPECT_FALSE(is_destabilised(held, limit.stiffness * (1.0 - beaten)))
            << "seed " << seed << ", user " << held.user.mass << " kg, " << held.user.stiffness << " N/m: " << critical
            << " N/m instead of " << limit.stiffness;
      } else if (critical / limit.stiffness < least) {
        least = critical / limit.stiffness;
        worst = held;
      }
    }
    // Beside the double's own word, for one of eight.
    if (seed % 8 == 0) {
      EXPECT_FALSE(is_destabilised(worst, limit.stiffness * (1.0 - beaten))) << "seed " << seed;
    }
    closest = std::min(closest, least);
    if (least < 1.1) ++close;
  }
  RecordProperty("devices", std::to_string(devices));
  RecordProperty("limited", std::to_string(limited));
  RecordProperty("none stable", std::to_string(none));
  RecordProperty("doubtful", std::to_string(doubtful));
  RecordProperty("users", std::to_string(users));
  RecordProperty("closest", std::to_string(closest));
  RecordProperty("within a tenth", std::to_string(close));
  if (devices < usual_devices) return;
  EXPECT_GT(limited, devices / 5);
  EXPECT_GT(none, devices / 10);
  EXPECT_GT(close, limited / 20);
  EXPECT_LT(doubtful, devices / 50);
  EXPECT_LT(closest, 1.0 + 1e-4);  // the limits are not so low that this says nothing
}

}  // namespace
}  // namespace zwidth

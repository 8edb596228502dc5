// The minimum over frequency in absolute_stability_limit() is a scan. Here the condition itself, |1 + C c_T| > |C| r_T, is
// checked just below the limit and further down at some twenty times as many frequencies.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "property/random_devices.hpp"
#include "stability/loop/damper_response.hpp"
#include "stability/users/termination_discs.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double rounding = 3e-6;  // of the limit towards w = 0, and 1e-8 elsewhere

std::size_t device_count() {
  const char* wish = std::getenv("ZWIDTH_SCAN_DEVICES");
  return wish != nullptr ? std::strtoul(wish, nullptr, 10) : 15;
}

std::vector<double> dense_frequencies(const TerminationDiscs& discs, double period, test::RandomDevices& random) {
  const double nyquist = std::numbers::pi / period;
  std::vector<double> frequencies{nyquist};
  for (int i = 0; i < 1300; ++i) frequencies.push_back(nyquist * random.uniform(1e-4, 1.0));
  for (int i = 0; i < 1300; ++i) frequencies.push_back(random.log_uniform(3e-3, std::numbers::pi) / period);
  for (const Mode& mode : discs.held_form().modes) {
    const double centre = std::abs(std::remainder(mode.frequency, 2.0 * nyquist));
    const double width = std::min(mode.damping_ratio, 1.0) * mode.frequency;
    for (int i = 0; i < 400; ++i) {
      const double at = centre + (random.chance(0.5) ? 1.0 : -1.0) * width * random.log_uniform(1e-2, 100.0);
      if (at > 3e-3 / period && at < nyquist) frequencies.push_back(at);
    }
  }
  return frequencies;
}

TEST(AbsoluteStabilityScan, NothingLiesBetweenItsFrequencies) {
  for (std::size_t seed = 0; seed < device_count(); ++seed) {
    test::RandomDevices random(seed + 31000);
    const auto kind = test::device_kinds[seed % test::device_kinds.size()];
    const DeviceParameters parameters = random.device(kind);
    if (parameters.transfer_function) continue;
    const Device device(parameters);
    const VirtualDamper damper{parameters.wall.damping, parameters.wall.velocity_filter_hz};
    const double limit = absolute_stability_limit(device, damper).stiffness;
    if (!(limit > 0.0)) continue;
    const TerminationDiscs discs(device);
    const double period = parameters.loop.sampling_period;
    double worst = 1.0;  // share of the limit at which the condition is broken
    double worst_frequency = 0.0;
    for (const double frequency : dense_frequencies(discs, period, random)) {
      const TerminationDiscs::Disc disc = discs.at(frequency);
      for (const double share : {1.0 - rounding, 0.999, 0.99, 0.9, 0.7, 0.5, 0.2, 0.01}) {
        const double stiffness = std::isfinite(limit) ? share * limit : 1e9 * share;
        const std::complex<double> controller = stiffness + damper_response(damper, period, frequency);
        if (std::abs(1.0 + controller * disc.centre) <= std::abs(controller) * disc.radius && share < worst) {
          worst = share;
          worst_frequency = frequency;
        }
      }
    }
    EXPECT_EQ(worst, 1.0) << kind << ", seed " << seed << ", at " << worst_frequency * period << " rad per sample";
  }
}

}  // namespace
}  // namespace zwidth

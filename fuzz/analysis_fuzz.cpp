// Any small device of sane magnitudes: analyze() answers without a crash, a hang or a NaN.
#include <fmt/core.h>
#include <fuzzer/FuzzedDataProvider.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>

#include "zwidth/error.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/stability/analysis.hpp"

namespace {

using zwidth::DeviceParameters;

/// What is unsound about an answer.
struct Unsound {
  std::string what;
};

void require(bool holds, const char* what) {
  if (!holds) throw Unsound{what};
}

/// 10^-exponent..10^exponent, all magnitudes alike.
double positive(FuzzedDataProvider& bytes, double exponent) {
  return std::pow(10.0, bytes.ConsumeFloatingPointInRange(-exponent, exponent));
}

double not_negative(FuzzedDataProvider& bytes, double exponent) {
  return bytes.ConsumeBool() ? positive(bytes, exponent) : 0.0;
}

void add_bodies(FuzzedDataProvider& bytes, DeviceParameters& device) {
  const auto count = bytes.ConsumeIntegralInRange<std::size_t>(1, 4);
  for (std::size_t i = 0; i < count; ++i) {
    device.bodies.push_back({.name = std::to_string(i),
                             .mass = positive(bytes, 4.0),
                             .damping = not_negative(bytes, 5.0),
                             .stiffness = bytes.ConsumeBool() ? not_negative(bytes, 7.0) : 0.0,
                             .coulomb = 0.0});
    if (i > 0) {
      device.links.push_back({.first = i,
                              .second = bytes.ConsumeIntegralInRange<std::size_t>(0, i - 1),
                              .stiffness = positive(bytes, 9.0),
                              .damping = not_negative(bytes, 5.0)});
    }
  }
  device.loop.actuated = bytes.ConsumeIntegralInRange<std::size_t>(0, count - 1);
  device.loop.sensed = bytes.ConsumeIntegralInRange<std::size_t>(0, count - 1);
  device.loop.held = bytes.ConsumeIntegralInRange<std::size_t>(0, count - 1);
  if (bytes.ConsumeBool()) device.user = {not_negative(bytes, 2.0), not_negative(bytes, 3.0), not_negative(bytes, 5.0)};
}

void add_transfer_function(FuzzedDataProvider& bytes, DeviceParameters& device) {
  const auto degree = bytes.ConsumeIntegralInRange<std::size_t>(1, 6);
  zwidth::TransferFunction transfer;
  const auto coefficient = [&] { return (bytes.ConsumeBool() ? 1.0 : -1.0) * not_negative(bytes, 6.0); };
  for (std::size_t i = 0; i < degree; ++i) transfer.numerator.push_back(coefficient());
  for (std::size_t i = 0; i <= degree; ++i) transfer.denominator.push_back(coefficient());
  device.transfer_function = transfer;
}

DeviceParameters device_from(FuzzedDataProvider& bytes) {
  DeviceParameters device;
  if (bytes.ConsumeIntegralInRange(0, 4) == 0) {
    add_transfer_function(bytes, device);
  } else {
    add_bodies(bytes, device);
  }
  device.loop.sampling_period = 1e-3 * positive(bytes, 2.0);
  if (bytes.ConsumeBool()) {
    const double samples =
        bytes.ConsumeBool() ? bytes.ConsumeIntegralInRange(0, 50) : bytes.ConsumeFloatingPointInRange(0.0, 50.0);
    device.loop.delay = samples * device.loop.sampling_period;
  }
  if (bytes.ConsumeBool()) device.actuator.time_constant = 1e-3 * positive(bytes, 3.0);
  if (bytes.ConsumeBool()) device.wall.stiffness = not_negative(bytes, 6.0);
  if (bytes.ConsumeBool()) device.wall.damping = not_negative(bytes, 4.0);
  if (bytes.ConsumeBool()) device.wall.velocity_filter_hz = positive(bytes, 4.0);
  return device;
}

void require_sound(const zwidth::CriticalStiffness& critical, double period) {
  if (critical.status == zwidth::StiffnessStatus::refused) {
    require(!critical.trust.reasons.empty(), "a refusal without a reason");
    return;
  }
  require(!std::isnan(critical.stiffness) && critical.stiffness >= 0.0, "critical stiffness");
  require(critical.limit.has_value() == (critical.status == zwidth::StiffnessStatus::finite), "limit without status");
  double last = 0.0;
  for (const zwidth::Crossover& crossover : critical.crossovers) {
    require(crossover.frequency >= last && crossover.frequency <= std::numbers::pi / period * (1.0 + 1e-12),
            "frequency of a crossover");
    require(std::isfinite(crossover.stiffness) && crossover.stiffness > 0.0, "stiffness of a crossover");
    last = crossover.frequency;
  }
  double end = 0.0;
  for (const zwidth::StableInterval& interval : critical.stable_intervals) {
    require(interval.lower >= end && interval.upper.value_or(HUGE_VAL) > interval.lower, "order of stable intervals");
    end = interval.upper.value_or(HUGE_VAL);
  }
}

void require_sound(const zwidth::WallMargins& wall) {
  require(!std::isnan(wall.spectral_radius), "spectral radius");
  for (const auto& margin : {wall.gain_margin, wall.lower_gain_margin, wall.phase_margin, wall.delay_margin}) {
    require(!margin || (!std::isnan(*margin) && wall.stable), "margin");
  }
  for (const auto& crossover : wall.gain_crossovers) {
    require(std::isfinite(crossover.frequency) && std::isfinite(crossover.phase_margin), "gain crossover");
  }
}

void require_sound(const zwidth::Analysis& analysis, double period) {
  require_sound(analysis.critical, period);
  if (analysis.rigid) require_sound(analysis.rigid->critical, period);
  if (analysis.wall) require_sound(*analysis.wall);
  for (const zwidth::Mode& mode : analysis.modes) {
    require(std::isfinite(mode.frequency) && std::isfinite(mode.damping_ratio), "mode");
  }
}

void analyze_soundly(const zwidth::Device& device) {
  try {
    require_sound(zwidth::analyze(device, {.any_user = false}), device.loop().sampling_period);
  } catch (const zwidth::Error& error) {
    // A capped iteration may give up, saying so; nothing else is to be expected of a valid device.
    if (error.code() != zwidth::ErrorCode::did_not_converge) throw Unsound{error.what()};
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider bytes(data, size);
  const DeviceParameters parameters = device_from(bytes);
  if (zwidth::find_problem(parameters)) return 0;
  try {
    analyze_soundly(zwidth::Device(parameters));
  } catch (const Unsound& unsound) {
    fmt::print(stderr, "unsound: {}\n{}\n", unsound.what, zwidth::write_device(parameters));
    std::abort();
  }
  return 0;
}

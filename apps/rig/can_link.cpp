#include "rig/can_link.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zwidth/rig/serial_rate.hpp"

namespace zwidth::rig {
namespace {

constexpr std::array<double, 3> usual_rates{250e3, 500e3, 1e6};
constexpr double bytes_around_data = 1 + 1 + 1;  // of an SLCAN line: kind, length, end

/// Bytes of the SLCAN line that brings a frame to the adapter or from it.
double line_bytes(const CanFrameShape& frame) {
  return bytes_around_data + (frame.is_extended ? 8 : 3) + (frame.is_remote ? 0.0 : 2.0 * frame.bytes);
}

struct Load {
  double bus_time = 0.0;  // s
  double bytes = 0.0;
};

Load load_of(const std::vector<CanFrameShape>& frames, const CanBitRates& rates) {
  Load load;
  for (const CanFrameShape& each : frames) {
    load.bus_time += can_frame_time(each, rates);
    load.bytes += line_bytes(each);
  }
  return load;
}

/// Names a faster bus where one would do.
void require_fast_bus(const DriverFacts& facts, const SerialLink& link, const CanBitRates& rates) {
  const double line = facts.byte_rate ? facts.bytes_per_cycle / *facts.byte_rate : 0.0;
  const double needed = (facts.bus_time_per_cycle + line) / serial_share_of_cycle;
  if (needed <= link.sampling_period) return;
  std::vector<Evidence> evidence{{"rate", rates.nominal},
                                 {"carried_hz", std::floor(1.0 / needed)},
                                 {"wanted_hz", 1.0 / link.sampling_period},
                                 {"period", std::ceil(1e4 * needed) * 1e-4}};
  for (const double rate : usual_rates) {
    const double then = (facts.bus_time_per_cycle * rates.nominal / rate + line) / serial_share_of_cycle;
    if (rates.data > 0.0 || then > link.sampling_period) continue;
    evidence.push_back({"sufficient_rate", rate});
    break;
  }
  throw DriverFailed(DriveProblemCode::bus_too_slow, std::move(evidence));
}

CanAdapter adapter_of(const SerialLink& link) {
  const auto adapter = can_adapter(link.port);
  if (!adapter) throw DriverFailed(DriveProblemCode::no_adapter_named);
  return *adapter;
}

}  // namespace

CanBitRates can_rates(const SerialLink& link, double nominal, double data) {
  return {link.drive.baud ? static_cast<double>(*link.drive.baud) : nominal, data};
}

DriverFacts on_can_bus(DriverFacts facts, const SerialLink& link, const CanCycle& cycle) {
  const Load asked = load_of(cycle.asked, cycle.rates);
  const Load force = load_of(cycle.force, cycle.rates);
  facts.bus_time_per_cycle = asked.bus_time + force.bus_time;
  facts.force_bus_time = force.bus_time;
  facts.bytes_per_cycle = asked.bytes + force.bytes;
  facts.force_bytes = force.bytes;
  if (const auto baud = adapter_of(link).baud) facts.byte_rate = serial_rate(1.0, *baud);
  if (!link.lock_step) require_fast_bus(facts, link, cycle.rates);
  return facts;
}

std::unique_ptr<CanBus> bus_of(const SerialLink& link, const CanBitRates& rates) {
  return open_can_bus(adapter_of(link), rates);
}

}  // namespace zwidth::rig

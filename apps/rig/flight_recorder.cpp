#include "rig/flight_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "results/csv.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::rig {

FlightRecorder::FlightRecorder(double sampling_period)
    : rows_(static_cast<std::size_t>(std::max(1.0, std::ceil(length / sampling_period)))) {}

void FlightRecorder::write(const std::function<void(std::string_view)>& sink, Motion motion) const {
  const Units units = units_of(motion);
  const std::string force = fmt::format("force [{}]", units.force);
  const std::string position = fmt::format("position [{}]", units.length);
  const std::string velocity = fmt::format("velocity [{}/s]", units.length);
  const std::string wanted = "wanted_" + force;
  results::Csv csv(sink, {"time_s", force, position, velocity, wanted, "latency_s", "stop"});
  const std::size_t oldest = count_ < rows_.size() ? 0 : next_;
  for (std::size_t i = 0; i < count_; ++i) {
    const FlightRow& row = rows_[(oldest + i) % rows_.size()];
    csv.row(results::Rounded{row.time, 12}, row.force, row.position, row.velocity, row.wanted,
            results::Rounded{row.latency, 6}, static_cast<int>(row.stop));
  }
  csv.flush();
}

}  // namespace zwidth::rig

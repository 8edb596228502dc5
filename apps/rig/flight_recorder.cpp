#include "rig/flight_recorder.hpp"

#include <algorithm>
#include <cmath>

#include "results/csv.hpp"

namespace zwidth::rig {

FlightRecorder::FlightRecorder(double sampling_period)
    : rows_(static_cast<std::size_t>(std::max(1.0, std::ceil(length / sampling_period)))) {}

void FlightRecorder::write(const std::function<void(std::string_view)>& sink) const {
  results::Csv csv(sink, {"time_s", "force", "position", "velocity", "wanted_force", "latency_s", "stop"});
  const std::size_t oldest = count_ < rows_.size() ? 0 : next_;
  for (std::size_t i = 0; i < count_; ++i) {
    const FlightRow& row = rows_[(oldest + i) % rows_.size()];
    csv.row(results::Rounded{row.time, 12}, row.force, row.position, row.velocity, row.wanted,
            results::Rounded{row.latency, 6}, static_cast<int>(row.stop));
  }
  csv.flush();
}

}  // namespace zwidth::rig

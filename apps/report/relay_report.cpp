#include "report/relay_report.hpp"

#include <algorithm>
#include <cmath>

namespace zwidth::report {
namespace {

constexpr double near = 1.15;
constexpr double same_band = 1.1;

}  // namespace

std::optional<RelayMean> mean_of(const std::vector<RelayTrial>& trials) {
  RelayMean mean;
  double log_stiffness = 0.0;
  for (const RelayTrial& trial : trials) {
    if (!trial.result) continue;
    const RelayResult& result = *trial.result;
    const bool is_first = mean.trials++ == 0;
    mean.frequency += result.frequency;
    log_stiffness += std::log(result.stiffness);
    mean.amplitude += result.amplitude;
    mean.lowest_frequency = is_first ? result.frequency : std::min(mean.lowest_frequency, result.frequency);
    mean.highest_frequency = std::max(mean.highest_frequency, result.frequency);
  }
  if (mean.trials == 0) return std::nullopt;
  const auto count = static_cast<double>(mean.trials);
  mean.frequency /= count;
  mean.stiffness = std::exp(log_stiffness / count);
  mean.amplitude /= count;
  return mean;
}

std::vector<CycleBand> cycle_bands(const std::vector<LimitCycle>& cycles) {
  std::vector<CycleBand> bands;
  for (const LimitCycle& cycle : cycles) {
    if (bands.empty() || cycle.frequency > same_band * bands.back().highest.frequency)
      bands.push_back({0, cycle, cycle});
    ++bands.back().count;
    bands.back().highest = cycle;
  }
  return bands;
}

bool is_near(double frequency, double other) { return frequency <= near * other && other <= near * frequency; }

std::vector<Remark> remarks_of(const RelayReport& report) {
  std::vector<Remark> remarks = report.remarks;
  if (!report.device) return remarks;
  const Wall& wall = report.device->parameters().wall;
  if (wall.damping > 0.0 || !wall.filters.empty()) {
    remarks.push_back({Remark::Severity::note, "the wall's damper and filters are left out: a relay has no wall",
                       "all numbers are of the device without them, not those of `zwidth analyze`, which closes them"});
  }
  return remarks;
}

double friction_level(const RelayReport& report) {
  double largest = 0.0;
  if (!report.device) return largest;
  for (const Body& body : report.device->bodies()) largest = std::max(largest, body.coulomb);
  return largest / report.relay.amplitude;
}

}  // namespace zwidth::report

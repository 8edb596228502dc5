#include "identification/evidence/limit_evidence.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "zwidth/error.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {
namespace {

std::optional<Crossover> crossover_of(const CriticalStiffness& critical, const MeasuredLimit& limit) {
  if (!limit.frequency_hz) return critical.limit && critical.limit->stiffness > 0.0 ? critical.limit : std::nullopt;
  const double measured = 2.0 * std::numbers::pi * *limit.frequency_hz;
  std::optional<Crossover> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const Crossover& each : critical.crossovers) {
    if (each.poles_leaving <= 0 || !(each.frequency > 0.0)) continue;
    const double distance = std::abs(std::log(each.frequency / measured));
    if (distance < least) {
      least = distance;
      nearest = each;
    }
  }
  return nearest;
}

}  // namespace

LimitEvidence::LimitEvidence(const DeviceFamily& family, std::vector<MeasuredLimit> limits)
    : SquaresOfNumbers(family), limits_(std::move(limits)) {}

std::optional<Eigen::VectorXd> LimitEvidence::residuals(const Eigen::VectorXd& x) const try {
  const Device device(family().device_at(x));
  const FilteredPlant plant = filtered_plant(device);
  VirtualDamper damper = virtual_damper(device);
  Eigen::VectorXd left = Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(limits_.size()));
  Eigen::Index at = 0;
  for (const MeasuredLimit& limit : limits_) {
    damper.damping = limit.damping;
    const auto crossover = crossover_of(critical_stiffness(plant, damper), limit);
    if (!crossover) return std::nullopt;
    left(at) = std::log(crossover->stiffness / limit.stiffness) / limit.stiffness_deviation;
    if (limit.frequency_hz) {
      left(at + 1) =
          std::log(crossover->frequency / (2.0 * std::numbers::pi * *limit.frequency_hz)) / limit.frequency_deviation;
    }
    at += 2;
  }
  return left;
} catch (const Error&) {
  return std::nullopt;
}

}  // namespace zwidth::internal

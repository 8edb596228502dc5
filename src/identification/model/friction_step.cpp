#include "identification/model/friction_step.hpp"

#include <cmath>

namespace zwidth::internal {
namespace {

FrictionStep slides(double direction, double free, double limit, double compliance) {
  return {free - direction * compliance * limit, 0.0, 1.0, -direction * compliance, -direction * limit};
}

}  // namespace

FrictionStep friction_step(double before, double free, double limit, double compliance) {
  const double other = (free - before) / compliance;
  const double direction = other < 0.0 ? -1.0 : 1.0;
  if (std::abs(other) <= limit) {
    const double forward = before < 0.0 ? -1.0 : 1.0;
    const bool stops = before == 0.0 || (free - forward * compliance * limit) * forward <= 0.0;
    return stops ? FrictionStep{} : slides(forward, free, limit, compliance);
  }
  if (before * direction >= 0.0) return slides(direction, free, limit, compliance);
  const double size = std::abs(other);
  const double speed = std::abs(before);
  const double all = size + limit;
  if (speed >= compliance * all) return slides(-direction, free, limit, compliance);
  const double share = (size - limit) / all;
  FrictionStep turned;
  turned.velocity = direction * (compliance * (size - limit) - speed * share);
  const double by_size = direction * (compliance - 2.0 * speed * limit / (all * all));
  turned.by_free = by_size * direction / compliance;
  turned.by_before = share - turned.by_free;
  turned.by_limit = direction * (2.0 * speed * size / (all * all) - compliance);
  turned.by_compliance = direction * (size - limit) - by_size * size / compliance;
  return turned;
}

}  // namespace zwidth::internal

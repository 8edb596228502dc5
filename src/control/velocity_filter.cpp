#include "zwidth/control/velocity_filter.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "zwidth/error.hpp"

namespace zwidth {

VelocityFilter::VelocityFilter(double cutoff_hz, double sampling_period) : rate_(1.0 / sampling_period) {
  if (!(std::isfinite(sampling_period) && sampling_period > 0.0)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("sampling period is {} s; must be > 0", sampling_period));
  }
  if (!(std::isfinite(cutoff_hz) && cutoff_hz >= 0.0)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("velocity filter is {} Hz; must be >= 0", cutoff_hz));
  }
  if (cutoff_hz > 0.0) pole_ = std::exp(-2.0 * std::numbers::pi * cutoff_hz * sampling_period);
}

}  // namespace zwidth

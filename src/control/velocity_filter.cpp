#include "zwidth/control/velocity_filter.hpp"

#include <fmt/format.h>

#include <cmath>

#include "zwidth/error.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth {

VelocityFilter::VelocityFilter(double cutoff_hz, double sampling_period) : rate_(1.0 / sampling_period) {
  if (!(std::isfinite(sampling_period) && sampling_period > 0.0)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("sampling period is {} s; must be > 0", sampling_period));
  }
  if (!(std::isfinite(cutoff_hz) && cutoff_hz >= 0.0)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("velocity filter is {} Hz; must be >= 0", cutoff_hz));
  }
  pole_ = velocity_filter_pole(cutoff_hz, sampling_period);
}

}  // namespace zwidth

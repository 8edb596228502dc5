#include "zwidth/control/velocity_filter.hpp"

#include "require_argument.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth {

VelocityFilter::VelocityFilter(double cutoff_hz, double sampling_period) : rate_(1.0 / sampling_period) {
  internal::require_positive({"sampling period", sampling_period, "s"});
  internal::require_not_negative({"velocity filter", cutoff_hz, "Hz"});
  pole_ = velocity_filter_pole(cutoff_hz, sampling_period);
}

}  // namespace zwidth

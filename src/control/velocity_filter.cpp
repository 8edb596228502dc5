#include "zwidth/control/velocity_filter.hpp"

#include <cmath>

#include "zwidth/error.hpp"
#include "zwidth/sampling/filter_section.hpp"

namespace zwidth {

VelocityFilter::VelocityFilter(double cutoff_hz, double sampling_period) : rate_(1.0 / sampling_period) {
  if (!(std::isfinite(sampling_period) && sampling_period > 0.0)) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::sampling_period_not_positive,
                                              .evidence = {{"value", sampling_period}},
                                              .subjects = {{"unit", "s"}}});
  }
  if (!(std::isfinite(cutoff_hz) && cutoff_hz >= 0.0)) {
    throw Error(ErrorCode::invalid_argument,
                {.code = ProblemCode::filter_below_zero, .evidence = {{"value", cutoff_hz}}});
  }
  pole_ = velocity_filter_pole(cutoff_hz, sampling_period);
}

}  // namespace zwidth

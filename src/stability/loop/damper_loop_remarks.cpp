#include "stability/loop/damper_loop_remarks.hpp"

#include "zwidth/model/damper_timing.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {

Remark damper_closed_at_own_rate(const Device& device) {
  const double period = damper_timing(device.loop()).sampling_period;
  return note({.code = FindingCode::damper_closed_at_own_rate,
               .evidence = {{"damping", device.parameters().wall.damping, units_of(device.parameters().motion).damping},
                            {"rate_hz", 1.0 / period, "Hz"}},
               .key = "loop.damper.sampling_period"});
}

Remark left_out_beside_damper_loop(const char* what) {
  return note({.code = FindingCode::left_out_beside_damper_loop, .subjects = {{"what", what}}});
}

}  // namespace zwidth::internal

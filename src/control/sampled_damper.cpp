#include "zwidth/control/sampled_damper.hpp"

#include "require_argument.hpp"

namespace zwidth {

SampledDamper::SampledDamper(const ControllerOptions& options, double sampling_period)
    : velocity_(options.velocity_filter_hz, sampling_period),
      damping_(options.damping),
      position_(options.position),
      one_sided_(is_unilateral_wall(options)) {
  internal::require_not_negative({"virtual damper", damping_});
}

ControllerOptions without_damper(ControllerOptions options) {
  options.damping = 0.0;
  options.velocity_filter_hz = 0.0;
  return options;
}

bool is_unilateral_wall(const ControllerOptions& options) noexcept {
  return options.kind == ControllerOptions::Kind::wall && options.contact == ControllerOptions::Contact::unilateral;
}

}  // namespace zwidth

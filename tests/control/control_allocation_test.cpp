// The real-time room: nothing allocates or throws after construction. This file replaces the global operators of the
// whole test program.

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>

#include "counted_allocations.hpp"
#include "zwidth/control/sampled_controller.hpp"

namespace zwidth {
namespace {

static_assert(noexcept(std::declval<SampledController&>().update(0.0)));
static_assert(noexcept(std::declval<SampledController&>().reset()));
static_assert(noexcept(std::declval<RunningFilter&>().update(0.0)));
static_assert(noexcept(std::declval<RunningFilter&>().reset()));
static_assert(noexcept(std::declval<VelocityFilter&>().update(0.0)));
static_assert(noexcept(std::declval<VelocityFilter&>().reset()));

TEST(ControlAllocation, NoneAfterConstruction) {
  ControllerOptions wall = wall_controller({.stiffness = 5000.0, .damping = 5.0, .velocity_filter_hz = 100.0});
  wall.filters = {{.kind = WallFilter::Kind::low_pass, .frequency_hz = 300.0},
                  {.kind = WallFilter::Kind::notch, .frequency_hz = 80.0}};
  ControllerOptions one_sided = wall;
  one_sided.contact = ControllerOptions::Contact::unilateral;
  ControllerOptions relay;
  relay.kind = ControllerOptions::Kind::relay;
  relay.amplitude = 5.0;
  for (const ControllerOptions& options : {wall, one_sided, relay, ControllerOptions{}}) {
    SampledController controller(options, 1e-3);
    const std::size_t before = allocations;
    double sum = 0.0;
    for (int k = 0; k < 1000; ++k) sum += controller.update(1e-5 * (k % 37) - 1e-4);
    sum += controller.update(std::numeric_limits<double>::quiet_NaN());
    controller.reset();
    sum += controller.update(1e-3);
    EXPECT_EQ(allocations, before) << sum;
  }
}

}  // namespace
}  // namespace zwidth

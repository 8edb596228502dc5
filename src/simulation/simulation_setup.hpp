#pragma once

#include <optional>
#include <vector>

#include "zwidth/error.hpp"
#include "zwidth/simulation/simulate.hpp"

namespace zwidth::internal {

/// What simulate() runs, everything left open in its options decided.
struct SimulationSetup {
  HybridLoopOptions loop;
  std::optional<Remark> moved_start;  ///< why the start is not 1 mm inside the wall
};

/// Requires options without a problem.
[[nodiscard]] SimulationSetup simulation_setup(const Device& device, const SimulationOptions& options);

/// The linear answer to the loop's controller; `agrees` is still open.
[[nodiscard]] LinearAnswer linear_answer(const Device& device, const SimulationOptions& options);

/// How long a run lasts where SimulationOptions::duration is absent, s; `critical` is the linear answer's.
[[nodiscard]] double default_duration(const Device& device, const CriticalStiffness& critical, const UserForce& force);

/// Throws Error (needs_bodies) where a body is to be moved by the options of a loop or a simulation of a device without.
template <typename Options>
void check_bodies(const Device& device, const Options& options) {
  const bool moves_a_body = options.user_force.kind != UserForce::Kind::none || !options.initial_position.empty() ||
                            !options.initial_velocity.empty();
  if (device.has_bodies() || !moves_a_body) return;
  throw Error(ErrorCode::needs_bodies, {.code = ProblemCode::no_body_to_start_from});
}

/// Sum of the Coulomb friction of all bodies, N or N m.
[[nodiscard]] double whole_friction(const Device& device);

/// A start far enough inside the wall that wall and springs to ground pull ten times the whole friction, and by ten
/// encoder steps; absent where no start would do: the force limit is below the friction.
[[nodiscard]] std::optional<double> start_beyond_stiction(const Device& device, const ControllerOptions& wall);

}  // namespace zwidth::internal

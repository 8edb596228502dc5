#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/holding.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// What a simulated loop did, judged from its sensed position alone (as on a real device), but for what linear analysis sees:
/// with a pole outside the unit circle, and nothing that could hold its motion down, a run never settles; with no pole
/// on that circle, and nothing that is not linear, it never swings on for ever. It is undecided where that does not show.
enum class LoopVerdict {
  settles,      ///< the oscillation dies out, or there is none and the device has come to rest
  limit_cycle,  ///< it neither grows nor dies out
  forced,       ///< the same, at the frequency of the user's sine: the user keeps it up
  unstable,     ///< it grows, or passed the divergence bound
  drifts,       ///< no oscillation, but the device moves on
  undecided,    ///< the run is too short to tell
};

inline constexpr double max_simulated_samples = 2e7;  ///< of one simulate()
inline constexpr double max_kept_points = 5e6;        ///< of its trajectory

/// What the loop starts from, and for how long it runs.
struct SimulationOptions {
  /// What runs at every sample. Absent: the device's own [wall], at 0; where it has neither stiffness nor damping, none.
  std::optional<ControllerOptions> controller;
  std::optional<ControllerOptions::Contact> contact;  ///< instead of the controller's
  std::optional<double> wall_position;                ///< m or rad, instead of the controller's
  UserForce user_force;                               ///< on the held body
  Faults faults;                                      ///< none by default
  /// m or rad, of each body; empty: 0. Where velocities are empty too and the user does not push, every body starts at
  /// rest 1 mm (1 mrad) inside the wall, or further in where that lies inside the stiction or an encoder step (a
  /// transfer function: its wall begins there instead).
  std::vector<double> initial_position;
  std::vector<double> initial_velocity;  ///< m/s or rad/s, of each body; empty: at rest
  /// s; 1 to max_simulated_samples sampling periods, and more than the loop's delay. Absent: 40 periods of
  /// the critical oscillation, at least 1 s and four delays, at most a million samples; counted from the start of the
  /// user's force. Where that run at a bilateral wall is undecided or drifts, it is run for 4, 16 and 64 times as long,
  /// up to a million samples, until it is not.
  std::optional<double> duration;
  /// m or rad, > 0: ends the run as unstable where |sensed position - start| passes it.
  double divergence = 1e3;
  /// Samples per kept point of the trajectory; 0: none is kept. More than max_kept_points are refused.
  std::size_t keep_every = 1;
  std::optional<std::size_t> keep_at_most;  ///< points, > 0: with more of them keep_every grows
};

/// The first member outside its domain for this device, or that leaves the device at rest for ever.
/// An empty member: nothing at all moves the device.
[[nodiscard]] std::optional<OptionProblem> find_problem(const SimulationOptions& options, const Device& device);

/// Everything at the sampling instants; equal sizes.
struct Trajectory {
  std::vector<double> time;                   ///< s
  std::vector<double> measured;               ///< what the encoder gave at that instant, m or rad
  std::vector<double> command;                ///< the force commanded then, N or N m
  std::vector<double> user_force;             ///< N or N m, at each point kept
  std::vector<std::vector<double>> position;  ///< per body (a transfer function: its output)
  std::vector<std::vector<double>> velocity;  ///< per body
};

/// The oscillation at the end of a run.
struct Oscillation {
  double frequency = 0.0;  ///< rad/s
  double amplitude = 0.0;  ///< half of peak to peak, m or rad
};

/// What the encoder's steps do to the wall's force: the command less the one for the unrounded position.
struct QuantisationForce {
  double amplitude = 0.0;  ///< half of peak to peak, N or N m
  double frequency = 0.0;  ///< rad/s, mean over its cycles; under a slow motion at v, 2 pi v / step
};

/// What acts in a simulation and is left out by linear analysis.
enum class NonlinearPart {
  coulomb_friction,
  quantisation_step,
  force_limit,
  leaving_wall,  ///< the wall only pushes
  lost_samples,
  sampling_jitter,
  late_forces,
};

/// What linear analysis says of the same loop.
struct LinearAnswer {
  CriticalStiffness critical;  ///< of the device that moves, with its file's user, and the wall's damper and filters
  HoldingLimits limits;        ///< with nobody and with the file's user
  std::optional<StableFor> stable_for;  ///< of the wall; any passive user is left out. Absent as `wall_stable`
  // Absent where the wall has no stiffness, or the critical stiffness is refused:
  std::optional<double> wall_share;       ///< wall's stiffness over the critical one; absent unless that is finite
  std::optional<bool> wall_stable;        ///< with the file's user, as it moves; absent without a wall
  std::optional<double> spectral_radius;  ///< largest closed-loop |z|
  /// The run did what it says: absent where the wall has no stiffness, and of a verdict that is undecided.
  std::optional<bool> agrees;
};

/// The motion, and what it says.
struct Simulation {
  HybridLoopOptions loop;                        ///< as it ran: the controller, and where the bodies started
  double duration = 0.0;                         ///< s, as asked for or by default
  Trajectory trajectory;                         ///< the points kept
  LoopVerdict verdict = LoopVerdict::undecided;  ///< of the last part of the run
  std::optional<Oscillation> oscillation;        ///< at the end of the run; absent where there is none
  /// 1/s, of its envelope over the second half of the run; negative: decays. Absent without an oscillation. Beside a
  /// user's sine: of the loop's own oscillation.
  std::optional<double> growth_rate;
  double final_position = 0.0;    ///< of the sensed body, m or rad
  double peak_penetration = 0.0;  ///< of the sensed body into the wall at the samples, m or rad; 0: none
  /// s, from which on the sensed position stays within 2 % of its largest excursion around its final value; absent
  /// unless it settles.
  std::optional<double> settling_time;
  /// Energy that the sampled wall generated, N m: work of its force on the device, plus what an ideal spring of its
  /// stiffness and force limit would hold at the end, less what it held at the start. Positive: the wall was active.
  /// Absent without a wall.
  std::optional<double> generated_energy;
  double peak_generated_energy = 0.0;  ///< its largest value during the run; 0 at the start
  /// Over the last quarter of the run. Absent without an encoder step or a wall, with faults, and where there are not
  /// two cycles.
  std::optional<QuantisationForce> quantisation_force;
  /// The encoder's steps are what moves the force at the end: the device itself drifts, is at rest or swings by a step
  /// or two.
  bool encoder_chatters = false;
  std::size_t friction_events = 0;             ///< changes between sticking and sliding
  std::size_t overloaded_steps = 0;            ///< see HybridLoop; 0 in every sound simulation
  std::size_t samples = 0;                     ///< simulated; fewer than asked for where it diverged
  bool diverged = false;                       ///< the run ended early: the position passed options.divergence
  std::vector<NonlinearPart> nonlinear_parts;  ///< what of the device the linear answer leaves out
  LinearAnswer linear;                         ///< beside the motion
  Trust trust;                                 ///< of linear.critical: the device's, and of the computation
  std::vector<Remark> remarks;  ///< what the verdict does not say: never touched or moved, ended early, still pushed
};

/// Runs the sampled loop in time, judges it from the start of the user's force on, and sets it beside its linear answer.
///
/// Throws Error (invalid_argument) with member and value where find_problem() finds one, (needs_bodies) for a user
/// force, motion or friction on a transfer function; as HybridLoop and critical_stiffness() do. What `progress` throws
/// ends the run. Source of the energy: Hannaford & Ryu 2002 (passivity observer).
[[nodiscard]] Simulation simulate(const Device& device, const SimulationOptions& options = {},
                                  const Progress& progress = {});

}  // namespace zwidth

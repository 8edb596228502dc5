#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "report/analysed_device.hpp"
#include "results/analysis_json.hpp"

namespace zwidth::report {

inline results::Json document_of(const AnalysedDevice& analysed) {
  return results::analysis_json(analysed.device, analysed.analysis);
}

/// LHIfAM's Table I with its published answer entered by hand (theory notes, section 2), so that the reports are tested
/// apart from the mathematics.
inline AnalysedDevice lhifam() {
  DeviceParameters parameters;
  parameters.name = "LHIfAM, translational axis";
  parameters.bodies = {{"motor", 0.3, 0.1, 0.0, 0.0}, {"handle", 5.1, 3.4, 0.0, 0.0}};
  parameters.links = {{0, 1, 79.5e3, 15.0}};
  parameters.loop = {0, 0, 1, 1e-3, 0.0};
  parameters.sensor.resolution = 3.14e-6;
  const Oscillator rigid_body;
  const Oscillator mode{Oscillator::Kind::vibration_mode, 1};
  Analysis analysis;
  analysis.critical.stiffness = 8848.70869499712;
  analysis.critical.limit = Crossover{38.5965268731856, 8848.70869499712, rigid_body, 2};
  analysis.critical.crossovers = {*analysis.critical.limit,
                                  {99.3973988782, 140372.949098511, rigid_body, -2},
                                  {618.073421799962, 33895.4748192464, mode, 2},
                                  {std::numbers::pi / 1e-3, 135171032.89, rigid_body, 1}};
  analysis.critical.stable_intervals = {{0.0, 8848.70869499712}};
  analysis.modes = {{529.71, 0.0507}};
  analysis.rigid = RigidApproximation{5.4, 3.5, 0.0, {}};
  analysis.rigid->critical.stiffness = 7000.75625452837;
  analysis.rigid->error = RigidApproximation::Error::safe;
  analysis.q_criterion = QCriterion{8468.9, false, true};
  analysis.limits.nobody = {
      .critical_stiffness = 8848.70869499712, .frequency = 38.5965268731856, .limited_by = rigid_body};
  return {Device(parameters), analysis};
}

/// LHIfAM with a stable wall to judge.
inline AnalysedDevice lhifam_with_wall() {
  AnalysedDevice analysed = lhifam();
  DeviceParameters parameters = analysed.device.parameters();
  parameters.wall = {5000.0, 5.0, 100.0};
  analysed.device = Device(parameters);
  WallMargins& wall = analysed.analysis.wall.emplace();
  wall.stiffness = 5000.0;
  wall.damping = 5.0;
  wall.stable = true;
  wall.gain_margin = 2.0;
  wall.lower_gain_margin = 0.5;
  wall.phase_margin = 0.1;
  wall.delay_margin = 1.5e-3;
  wall.spectral_radius = 0.999;
  analysed.analysis.wall_stable_for = StableFor{.nobody = true};
  return analysed;
}

/// A rotary body on a spring, none of whose walls is stable; one interval further up is.
inline AnalysedDevice undamped_paddle() {
  DeviceParameters parameters;
  parameters.name = "paddle";
  parameters.motion = Motion::rotary;
  parameters.bodies = {{"arm", 1e-3, 0.0, 0.5, 1e-3}};
  parameters.loop = {0, 0, 0, 1e-3, 0.5e-3};
  parameters.wall.stiffness = 0.25;
  Analysis analysis;
  analysis.critical.status = StiffnessStatus::none_stable;
  analysis.critical.crossovers = {{40.0, 2.0, {}, -2}, {90.0, 5.0, {}, 2}};
  analysis.critical.stable_intervals = {{2.0, 5.0}};
  analysis.suspended_rigid_body = Mode{22.4, 0.0};
  analysis.rigid = RigidApproximation{1e-3, 0.0, 0.5, analysis.critical};
  analysis.wall.emplace();
  analysis.wall->stiffness = 0.25;
  analysis.wall->spectral_radius = 1.0003;
  analysis.wall_stable_for = StableFor{.nobody = false};
  analysis.limits.nobody.critical_stiffness = 0.0;
  return {Device(parameters), analysis};
}

/// A knob whose user damps it, with a wall between the limit with nobody holding and that with the user.
inline AnalysedDevice knob_in_a_hand() {
  DeviceParameters parameters;
  parameters.name = "knob";
  parameters.motion = Motion::rotary;
  parameters.bodies = {{"knob", 2e-3, 7.1e-3, 0.0, 0.0}};
  parameters.loop = {0, 0, 0, 1e-3, 0.0};
  parameters.user = {0.0, 6.5e-2, 0.0};
  parameters.wall.stiffness = 40.0;
  return analysed_device(Device(parameters));
}

/// A transfer function without a limit, under a name that is hostile to markup.
inline AnalysedDevice unlimited_transfer_function() {
  DeviceParameters parameters;
  parameters.name = "<b>red & \"name\" µ";
  parameters.transfer_function = TransferFunction{{1.0}, {1.0, 1.0}};
  parameters.loop.sampling_period = 1.0;
  Analysis analysis;
  analysis.critical.status = StiffnessStatus::unbounded;
  analysis.critical.stiffness = std::numeric_limits<double>::infinity();
  analysis.critical.stable_intervals = {{0.0, std::nullopt}};
  analysis.limits.nobody.critical_stiffness = analysis.critical.stiffness;
  return {Device(parameters), analysis};
}

/// -1/(s + 1): a real pole leaves through z = 1 at K = 1.
inline AnalysedDevice pushed_the_wrong_way() {
  DeviceParameters parameters;
  parameters.name = "pushed the wrong way";
  parameters.transfer_function = TransferFunction{{-1.0}, {1.0, 1.0}};
  parameters.loop.sampling_period = 0.1;
  Analysis analysis;
  analysis.critical.stiffness = 1.0;
  analysis.critical.limit = Crossover{0.0, 1.0, {}, 1};
  analysis.critical.crossovers = {*analysis.critical.limit};
  analysis.critical.stable_intervals = {{0.0, 1.0}};
  analysis.limits.nobody = {.critical_stiffness = 1.0, .frequency = 0.0, .limited_by = Oscillator()};
  return {Device(parameters), analysis};
}

}  // namespace zwidth::report

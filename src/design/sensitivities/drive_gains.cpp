#include "zwidth/design/drive_gains.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "zwidth/model/damper_timing.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;      // rad
constexpr double degree = std::numbers::pi / 180.0;  // rad
constexpr double endstop_gain = 25.0;                // of OpenFFBoard, counts of torque per degree and esgain
constexpr double endstop_full_scale = 32767.0;       // counts of torque
constexpr double most_endstop = 255.0;               // esgain
constexpr double moteus_corner = 2.48;               // of moteus' estimator: its bandwidth over its natural frequency

MotorDrive drive_of(const Device& device) { return device.parameters().driver.value_or(MotorDrive{}); }

/// At the motor, and what the firmware relates them to.
struct MotorWall {
  double stiffness = 0.0;    // N m/rad
  double damping = 0.0;      // N m s/rad
  double full_torque = 0.0;  // N m
};

MotorWall at_motor(const Device& device) {
  const MotorDrive drive = drive_of(device);
  const Wall& wall = device.parameters().wall;
  const double travel = std::abs(drive.torque_per_force());  // per rad of the motor
  return {*wall.stiffness * travel * travel, wall.damping * travel * travel,
          device.parameters().actuator.force_limit.value_or(0.0) * travel};
}

double period_of(DriveFirmware firmware, const Device& device) {
  switch (firmware) {
    case DriveFirmware::odrive:
      return 1.0 / 8000.0;
    case DriveFirmware::moteus:
      return 1.0 / 30000.0;
    case DriveFirmware::openffboard:
    case DriveFirmware::vesc:
      return 1e-3;
    case DriveFirmware::simplefoc:
      break;
  }
  return device.parameters().loop.sampling_period;
}

/// Of a firmware whose velocity loop is the damper: the gain of its position loop first, in N m/rad and N m s/rad of the motor.
std::vector<DriveNumber> numbers_of_loops(DriveFirmware firmware, const Device& device, double stiffness,
                                          double damping) {
  const MotorDrive drive = drive_of(device);
  const double filter_hz = device.parameters().wall.velocity_filter_hz;
  switch (firmware) {
    case DriveFirmware::odrive: {
      const std::string axis = fmt::format("axis{}.controller.config.", drive.id.value_or(0));
      return {{axis + "pos_gain", stiffness / damping, "turn/s per turn"},
              {axis + "vel_gain", turn * damping, "N m/(turn/s)"},
              {axis + "vel_integrator_gain", 0.0, "N m/turn"}};
    }
    case DriveFirmware::moteus:
      return {{"servo.pid_position.kp", turn * stiffness, "N m/turn"},
              {"servo.pid_position.kd", turn * damping, "N m/(turn/s)"},
              {"servo.pid_position.ki", 0.0, "N m/(turn s)"}};
    case DriveFirmware::simplefoc: {
      const bool by_volts = drive.torque_per_volt.has_value();
      const double per_unit = by_volts ? *drive.torque_per_volt : *drive.torque_constant;
      return {{"P_angle.P", stiffness / damping, "rad/s per rad"},
              {"PID_velocity.P", damping / per_unit, by_volts ? "V/(rad/s)" : "A/(rad/s)"},
              {"PID_velocity.I", 0.0, ""},
              {"PID_velocity.D", 0.0, ""},
              {"PID_velocity.output_ramp", 0.0, ""},
              {"LPF_velocity.Tf", filter_hz > 0.0 ? 1.0 / (turn * filter_hz) : 0.0, "s"}};
    }
    case DriveFirmware::openffboard:
    case DriveFirmware::vesc:
      break;
  }
  return {};
}

std::vector<DriveNumber> numbers_of(DriveFirmware firmware, const Device& device) {
  const MotorWall wall = at_motor(device);
  switch (firmware) {
    case DriveFirmware::openffboard:
      return {
          {"axis.0.esgain",
           std::floor(wall.stiffness * degree * endstop_full_scale / (endstop_gain * wall.full_torque) * (1.0 + 1e-12)),
           ""},
          {"axis.0.axisdamper", 0.0, ""}};
    case DriveFirmware::vesc:
      return {{"p_pid_kp", wall.stiffness * degree / wall.full_torque, "1/degree"},
              {"p_pid_ki", 0.0, ""},
              {"p_pid_kd", 0.0, ""},
              {"p_pid_kd_proc", wall.damping * degree / wall.full_torque, "s/degree"},
              {"p_pid_kd_filter", 1.0, ""}};
    default:
      return numbers_of_loops(firmware, device, wall.stiffness, wall.damping);
  }
}

/// Of the damper alone, at the motor; nothing for a firmware that closes none beside a force that it is sent.
std::vector<DriveNumber> numbers_of_damper(DriveFirmware firmware, const Device& device) {
  const double damping = device.parameters().wall.damping * std::pow(drive_of(device).torque_per_force(), 2);
  std::vector<DriveNumber> numbers = numbers_of_loops(firmware, device, 0.0, damping);
  // The force comes in the place of a position loop; moteus takes it beside one without gain.
  if (!numbers.empty() && firmware != DriveFirmware::moteus) numbers.erase(numbers.begin());
  return numbers;
}

bool has_loop(DriveFirmware firmware) { return firmware == DriveFirmware::odrive || firmware == DriveFirmware::moteus; }

bool states_bandwidth(const DriveLoopOptions& options, const Device& device) {
  return options.estimator_bandwidth || device.parameters().sensor.tracking_bandwidth > 0.0;
}

/// rad/s, of a phase-locked loop: as given, as the host reads positions by it, or the firmware's default.
double bandwidth_of(DriveFirmware firmware, const DriveLoopOptions& options, const Device& device) {
  const bool is_moteus = firmware == DriveFirmware::moteus;
  const double tracking = device.parameters().sensor.tracking_bandwidth;
  if (options.estimator_bandwidth) return *options.estimator_bandwidth;
  if (tracking > 0.0) return is_moteus ? moteus_corner * tracking : tracking;
  return is_moteus ? turn * 400.0 : 1000.0;
}

/// The low-pass exp(-2 pi f T) whose pole is a.
double cutoff_of(double pole, double period) { return -std::log(pole) / (turn * period); }

/// The wall as the firmware computes it, estimator and all.
Wall wall_on_drive(DriveFirmware firmware, Wall wall, double period, double bandwidth) {
  if (has_loop(firmware)) {
    const bool predicts_after = firmware == DriveFirmware::moteus;
    const double step = (predicts_after ? bandwidth / moteus_corner : bandwidth) * period;
    const double damped = 2.0 * step;
    const double square = step * step;
    wall.filters.push_back(
        {.kind = WallFilter::Kind::digital,
         .numerator = {predicts_after ? damped + square : damped, predicts_after ? -damped : square - damped, 0.0},
         .denominator = {1.0, damped + square - 2.0, 1.0 - damped}});
    wall.velocity_filter_hz = cutoff_of(predicts_after ? 2.0 / (2.0 + step) : 1.0 - 0.5 * step, period);
  } else if (firmware == DriveFirmware::simplefoc && wall.velocity_filter_hz > 0.0) {
    const double time_constant = 1.0 / (turn * wall.velocity_filter_hz);
    wall.velocity_filter_hz = cutoff_of(time_constant / (time_constant + period), period);
  }
  return wall;
}

/// What is not in the analysis, whatever it says.
/// Where the firmware has position and velocity from.
std::optional<Finding> estimator_of(DriveFirmware firmware, const DriveLoopOptions& options, const Device& device) {
  const double bandwidth = bandwidth_of(firmware, options, device);
  const std::string by = states_bandwidth(options, device) ? "as given" : "its default";
  switch (firmware) {
    case DriveFirmware::odrive:
      return Finding{
          .code = FindingCode::odrive_estimator, .evidence = {{"bandwidth", bandwidth}}, .subjects = {{"by", by}}};
    case DriveFirmware::moteus:
      return Finding{.code = FindingCode::moteus_estimator,
                     .evidence = {{"filter_hz", bandwidth / turn}},
                     .subjects = {{"by", by}}};
    case DriveFirmware::vesc:
      return Finding{.code = FindingCode::vesc_estimator};
    case DriveFirmware::openffboard:
      return Finding{.code = FindingCode::openffboard_estimator};
    case DriveFirmware::simplefoc:
      break;
  }
  return std::nullopt;
}

std::vector<Remark> remarks_of(DriveFirmware firmware, const DriveGains& gains, const DriveLoopOptions& options,
                               const Device& device) {
  std::vector<Remark> remarks;
  if (firmware == DriveFirmware::simplefoc && !options.sampling_period) {
    remarks.push_back(note({.code = FindingCode::sketch_rate_assumed, .key = "loop.sampling_period"}));
  } else {
    Finding loop{.code = options.delay ? FindingCode::drive_loop : FindingCode::drive_loop_delay_assumed,
                 .evidence = {{"rate_hz", std::round(1.0 / gains.sampling_period)}, {"delay", gains.delay, "s"}},
                 .subjects = {{"by", options.sampling_period ? "as given" : "its default"}}};
    remarks.push_back(note(std::move(loop)));
  }
  if (auto estimator = estimator_of(firmware, options, device)) remarks.push_back(note(*std::move(estimator)));
  if (firmware == DriveFirmware::odrive || firmware == DriveFirmware::simplefoc) {
    remarks.push_back(note({.code = FindingCode::drive_velocity_limit}));
  }
  return remarks;
}

/// Why the firmware cannot close this device's damper.
std::optional<OptionProblem> find_damper_problem(DriveFirmware firmware, const Device& device) {
  const DeviceParameters& parameters = device.parameters();
  const MotorDrive drive = drive_of(device);
  const Wall& wall = parameters.wall;
  if (!closes_damper(firmware)) {
    return option_problem("loop.damper", {.code = ProblemCode::no_damper_of_its_own});
  }
  const double period = damper_timing(parameters.loop).sampling_period;
  if (!(period < parameters.loop.sampling_period)) {
    return option_problem("loop.damper.sampling_period",
                          {.code = ProblemCode::damper_not_faster,
                           .evidence = {{"value", period}, {"bound", parameters.loop.sampling_period}}});
  }
  if (!(wall.damping > 0.0)) return option_problem("wall.damping", {.code = ProblemCode::no_damping_for_drive});
  if (wall.velocity_filter_hz > 0.0 && firmware != DriveFirmware::simplefoc) {
    return option_problem("wall.velocity_filter_hz", {.code = ProblemCode::filter_unknown_to_drive});
  }
  if (parameters.motion == Motion::linear && !drive.travel) {
    return option_problem("driver.travel", {.code = ProblemCode::travel_per_turn_missing});
  }
  if (firmware == DriveFirmware::simplefoc && !drive.torque_per_volt && !drive.torque_constant) {
    return option_problem("driver.torque_per_volt", {.code = ProblemCode::torque_per_volt_missing});
  }
  return std::nullopt;
}

/// The firmware's name, by which a finding says how the spring's force goes beside the damper.
std::string name_of(DriveFirmware firmware) {
  switch (firmware) {
    case DriveFirmware::odrive:
      return "odrive";
    case DriveFirmware::moteus:
      return "moteus";
    default:
      return "simplefoc";
  }
}

DriveGains gains_of_damper(const Device& device, DriveFirmware firmware) {
  DriveGains gains;
  gains.numbers = numbers_of_damper(firmware, device);
  gains.stiffness = device.parameters().wall.stiffness.value_or(0.0);
  const DamperTiming damper = damper_timing(device.loop());
  gains.sampling_period = damper.sampling_period;
  gains.delay = damper.delay;
  gains.on_drive = analyze(device);
  gains.on_drive.trust.doubt({.code = FindingCode::current_loop_not_modelled});
  if (has_loop(firmware)) gains.on_drive.trust.doubt({.code = FindingCode::damper_estimator_not_modelled});
  gains.remarks.push_back(note(
      {.code = FindingCode::damper_alone_on_drive,
       .evidence = {{"rate_hz", std::round(1.0 / damper.sampling_period)},
                    {"delay", damper.delay, "s"},
                    {"damping", device.parameters().wall.damping * std::pow(drive_of(device).torque_per_force(), 2),
                     "N m s/rad"}},
       .subjects = {{"drive", name_of(firmware)}}}));
  return gains;
}

}  // namespace

bool closes_damper(DriveFirmware firmware) {
  return firmware == DriveFirmware::odrive || firmware == DriveFirmware::moteus || firmware == DriveFirmware::simplefoc;
}

std::vector<DriveNumber> damper_numbers(const Device& device, DriveFirmware firmware) {
  require_valid(find_damper_problem(firmware, device));
  return numbers_of_damper(firmware, device);
}

std::optional<OptionProblem> find_problem(DriveFirmware firmware, const Device& device) {
  if (has_damper_loop(device.loop())) return find_damper_problem(firmware, device);
  const DeviceParameters& parameters = device.parameters();
  const MotorDrive drive = drive_of(device);
  const Wall& wall = parameters.wall;
  const bool cascade = firmware == DriveFirmware::odrive || firmware == DriveFirmware::simplefoc;
  if (!wall.stiffness || !(*wall.stiffness > 0.0)) {
    return option_problem("wall.stiffness", {.code = ProblemCode::no_stiffness_for_drive});
  }
  if (!wall.filters.empty()) {
    return option_problem("wall.filter", {.code = ProblemCode::filter_unknown_to_drive});
  }
  if (wall.velocity_filter_hz > 0.0 && firmware != DriveFirmware::simplefoc) {
    return option_problem("wall.velocity_filter_hz", {.code = ProblemCode::filter_unknown_to_drive});
  }
  if (parameters.motion == Motion::linear && !drive.travel) {
    return option_problem("driver.travel", {.code = ProblemCode::travel_per_turn_missing});
  }
  if (cascade && !(wall.damping > 0.0)) {
    return option_problem("wall.damping", {.code = ProblemCode::damping_needed_by_drive});
  }
  if (firmware == DriveFirmware::simplefoc && !drive.torque_per_volt && !drive.torque_constant) {
    return option_problem("driver.torque_per_volt", {.code = ProblemCode::torque_per_volt_missing});
  }
  const bool in_shares = firmware == DriveFirmware::openffboard || firmware == DriveFirmware::vesc;
  if (in_shares && !parameters.actuator.force_limit) {
    return option_problem("actuator.force_limit", {.code = ProblemCode::force_limit_missing});
  }
  if (firmware != DriveFirmware::openffboard) return std::nullopt;
  if (wall.damping > 0.0) {
    return option_problem("wall.damping",
                          {.code = ProblemCode::end_stop_without_damping, .evidence = {{"value", wall.damping}}});
  }
  const double gain = numbers_of(firmware, device).front().value;
  if (!(gain >= 1.0 && gain <= most_endstop)) {
    return option_problem("wall.stiffness", {.code = ProblemCode::end_stop_gain_out_of_range,
                                             .evidence = {{"value", gain}, {"least", 1.0}, {"most", most_endstop}}});
  }
  return std::nullopt;
}

std::optional<OptionProblem> find_problem(const DriveLoopOptions& options, DriveFirmware firmware,
                                          const Device& device) {
  if (has_damper_loop(device.loop())) {
    const Problem stated{.code = ProblemCode::timing_of_damper_loop};
    if (options.sampling_period) return option_problem("sampling_period", stated);
    if (options.delay) return option_problem("delay", stated);
    if (options.estimator_bandwidth) return option_problem("estimator_bandwidth", stated);
    return std::nullopt;
  }
  if (options.sampling_period && !(std::isfinite(*options.sampling_period) && *options.sampling_period > 0.0)) {
    return option_problem("sampling_period", {.code = ProblemCode::not_finite_and_positive,
                                              .evidence = {{"value", *options.sampling_period}},
                                              .subjects = {{"what", "time"}}});
  }
  const double period = options.sampling_period.value_or(period_of(firmware, device));
  if (options.delay && !(*options.delay >= 0.0 && *options.delay <= max_delay_samples * period)) {
    return option_problem("delay", {.code = ProblemCode::delay_out_of_range,
                                    .evidence = {{"value", *options.delay}, {"most", max_delay_samples}}});
  }
  if (!has_loop(firmware)) {
    if (!options.estimator_bandwidth) return std::nullopt;
    return option_problem("estimator_bandwidth", {.code = ProblemCode::no_estimator});
  }
  const double bandwidth = bandwidth_of(firmware, options, device);
  const double most = firmware == DriveFirmware::moteus ? 0.25 * turn / period : 0.5 / period;
  if (bandwidth > 0.0 && bandwidth < most) return std::nullopt;
  // Of a file's own, the tracking loop's: what the estimator's is made from.
  const double tracking = device.parameters().sensor.tracking_bandwidth;
  const bool is_of_file = !options.estimator_bandwidth && tracking > 0.0;
  const double share = is_of_file ? tracking / bandwidth : 1.0;
  return option_problem(is_of_file ? "sensor.tracking_bandwidth" : "estimator_bandwidth",
                        {.code = ProblemCode::estimator_bandwidth_out_of_range,
                         .evidence = {{"value", share * bandwidth}, {"most", share * most}},
                         .subjects = {{"unit", "rad/s"}}});
}

DriveGains drive_gains(const Device& device, DriveFirmware firmware, const DriveLoopOptions& options) {
  require_valid(find_problem(firmware, device));
  require_valid(find_problem(options, firmware, device));
  if (has_damper_loop(device.loop())) return gains_of_damper(device, firmware);
  DriveGains gains;
  gains.numbers = numbers_of(firmware, device);
  gains.sampling_period = options.sampling_period.value_or(period_of(firmware, device));
  gains.delay = options.delay.value_or(gains.sampling_period);
  DeviceParameters parameters = device.parameters();
  if (firmware == DriveFirmware::openffboard) {
    const MotorWall wall = at_motor(device);
    parameters.wall.stiffness = *parameters.wall.stiffness * gains.numbers.front().value * endstop_gain *
                                wall.full_torque / (wall.stiffness * degree * endstop_full_scale);
  }
  gains.stiffness = *parameters.wall.stiffness;
  parameters.loop.sampling_period = gains.sampling_period;
  parameters.loop.delay = gains.delay;
  parameters.wall = wall_on_drive(firmware, std::move(parameters.wall), gains.sampling_period,
                                  bandwidth_of(firmware, options, device));
  if (has_loop(firmware)) parameters.sensor.tracking_bandwidth = 0.0;  // it is in the wall
  gains.on_drive = analyze(Device(std::move(parameters)));
  gains.on_drive.trust.doubt({.code = FindingCode::current_loop_not_modelled});
  gains.remarks = remarks_of(firmware, gains, options, device);
  return gains;
}

}  // namespace zwidth

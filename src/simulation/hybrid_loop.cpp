#include "zwidth/simulation/hybrid_loop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>

#include "simulation/continuous_motion.hpp"
#include "simulation/held_path.hpp"
#include "simulation/loop_schedule.hpp"
#include "simulation/simulation_setup.hpp"
#include "zwidth/control/sampled_damper.hpp"
#include "zwidth/error.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// Motion between irregular instants is a series over parts of 1/rate: more of them per period would take for ever.
constexpr double most_parts_per_period = 1e4;
constexpr double never = std::numeric_limits<double>::infinity();

OutsideForce outside_force(const UserForce& force) {
  switch (force.kind) {
    case UserForce::Kind::none:
      return {};
    case UserForce::Kind::sine:
      return {true, force.frequency, force.frequency};
    case UserForce::Kind::step:
    case UserForce::Kind::ramp:
    case UserForce::Kind::recorded:
      return {true, 1.0, 0.0};
  }
  return {};
}

void check(const Device& device, const HybridLoopOptions& options) {
  check_bodies(device, options);
  require_valid(find_problem(options, device));
}

}  // namespace

struct HybridLoop::State {
  using Kind = LoopSchedule::Event::Kind;

  State(const Device& device, const HybridLoopOptions& given)
      : options(given),
        period(device.loop().sampling_period),
        is_apart(damper_runs_apart(device, given.controller)),
        schedule(loop_schedule(device.loop(), is_apart)),
        motion(device, outside_force(given.user_force), schedule.lengths),
        controller(is_apart ? without_damper(given.controller) : given.controller, period),
        resolution(device.parameters().sensor.resolution),
        limit(device.parameters().actuator.force_limit.value_or(never)),
        only_pushes(is_unilateral_wall(given.controller)) {
    for (const LoopSchedule::HeldPath& path : schedule.paths) {
      paths.emplace_back(path, schedule.tick, options.faults.overrun_delay);
    }
    if (is_apart) {
      const double ticks = static_cast<double>(schedule.paths[LoopSchedule::damper].every);
      damper.emplace(given.controller, ticks * schedule.tick);
    }
    const std::size_t bodies = device.bodies().size();
    if (options.initial_position.empty()) options.initial_position.assign(bodies, 0.0);
    if (options.initial_velocity.empty()) options.initial_velocity.assign(bodies, 0.0);
    const Faults& faults = options.faults;
    is_faulty =
        faults.lost_sample_probability > 0.0 || faults.sampling_jitter > 0.0 || faults.overrun_probability > 0.0;
    const bool takes_odd_steps = is_faulty || motion.has_friction() || options.user_force.kind != UserForce::Kind::none;
    if (takes_odd_steps && !(motion.rate() * period <= most_parts_per_period)) {
      throw Error(ErrorCode::invalid_argument,
                  {.code = ProblemCode::motion_too_fast, .evidence = {{"rate", motion.rate()}}});
    }
    reset();
  }

  void reset() noexcept {
    motion.reset();
    controller.reset();
    if (damper) damper->reset();
    random.seed(options.faults.seed);
    for (RunningPath& path : paths) path.reset();
    tick = phase = user_sample = 0;
    command = spring_command = work = 0.0;
    user_has_started = false;
    motion.set_motion(options.initial_position.data(), options.initial_velocity.data());
    measured = quantised(motion.sensed());
  }

  [[nodiscard]] double quantised(double position) const noexcept {
    return resolution > 0.0 ? resolution * std::floor(position / resolution + 0.5) : position;
  }

  /// What the actuator can give.
  [[nodiscard]] double limited(double force) const noexcept { return std::clamp(force, -limit, limit); }
  [[nodiscard]] double sum(double spring, double of_damper) const noexcept {
    return limited(sum_of_paths(spring, of_damper, only_pushes));
  }

  void read(LoopSchedule::Path path) noexcept {
    if (path == LoopSchedule::damper) {
      paths[path].asked = damper->update(quantised(motion.sensed()));
      return;
    }
    measured = quantised(motion.sensed());
    ask(controller.update(measured));
  }

  /// The force of the spring, which is the wall's where the damper does not run apart.
  void ask(double force) noexcept {
    spring_command = is_apart ? force : limited(force);
    command = is_apart ? sum(force, paths[LoopSchedule::damper].asked) : spring_command;
    paths[LoopSchedule::spring].asked = spring_command;
  }

  void apply() noexcept {
    const double force = paths[LoopSchedule::spring].held;
    motion.set_command(is_apart ? sum(force, paths[LoopSchedule::damper].held) : force);
  }

  double uniform() noexcept { return static_cast<double>(random() >> 11) * 0x1p-53; }

  /// Moves the device by one of the schedule's lengths.
  void move_recurring(std::size_t which) noexcept {
    const double duration = schedule.lengths[which];
    const double start = motion.actuated();
    if (user_changes_within(duration)) {
      move_with_user(duration);
    } else {
      motion.advance_recurring(which);
    }
    work += motion.command() * (motion.actuated() - start);
    within += duration;
  }

  void move(double duration) noexcept {
    if (duration <= 0.0) return;
    const double start = motion.actuated();
    if (user_changes_within(duration)) {
      move_with_user(duration);
    } else {
      motion.advance(duration);
    }
    work += motion.command() * (motion.actuated() - start);
    within += duration;
  }

  /// Time of the user force's next change (start, or next sample), s from the start of the current tick.
  [[nodiscard]] double next_user_change() const noexcept {
    const UserForce& force = options.user_force;
    if (force.kind == UserForce::Kind::none) return never;
    const double tick_start = static_cast<double>(tick) * schedule.tick;
    if (!user_has_started) return force.start - tick_start;
    if (force.kind != UserForce::Kind::recorded || user_sample >= force.samples.size()) return never;
    return force.start + static_cast<double>(user_sample) * force.period - tick_start;
  }

  [[nodiscard]] bool user_changes_within(double duration) const noexcept {
    return next_user_change() < within + duration;
  }

  void move_with_user(double duration) noexcept {
    const double end = within + duration;
    double now = within;
    for (double change = next_user_change(); change < end; change = next_user_change()) {
      if (change > now) {
        motion.advance(change - now);
        now = change;
      }
      change_user_force();
    }
    if (end > now) motion.advance(end - now);
  }

  void change_user_force() noexcept {
    const UserForce& force = options.user_force;
    user_has_started = true;
    switch (force.kind) {
      case UserForce::Kind::none:
        return;
      case UserForce::Kind::step:
        return motion.set_outside(force.amplitude, 0.0);
      case UserForce::Kind::ramp:
      case UserForce::Kind::sine:  // of w0 = a sin, w1 = a cos, the second starts at a
        return motion.set_outside(0.0, force.amplitude);
      case UserForce::Kind::recorded: {
        const std::size_t k = user_sample++;
        const bool is_last = k + 1 >= force.samples.size();
        motion.set_outside(is_last ? 0.0 : force.samples[k],
                           is_last ? 0.0 : (force.samples[k + 1] - force.samples[k]) / force.period);
        return;
      }
    }
  }

  void step() noexcept {
    for (std::size_t i = 0; i < schedule.ticks_per_step; ++i) {
      if (is_faulty) {
        tick_with_faults();
      } else {
        tick_by_schedule(nullptr);
      }
    }
  }

  void step_with(double force) noexcept {
    for (std::size_t i = 0; i < schedule.ticks_per_step; ++i) tick_by_schedule(&force);
  }

  /// `given`: the spring's force, instead of the controller's.
  void tick_by_schedule(const double* given) noexcept {
    within = 0.0;
    for (const LoopSchedule::Event& event : schedule.ticks[phase]) {
      switch (event.kind) {
        case Kind::reads:
          if (given != nullptr && event.path == LoopSchedule::spring) {
            ask(*given);
          } else {
            read(event.path);
          }
          paths[event.path].send();
          break;
        case Kind::arrives:
          paths[event.path].arrive();
          apply();
          break;
        case Kind::moves:
          move_recurring(event.length);
          break;
      }
    }
    end_tick();
  }

  void end_tick() noexcept {
    ++tick;
    phase = phase + 1 == schedule.ticks.size() ? 0 : phase + 1;
  }

  /// A read of a path in this tick, and what goes wrong with it.
  struct Reading {
    double at = never;  // s from the start of the tick; never where the path does not read, or has read
    bool is_lost = false;
    bool overruns = false;
  };

  Reading draw() noexcept {
    const Faults& faults = options.faults;
    Reading reading;
    reading.at = faults.sampling_jitter > 0.0 ? faults.sampling_jitter * uniform() : 0.0;
    reading.is_lost = uniform() < faults.lost_sample_probability;
    reading.overruns = uniform() < faults.overrun_probability;
    return reading;
  }

  void tick_with_faults() noexcept {
    within = 0.0;
    std::array<Reading, 2> readings;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (phase % schedule.paths[i].every == 0) readings[i] = draw();
    }
    for (;;) {
      std::size_t reader = 0;
      std::size_t arriving = 0;
      for (std::size_t i = 1; i < paths.size(); ++i) {
        if (readings[i].at <= readings[reader].at) reader = i;  // the damper first, as by the schedule
        if (paths[i].next_arrival(tick) < paths[arriving].next_arrival(tick)) arriving = i;
      }
      Reading& reading = readings[reader];
      const double arrival = paths[arriving].next_arrival(tick);
      const double next = std::min(reading.at, arrival);
      if (next >= schedule.tick) break;
      move(next - within);
      within = std::max(within, next);
      if (reading.at <= arrival) {
        reading.at = never;
        if (reading.is_lost) continue;
        read(static_cast<LoopSchedule::Path>(reader));
        paths[reader].send(tick, within, reading.overruns ? options.faults.overrun_delay : 0.0, schedule.tick);
      } else {
        paths[arriving].arrive_late();
        apply();
      }
    }
    move(schedule.tick - within);
    end_tick();
  }

  HybridLoopOptions options;
  double period;  // of the spring
  bool is_apart;
  LoopSchedule schedule;
  ContinuousMotion motion;
  SampledController controller;         // without its damper where that runs apart
  std::optional<SampledDamper> damper;  // that runs apart
  double resolution;
  double limit;
  bool only_pushes;
  std::vector<RunningPath> paths;
  std::mt19937_64 random;
  bool is_faulty = false;
  bool user_has_started = false;
  std::size_t tick = 0;
  std::size_t phase = 0;  // of the tick within the longer period
  std::size_t user_sample = 0;
  double within = 0.0;  // s since the start of the current tick
  double measured = 0.0;
  double command = 0.0;
  double spring_command = 0.0;
  double work = 0.0;
};

HybridLoop::HybridLoop(const Device& device, const HybridLoopOptions& options) {
  check(device, options);
  state_ = std::make_unique<State>(device, options);
}

HybridLoop::HybridLoop(HybridLoop&&) noexcept = default;
HybridLoop& HybridLoop::operator=(HybridLoop&&) noexcept = default;
HybridLoop::~HybridLoop() = default;

void HybridLoop::step() noexcept { state_->step(); }

double HybridLoop::measure() noexcept { return state_->measured = state_->quantised(state_->motion.sensed()); }

void HybridLoop::move(double force) noexcept { state_->step_with(force); }

void HybridLoop::reset() noexcept { state_->reset(); }

std::size_t HybridLoop::sample() const noexcept { return state_->tick / state_->schedule.ticks_per_step; }
double HybridLoop::time() const noexcept { return static_cast<double>(sample()) * state_->period; }
double HybridLoop::sensed_position() const noexcept { return state_->motion.sensed(); }
double HybridLoop::position(std::size_t body) const noexcept { return state_->motion.position(body); }
double HybridLoop::velocity(std::size_t body) const noexcept { return state_->motion.velocity(body); }
bool HybridLoop::sticks(std::size_t body) const noexcept { return state_->motion.sticks(body); }
double HybridLoop::user_force() const noexcept { return state_->motion.outside_force(); }
double HybridLoop::measured() const noexcept { return state_->measured; }
double HybridLoop::command() const noexcept { return state_->command; }
double HybridLoop::spring_command() const noexcept { return state_->spring_command; }
double HybridLoop::work() const noexcept { return state_->work; }
std::size_t HybridLoop::friction_events() const noexcept { return state_->motion.events(); }
std::size_t HybridLoop::overloaded_steps() const noexcept { return state_->motion.overloaded(); }

}  // namespace zwidth

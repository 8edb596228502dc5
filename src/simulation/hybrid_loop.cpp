#include "zwidth/simulation/hybrid_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>

#include "require_valid.hpp"
#include "sampling/sampling_instants.hpp"
#include "simulation/continuous_motion.hpp"
#include "simulation/simulation_setup.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"

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
  const ControllerOptions& controller = options.controller;
  if (controller.kind == ControllerOptions::Kind::wall && controller.damping > 0.0) require_one_rate(device);
}

/// Forces on their way to the device, in the order of their arrival: a ring that never grows.
class ForcesUnderWay {
 public:
  explicit ForcesUnderWay(std::size_t capacity) : ring_(capacity) {}

  struct Force {
    std::size_t step = 0;  // in which it arrives
    double within = 0.0;   // s from the start of that step, < T
    double value = 0.0;
  };

  void clear() noexcept { first_ = count_ = 0; }
  /// s from the start of `step`; never in a later one.
  [[nodiscard]] double next_arrival(std::size_t step) const noexcept {
    return count_ == 0 || ring_[first_].step > step ? never : ring_[first_].within;
  }
  double pop() noexcept {
    const double value = ring_[first_].value;
    first_ = (first_ + 1) % ring_.size();
    --count_;
    return value;
  }
  /// Older forces that would arrive later are out of date: they are dropped.
  void push(Force force) noexcept {
    while (count_ > 0 && !arrives_before(at(count_ - 1), force)) --count_;
    if (count_ == ring_.size()) pop();
    at(count_++) = force;
  }

 private:
  static bool arrives_before(const Force& a, const Force& b) noexcept {
    return a.step < b.step || (a.step == b.step && a.within < b.within);
  }
  [[nodiscard]] Force& at(std::size_t i) noexcept { return ring_[(first_ + i) % ring_.size()]; }

  std::vector<Force> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace

struct HybridLoop::State {
  enum Length : std::size_t { whole_step, until_arrival, after_arrival };

  State(const Device& device, const HybridLoopOptions& given)
      : options(given),
        period(device.loop().sampling_period),
        instants(sampling_instants({period, device.loop().delay})),
        motion(
            device, outside_force(given.user_force),
            instants.with_old > 0.0 ? std::vector{period, instants.with_old, instants.with_new} : std::vector{period}),
        controller(given.controller, period),
        resolution(device.parameters().sensor.resolution),
        limit(device.parameters().actuator.force_limit.value_or(never)),
        delay_line(instants.whole_samples + 1),
        under_way(static_cast<std::size_t>(std::ceil((device.loop().delay + given.faults.overrun_delay) / period)) + 3),
        delay(device.loop().delay) {
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
    random.seed(options.faults.seed);
    std::fill(delay_line.begin(), delay_line.end(), 0.0);
    under_way.clear();
    sample = oldest = user_sample = 0;
    command = work = 0.0;
    user_has_started = false;
    motion.set_motion(options.initial_position.data(), options.initial_velocity.data());
    measured = quantised(motion.sensed());
  }

  [[nodiscard]] double quantised(double position) const noexcept {
    return resolution > 0.0 ? resolution * std::floor(position / resolution + 0.5) : position;
  }

  void measure_and_update() noexcept {
    measured = quantised(motion.sensed());
    command = std::clamp(controller.update(measured), -limit, limit);
  }

  double uniform() noexcept { return static_cast<double>(random() >> 11) * 0x1p-53; }

  /// Moves the device by `duration`; a recurring one by its index.
  void move(double duration, Length which) noexcept {
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

  /// Time of the user force's next change (start, or next sample), s from the start of the current step.
  [[nodiscard]] double next_user_change() const noexcept {
    const UserForce& force = options.user_force;
    if (force.kind == UserForce::Kind::none) return never;
    const double step_start = static_cast<double>(sample) * period;
    if (!user_has_started) return force.start - step_start;
    if (force.kind != UserForce::Kind::recorded || user_sample >= force.samples.size()) return never;
    return force.start + static_cast<double>(user_sample) * force.period - step_start;
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
    measure_and_update();
    move_commanded();
  }

  /// With the command of this sample.
  void move_commanded() noexcept {
    within = 0.0;
    delay_line[oldest] = command;  // l samples behind the next one to leave
    oldest = oldest + 1 == delay_line.size() ? 0 : oldest + 1;
    const double arriving = delay_line[oldest];
    if (instants.with_old > 0.0) {
      move(instants.with_old, until_arrival);
      motion.set_command(arriving);
      move(instants.with_new, after_arrival);
    } else {
      motion.set_command(arriving);
      move(period, whole_step);
    }
    ++sample;
  }

  /// Lets a force arrive `later` than now, s.
  void send(double force, double later) noexcept {
    const double arrival = within + later;
    const double whole = std::floor(arrival / period);
    under_way.push({sample + static_cast<std::size_t>(whole), std::max(0.0, std::fma(-whole, period, arrival)), force});
  }

  void step_with_faults() noexcept {
    const Faults& faults = options.faults;
    within = 0.0;
    const double sampled_at = faults.sampling_jitter > 0.0 ? faults.sampling_jitter * uniform() : 0.0;
    const bool is_lost = uniform() < faults.lost_sample_probability;
    const bool overruns = uniform() < faults.overrun_probability;
    bool is_sampled = false;
    for (;;) {
      const double arrival = under_way.next_arrival(sample);
      const double next = std::min(is_sampled ? never : sampled_at, arrival);
      if (next >= period) break;
      move(next - within);
      within = std::max(within, next);
      if (!is_sampled && sampled_at <= arrival) {
        is_sampled = true;
        if (is_lost) continue;
        measure_and_update();
        send(command, delay + (overruns ? faults.overrun_delay : 0.0));
      } else {
        motion.set_command(under_way.pop());
      }
    }
    move(period - within);
    ++sample;
  }

  HybridLoopOptions options;
  double period;
  SamplingInstants instants;
  ContinuousMotion motion;
  SampledController controller;
  double resolution;
  double limit;
  std::vector<double> delay_line;
  ForcesUnderWay under_way;
  double delay;
  std::mt19937_64 random;
  bool is_faulty = false;
  bool user_has_started = false;
  std::size_t sample = 0;
  std::size_t oldest = 0;
  std::size_t user_sample = 0;
  double within = 0.0;  // s since the start of the current step
  double measured = 0.0;
  double command = 0.0;
  double work = 0.0;
};

HybridLoop::HybridLoop(const Device& device, const HybridLoopOptions& options) {
  check(device, options);
  state_ = std::make_unique<State>(device, options);
}

HybridLoop::HybridLoop(HybridLoop&&) noexcept = default;
HybridLoop& HybridLoop::operator=(HybridLoop&&) noexcept = default;
HybridLoop::~HybridLoop() = default;

void HybridLoop::step() noexcept {
  if (state_->is_faulty) {
    state_->step_with_faults();
  } else {
    state_->step();
  }
}

double HybridLoop::measure() noexcept { return state_->measured = state_->quantised(state_->motion.sensed()); }

void HybridLoop::move(double force) noexcept {
  state_->command = std::clamp(force, -state_->limit, state_->limit);
  state_->move_commanded();
}

void HybridLoop::reset() noexcept { state_->reset(); }

std::size_t HybridLoop::sample() const noexcept { return state_->sample; }
double HybridLoop::time() const noexcept { return static_cast<double>(state_->sample) * state_->period; }
double HybridLoop::sensed_position() const noexcept { return state_->motion.sensed(); }
double HybridLoop::position(std::size_t body) const noexcept { return state_->motion.position(body); }
double HybridLoop::velocity(std::size_t body) const noexcept { return state_->motion.velocity(body); }
bool HybridLoop::sticks(std::size_t body) const noexcept { return state_->motion.sticks(body); }
double HybridLoop::user_force() const noexcept { return state_->motion.outside_force(); }
double HybridLoop::measured() const noexcept { return state_->measured; }
double HybridLoop::command() const noexcept { return state_->command; }
double HybridLoop::work() const noexcept { return state_->work; }
std::size_t HybridLoop::friction_events() const noexcept { return state_->motion.events(); }
std::size_t HybridLoop::overloaded_steps() const noexcept { return state_->motion.overloaded(); }

}  // namespace zwidth

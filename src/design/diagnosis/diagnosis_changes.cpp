#include "design/diagnosis/diagnosis_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "design/sensitivities/number_limit.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/two_rate_users.hpp"
#include "staged_progress.hpp"
#include "zwidth/design/drive_damper.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/model/tip_motion.hpp"

namespace zwidth::internal {
namespace {

constexpr double more = 1.2;
constexpr double half = 0.5;
constexpr double twice = 2.0;
constexpr double finer = 0.25;
constexpr double softer = 0.5;                                                    // of the limit: 6 dB
constexpr std::array dampers{0.5, 0.8, 1.25, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0};  // times B, or the device's damping
constexpr double usual_changes = 16.0;                                            // for the progress
constexpr std::size_t most_links = 3;
constexpr std::size_t shares_looked_at = 4;  // every fourth share of friction

/// The stiffness, or the damping of a damper alone, up to which the cause is absent.
double limit_of(OscillationCause cause, const Device& device, WallNumber number, const Progress& progress) {
  switch (cause) {
    case OscillationCause::device:
      return number_limit(device_without_user(device), number).value;
    case OscillationCause::with_user:
      return number_limit(device, number).value;
    case OscillationCause::passive_user:
      if (const auto limit = absolute_stability_limit_of(device, number, progress)) return limit->value;
      break;
    case OscillationCause::friction: {
      double least = number_limit(device, number).value;
      const std::vector<double> shares = friction_shares(device);
      for (std::size_t i = 0; i < shares.size(); i += shares_looked_at) {
        tell(progress, 0.0);
        least = std::min(least, unchecked_number_limit(with_friction_as_damping(device, shares[i]), number).value);
      }
      return least;
    }
    case OscillationCause::quantisation:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The number of a wall that the limit is of.
double gain_of(const Device& device, WallNumber number) {
  const Wall& wall = device.parameters().wall;
  return number == WallNumber::stiffness ? *wall.stiffness : wall.damping;
}

class Changes {
 public:
  Changes(const ObservedLoop& loop, const OscillationCandidate& cause, const AbsoluteStabilityCheck& users)
      : loop_(loop), cause_(cause), users_(users), off_(cause.otherwise ? cause.otherwise->limit : 1.0) {
    if (is_quantisation()) return;
    const bool is_known = cause.cause == OscillationCause::passive_user && users.now();
    limit_ = is_known ? *users.now() : limit_of(cause.cause, loop.device, loop.number, loop.progress);
  }

  [[nodiscard]] std::vector<DiagnosisChange> all() {
    soften();
    const DeviceParameters& now = loop_.device.parameters();
    if (loop_.device.has_bodies()) {
      double damping = 0.0;
      for (const Body& body : now.bodies) damping += body.damping;
      if (damping > 0.0) {
        add(Kind::more_body_damping, "body.*.damping", damping, more * damping, [](DeviceParameters& then) {
          for (Body& body : then.bodies) body.damping *= more;
        });
      }
    }
    time();
    time_damper();
    if (now.actuator.time_constant > 0.0) {
      add(Kind::half_actuator_lag, "actuator.time_constant", now.actuator.time_constant,
          half * now.actuator.time_constant, [](DeviceParameters& then) { then.actuator.time_constant *= half; });
    }
    if (const double bandwidth = now.sensor.tracking_bandwidth; bandwidth > 0.0) {
      add(Kind::twice_tracking, "sensor.tracking_bandwidth", bandwidth, twice * bandwidth,
          [](DeviceParameters& then) { then.sensor.tracking_bandwidth *= twice; });
    }
    if (now.wall.damping > 0.0 && now.wall.velocity_filter_hz > 0.0) {
      add(Kind::no_velocity_filter, "wall.velocity_filter_hz", now.wall.velocity_filter_hz, 0.0,
          [](DeviceParameters& then) { then.wall.velocity_filter_hz = 0.0; });
    }
    damp();
    damp_on_drive();
    if (cause_.limited_by && cause_.limited_by->kind == Oscillator::Kind::vibration_mode) stop_mode();
    stiffen_cables();
    for (std::size_t i = 0; i < std::min(now.links.size(), most_links); ++i) {
      add({.kind = Kind::stiffer_link,
           .link = i,
           .key = fmt::format("link.{}.stiffness", i),
           .value_now = now.links[i].stiffness,
           .value_then = more * now.links[i].stiffness},
          [i](DeviceParameters& then) { then.links[i].stiffness *= more; });
    }
    if (is_quantisation()) {
      add(Kind::finer_encoder, "sensor.resolution", now.sensor.resolution, finer * now.sensor.resolution,
          [](DeviceParameters& then) { then.sensor.resolution *= finer; });
    }
    std::ranges::stable_sort(changes_, [](const DiagnosisChange& a, const DiagnosisChange& b) {
      if (is_safe(a) != is_safe(b)) return is_safe(a);
      if (a.limit_then && b.limit_then) return *a.limit_then > *b.limit_then;
      return a.amplitude_then.value_or(0.0) < b.amplitude_then.value_or(0.0);
    });
    return std::move(changes_);
  }

 private:
  using Kind = DiagnosisChange::Kind;

  [[nodiscard]] bool is_quantisation() const { return cause_.cause == OscillationCause::quantisation; }

  static bool is_safe(const DiagnosisChange& change) { return change.safe.value_or(true); }

  struct Recomputed {
    DiagnosisChange change;
    Device device;
  };

  /// The change, recomputed but not judged; nothing where it makes no device, or is worse than a cycle. `search`: of the
  /// changed device, where it is known.
  template <typename Change>
  std::optional<Recomputed> recomputed(DiagnosisChange result, const Change& change, AbsoluteStabilitySearch* search) {
    tell(loop_.progress, std::min(1.0, static_cast<double>(changes_.size()) / usual_changes));
    DeviceParameters parameters = loop_.device.parameters();
    change(parameters);
    if (find_problem(parameters)) return std::nullopt;
    Recomputed made{std::move(result), Device(std::move(parameters))};
    if (is_quantisation()) {
      const ObservedLoop with{made.device, loop_.frequency, {}, made.device.parameters().wall.stiffness, loop_.number};
      const auto cycle = quantisation_candidate(with);
      made.change.amplitude_now = cause_.amplitude;
      if (cycle && cycle->amplitude) made.change.amplitude_then = cycle->amplitude;
      made.change.ends_it = !cycle || !cycle->fits;
      return is_stable(made.device) ? std::optional(std::move(made)) : std::nullopt;
    }
    made.change.limit_now = limit_;
    if (cause_.cause == OscillationCause::passive_user) judge(made, search);
    const std::optional<double>& any_user = made.change.absolute_stability_limit_then;
    made.change.limit_then = cause_.cause == OscillationCause::passive_user && any_user
                                 ? *any_user
                                 : limit_of(cause_.cause, made.device, loop_.number, loop_.progress);
    if (std::isnan(*made.change.limit_then)) return std::nullopt;
    if (loop_.stiffness) made.change.ends_it = off_ * *made.change.limit_then > gain_of(made.device, loop_.number);
    return made;
  }

  void judge(Recomputed& made, AbsoluteStabilitySearch* search) const {
    if (made.change.safe) return;
    const auto judgement = search != nullptr ? users_.of(made.device, *search) : users_.of(made.device);
    made.change.absolute_stability_limit_then = judgement.then;
    made.change.safe = judgement.safe;
  }

  template <typename Change>
  void add(Kind kind, const std::string& key, double now, double then, const Change& change) {
    add({.kind = kind, .key = key, .value_now = now, .value_then = then}, change);
  }

  template <typename Change>
  void add(DiagnosisChange what, const Change& change) {
    auto made = recomputed(std::move(what), change, nullptr);
    if (!made) return;
    judge(*made, nullptr);
    changes_.push_back(std::move(made->change));
  }

  /// Of motors in a mechanism, and of its file.
  void stiffen_cables() {
    const DeviceParameters& device = loop_.device.parameters();
    if (!device.mechanism) return;
    const auto stiffen = [&](const std::string& key, std::optional<std::size_t> link, double stiffness) {
      if (!(stiffness > 0.0)) return;
      add({.kind = Kind::stiffer_link,
           .link = link,
           .key = key,
           .value_now = stiffness,
           .value_then = more * stiffness},
          [&](DeviceParameters& then) { set_parameter(then, key, more * stiffness); });
    };
    const MechanismFile& mechanism = device.mechanism->mechanism;
    const std::vector<Transmission>& motors = mechanism.transmissions;
    for (std::size_t i = 0; i < std::min(motors.size(), most_links); ++i) {
      stiffen(fmt::format("transmission.{}.stiffness", i), i, motors[i].stiffness);
    }
    std::size_t tendons = 0;
    for (const auto& [number, of_file] : mechanism.file_numbers) {
      const bool is_cable = number.starts_with("tendon.") && number.ends_with(".stiffness");
      if (!is_cable || ++tendons > most_links) continue;
      const std::string key = fmt::format("mechanism.{}", number);
      stiffen(key, std::nullopt, parameter(device, key).value_or(0.0));
    }
  }

  /// What a damper alone has of its own, the loop's numbers do not move.
  void time() {
    const Loop& loop = loop_.device.loop();
    const bool is_damper_alone = loop_.number == WallNumber::damping && loop.damper;
    if (loop.delay > 0.0 && !(is_damper_alone && loop.damper->delay)) {
      add(Kind::half_delay, "loop.delay", loop.delay, half * loop.delay,
          [](DeviceParameters& then) { then.loop.delay *= half; });
    }
    if (loop_.device.parameters().wall.filters.empty() && !(is_damper_alone && loop.damper->sampling_period)) {
      add(Kind::twice_sampling_rate, "loop.sampling_period", loop.sampling_period, half * loop.sampling_period,
          [](DeviceParameters& then) { then.loop.sampling_period *= half; });
    }
  }

  /// The same of the damper's own loop, where it does anything.
  void time_damper() {
    const std::optional<LoopDamper>& damper = loop_.device.loop().damper;
    if (!damper || loop_.device.parameters().wall.damping == 0.0) return;
    if (damper->delay.value_or(0.0) > 0.0) {
      add(Kind::half_damper_delay, "loop.damper.delay", *damper->delay, half * *damper->delay,
          [](DeviceParameters& then) { *then.loop.damper->delay *= half; });
    }
    if (damper->sampling_period) {
      add(Kind::twice_damper_rate, "loop.damper.sampling_period", *damper->sampling_period,
          half * *damper->sampling_period, [](DeviceParameters& then) { *then.loop.damper->sampling_period *= half; });
    }
  }

  void soften() {
    if (!loop_.stiffness) return;
    const bool is_damper = loop_.number == WallNumber::damping;
    const double now = gain_of(loop_.device, loop_.number);
    // A hand that takes hold of the cure must not make it shake.
    const double limit = std::min(limit_, users_.now().value_or(limit_));
    const double softened = is_quantisation() ? softer * now : softer * off_ * limit;
    if (!(softened > 0.0 && softened < now)) return;
    if (is_damper) {
      add(is_quantisation() ? Kind::half_damper : Kind::weaker_damper, "wall.damping", now, softened,
          [&](DeviceParameters& then) { then.wall.damping = softened; });
    } else {
      add(is_quantisation() ? Kind::half_stiffness : Kind::softer_wall, "wall.stiffness", now, softened,
          [&](DeviceParameters& then) { then.wall.stiffness = softened; });
    }
  }

  /// What the ladder of dampers is of: B, or the device's damping; 0 where there is neither nor a wall.
  [[nodiscard]] double unit_of_dampers() const {
    double unit = loop_.device.parameters().wall.damping;
    if (unit > 0.0) return unit;
    for (const Body& body : loop_.device.bodies()) unit += body.damping;
    // A mechanism's are of many joints. A device that nothing damps: of a sample of its wall.
    return unit > 0.0 ? unit : 0.1 * loop_.stiffness.value_or(0.0) * loop_.device.loop().sampling_period;
  }

  /// The damper of the ladder with the highest limit (least amplitude) of those that lower no user's.
  void damp() {
    if (loop_.number == WallNumber::damping) return;  // the damper is what oscillates
    const Wall& wall = loop_.device.parameters().wall;
    const double unit = unit_of_dampers();
    if (!(unit > 0.0)) return;
    if (has_damper_loop(loop_.device.loop())) return damp_own_loop();
    std::optional<AbsoluteStabilitySearch> search;  // what users do does not depend on the damper
    if (users_.now()) search.emplace(loop_.device, loop_.progress);
    AbsoluteStabilitySearch* const users = search ? &*search : nullptr;
    std::vector<Recomputed> ladder;
    for (const double factor : dampers) {
      auto made = recomputed(
          {.kind = Kind::other_damper, .key = "wall.damping", .value_now = wall.damping, .value_then = factor * unit},
          [&](DeviceParameters& then) { then.wall.damping = factor * unit; }, users);
      if (made) ladder.push_back(*std::move(made));
    }
    if (ladder.empty()) return;
    std::ranges::stable_sort(ladder, [this](const Recomputed& a, const Recomputed& b) {
      return is_quantisation() ? a.change.amplitude_then.value_or(0.0) < b.change.amplitude_then.value_or(0.0)
                               : *a.change.limit_then > *b.change.limit_then;
    });
    for (Recomputed& each : ladder) {
      judge(each, users);
      if (!is_safe(each.change)) continue;
      changes_.push_back(std::move(each.change));
      return;
    }
    if (!users_.now()) changes_.push_back(std::move(ladder.front().change));
  }

  /// The same of a device whose damper runs in a loop of its own: the first of the most promising that lowers no user's.
  void damp_own_loop() {
    if (is_quantisation()) return;  // with such a damper its cycle is not known
    std::vector<double> tried;
    tried.reserve(std::size(dampers));
    for (const double factor : dampers) tried.push_back(factor * unit_of_dampers());
    for (const double damping : most_promising_first(loop_.device, std::move(tried))) {
      auto made = recomputed(
          {.kind = Kind::other_damper,
           .key = "wall.damping",
           .value_now = loop_.device.parameters().wall.damping,
           .value_then = damping},
          [&](DeviceParameters& then) { then.wall.damping = damping; }, nullptr);
      if (!made) continue;
      judge(*made, nullptr);
      if (!is_safe(made->change)) continue;
      changes_.push_back(std::move(made->change));
      return;
    }
  }

  /// The same with the damper in a loop of its own; of a damper alone that damper.
  void damp_on_drive() {
    // The cycle of an encoder is known of one rate alone, and so is what a grasp of a mechanism's tip does.
    if (is_quantisation() || is_of_mechanism(loop_.device)) return;
    const std::optional<Device> on_drive = with_damper_on_drive(loop_.device);
    if (!on_drive) return;
    const auto [period, delay] = damper_timing(on_drive->loop());
    const double now = loop_.device.parameters().wall.damping;
    std::vector<double> tried;
    if (now > 0.0) tried.push_back(now);
    if (loop_.number == WallNumber::stiffness) {
      for (const double factor : dampers) tried.push_back(factor * unit_of_dampers());
    }
    std::erase_if(tried, [](double damping) { return !(damping > 0.0); });
    for (const double damping : most_promising_first(*on_drive, std::move(tried))) {
      auto made = recomputed(
          {.kind = Kind::damper_on_drive,
           .key = "loop.damper.sampling_period",
           .value_now = loop_.device.loop().sampling_period,
           .value_then = period,
           .damping_then = damping,
           .delay_then = delay},
          [&](DeviceParameters& then) {
            then.loop = on_drive->loop();
            then.wall.damping = damping;
          },
          nullptr);
      if (!made) continue;
      judge(*made, nullptr);
      if (!is_safe(made->change)) continue;
      changes_.push_back(std::move(made->change));
      return;
    }
  }

  /// By the limit that they leave, of any user where that is known, as far as a quick look tells.
  [[nodiscard]] std::vector<double> most_promising_first(const Device& on_drive, std::vector<double> tried) const {
    if (tried.size() < 2) return tried;
    std::optional<TwoRateUsers> users;
    if (users_.now() && knows_all_users(on_drive)) users.emplace(on_drive);
    std::vector<std::pair<double, double>> limits;
    for (const double damping : tried) {
      const VirtualDamper damper{damping, on_drive.parameters().wall.velocity_filter_hz};
      const double nobody = limit_of_nobody(on_drive, damper);
      limits.emplace_back(users ? std::min(nobody, users->limit_on_grid(damper)) : nobody, damping);
    }
    std::ranges::stable_sort(limits, std::greater<>(), &std::pair<double, double>::first);
    std::ranges::transform(limits, tried.begin(), &std::pair<double, double>::second);
    return tried;
  }

  [[nodiscard]] static double limit_of_nobody(const Device& device, VirtualDamper damper) {
    return unchecked_number_limit(device_without_user(with_wall(device, 0.0, damper)), WallNumber::stiffness).value;
  }

  void stop_mode() {
    WallFilter notch;
    notch.kind = WallFilter::Kind::notch;
    notch.frequency_hz = cause_.frequency / (2.0 * std::numbers::pi);
    notch.damping_ratio = 0.5;
    if (find_problem(notch, loop_.device.loop().sampling_period)) return;
    add(Kind::notch, "wall.filter", 0.0, notch.frequency_hz,
        [&](DeviceParameters& then) { then.wall.filters.push_back(notch); });
  }

  const ObservedLoop& loop_;
  const OscillationCandidate& cause_;
  const AbsoluteStabilityCheck& users_;
  double off_;  // the real limit of a cause that does not fit, of the one that the device's numbers give
  double limit_ = 0.0;
  std::vector<DiagnosisChange> changes_;
};

}  // namespace

std::vector<DiagnosisChange> changes_of(const ObservedLoop& loop, const OscillationCandidate& cause,
                                        const AbsoluteStabilityCheck& users) {
  return Changes(loop, cause, users).all();
}

}  // namespace zwidth::internal

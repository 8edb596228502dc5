#include "design/diagnosis_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "staged_progress.hpp"
#include "zwidth/stability/any_user.hpp"

namespace zwidth::internal {
namespace {

constexpr double more = 1.2;
constexpr double half = 0.5;
constexpr double finer = 0.25;
constexpr double softer = 0.5;                                                    // of the limit: 6 dB
constexpr std::array dampers{0.5, 0.8, 1.25, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0};  // times B, or the device's damping
constexpr double usual_changes = 16.0;                                            // for the progress
constexpr std::size_t most_links = 3;
constexpr std::size_t shares_looked_at = 4;  // every fourth share of friction

/// The stiffness up to which the cause is absent.
double limit_of(OscillationCause cause, const Device& device, const Progress& progress) {
  switch (cause) {
    case OscillationCause::device:
      return critical_stiffness(without_operator(device)).stiffness;
    case OscillationCause::with_operator:
      return critical_stiffness(device).stiffness;
    case OscillationCause::passive_user:
      return any_user_limit(device, virtual_damper(device), progress).stiffness;
    case OscillationCause::friction: {
      double least = critical_stiffness(device).stiffness;
      const std::vector<double> shares = friction_shares(device);
      for (std::size_t i = 0; i < shares.size(); i += shares_looked_at) {
        tell(progress, 0.0);
        const Device rubbing = with_friction_as_damping(device, shares[i]);
        least = std::min(least, critical_stiffness(filtered_plant(rubbing), virtual_damper(rubbing)).stiffness);
      }
      return least;
    }
    case OscillationCause::quantisation:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

class Changes {
 public:
  Changes(const ObservedLoop& loop, const OscillationCandidate& cause) : loop_(loop), cause_(cause) {
    if (!is_quantisation()) limit_ = limit_of(cause.cause, loop.device, loop.progress);
  }

  [[nodiscard]] std::vector<DiagnosisChange> all() {
    soften();
    const DeviceParameters& now = loop_.device.parameters();
    if (loop_.device.has_bodies()) {
      double damping = 0.0;
      for (const Body& body : now.bodies) damping += body.damping;
      if (damping > 0.0) {
        add("damping of every body + 20 %", "body.*.damping", damping, more * damping, [](DeviceParameters& then) {
          for (Body& body : then.bodies) body.damping *= more;
        });
      }
    }
    if (now.loop.delay > 0.0) {
      add("half the delay", "loop.delay", now.loop.delay, half * now.loop.delay,
          [](DeviceParameters& then) { then.loop.delay *= half; });
    }
    if (now.wall.filters.empty()) {
      add("twice the sampling rate", "loop.sampling_period", now.loop.sampling_period, half * now.loop.sampling_period,
          [](DeviceParameters& then) { then.loop.sampling_period *= half; });
    }
    if (now.actuator.time_constant > 0.0) {
      add("half the actuator's lag", "actuator.time_constant", now.actuator.time_constant,
          half * now.actuator.time_constant, [](DeviceParameters& then) { then.actuator.time_constant *= half; });
    }
    if (now.wall.damping > 0.0 && now.wall.velocity_filter_hz > 0.0) {
      add("no velocity filter", "wall.velocity_filter_hz", now.wall.velocity_filter_hz, 0.0,
          [](DeviceParameters& then) { then.wall.velocity_filter_hz = 0.0; });
    }
    damp();
    if (cause_.limited_by && cause_.limited_by->kind == Mechanism::Kind::vibration_mode) stop_mode();
    for (std::size_t i = 0; i < std::min(now.links.size(), most_links); ++i) {
      add(fmt::format("link {} 20 % stiffer", i), fmt::format("link.{}.stiffness", i), now.links[i].stiffness,
          more * now.links[i].stiffness, [i](DeviceParameters& then) { then.links[i].stiffness *= more; });
    }
    if (is_quantisation()) {
      add("an encoder four times as fine", "sensor.resolution", now.sensor.resolution, finer * now.sensor.resolution,
          [](DeviceParameters& then) { then.sensor.resolution *= finer; });
    }
    std::ranges::stable_sort(changes_, [](const DiagnosisChange& a, const DiagnosisChange& b) {
      if (a.limit_then && b.limit_then) return *a.limit_then > *b.limit_then;
      return a.amplitude_then.value_or(0.0) < b.amplitude_then.value_or(0.0);
    });
    return std::move(changes_);
  }

 private:
  [[nodiscard]] bool is_quantisation() const { return cause_.cause == OscillationCause::quantisation; }

  /// The change, recomputed; left out where it makes no device.
  template <typename Change>
  void add(std::string what, std::string key, double now, double then, const Change& change) {
    tell(loop_.progress, std::min(1.0, static_cast<double>(changes_.size()) / usual_changes));
    DeviceParameters parameters = loop_.device.parameters();
    change(parameters);
    if (find_problem(parameters)) return;
    DiagnosisChange result{std::move(what), std::move(key), now, then, {}, {}, {}, {}, {}};
    const Device changed(std::move(parameters));
    if (is_quantisation()) {
      ObservedLoop with{changed, loop_.frequency, {}, changed.parameters().wall.stiffness};
      const auto cycle = quantisation_candidate(with);
      result.amplitude_now = cause_.amplitude;
      if (cycle && cycle->amplitude) result.amplitude_then = cycle->amplitude;
      result.ends_it = !cycle || !cycle->fits;
      if (!is_stable(changed)) return;  // worse than the cycle
    } else {
      result.limit_now = limit_;
      result.limit_then = limit_of(cause_.cause, changed, loop_.progress);
      if (std::isnan(*result.limit_then)) return;
      const std::optional<double> stiffness = changed.parameters().wall.stiffness;
      if (loop_.stiffness) result.ends_it = *result.limit_then > *stiffness;
    }
    changes_.push_back(std::move(result));
  }

  void soften() {
    if (!loop_.stiffness) return;
    const double softened = is_quantisation() ? softer * *loop_.stiffness : softer * limit_;
    if (!(softened > 0.0 && softened < *loop_.stiffness)) return;
    add(is_quantisation() ? "half the stiffness" : "a softer wall, 6 dB below the limit", "wall.stiffness",
        *loop_.stiffness, softened, [&](DeviceParameters& then) { then.wall.stiffness = softened; });
  }

  /// The damper of the ladder with the highest limit (least amplitude).
  void damp() {
    const Wall& wall = loop_.device.parameters().wall;
    double unit = wall.damping;
    if (unit == 0.0) {
      for (const Body& body : loop_.device.bodies()) unit += body.damping;
      if (!(unit > 0.0)) return;
    }
    const std::size_t before = changes_.size();
    for (const double factor : dampers) {
      add("another virtual damper", "wall.damping", wall.damping, factor * unit,
          [&](DeviceParameters& then) { then.wall.damping = factor * unit; });
    }
    if (changes_.size() <= before + 1) return;
    const auto first = changes_.begin() + static_cast<std::ptrdiff_t>(before);
    const auto best = std::min_element(first, changes_.end(), [this](const auto& a, const auto& b) {
      return is_quantisation() ? a.amplitude_then.value_or(0.0) < b.amplitude_then.value_or(0.0)
                               : *a.limit_then > *b.limit_then;
    });
    const DiagnosisChange kept = *best;
    changes_.erase(first, changes_.end());
    changes_.push_back(kept);
  }

  void stop_mode() {
    WallFilter notch;
    notch.kind = WallFilter::Kind::notch;
    notch.frequency_hz = cause_.frequency / (2.0 * std::numbers::pi);
    notch.damping_ratio = 0.5;
    if (find_problem(notch, loop_.device.loop().sampling_period)) return;
    add("a notch there", "wall.filter", 0.0, notch.frequency_hz,
        [&](DeviceParameters& then) { then.wall.filters.push_back(notch); });
  }

  const ObservedLoop& loop_;
  const OscillationCandidate& cause_;
  double limit_ = 0.0;
  std::vector<DiagnosisChange> changes_;
};

}  // namespace

std::vector<DiagnosisChange> changes_of(const ObservedLoop& loop, const OscillationCandidate& cause) {
  return Changes(loop, cause).all();
}

}  // namespace zwidth::internal

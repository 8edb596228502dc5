#include "stability/users/two_rate_users.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "model/rate_ratio.hpp"
#include "stability/users/disc_pieces.hpp"
#include "stability/users/disc_stiffness.hpp"
#include "stability/users/termination_discs.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;

// The grid of frequencies: this many evenly in the spring's band, and as many again for each whole period of its delay.
constexpr int even_frequencies = 128;
constexpr int grid_frequencies_per_decade = 24;  // below the first of them
constexpr double least_grid_angle = 1e-7;        // rad per period of the spring
constexpr int bits_of_minimum = 40;
constexpr double flat_minimum = 1e-8;     // relative: neighbours this near are a minimum to an eighth of that
constexpr double same_as_at_zero = 1e-9;  // relative: the frequency is then 0
constexpr double whole_within = 1e-6;     // periods of the damper, of the difference of the delays

// The damper's periods by which the spring's force comes later; nothing where they are no whole number or the damper is slower.
std::optional<double> whole_periods_later(const Loop& loop) {
  const auto [period, delay] = damper_timing(loop);
  if (rate_ratio(loop.sampling_period, period) < 1.0) return std::nullopt;
  const double later = (loop.delay - delay) / period;
  const double whole = std::round(later);
  return std::abs(later - whole) <= whole_within ? std::optional(whole) : std::nullopt;
}

}  // namespace

class TwoRateDiscs {
 public:
  // `free`: of a loop that knows_all_users().
  explicit TwoRateDiscs(const Device& free, bool is_quick = true)
      : discs_(with_loop_of_damper(free)),
        period_(free.loop().sampling_period),
        fast_period_(damper_timing(free.loop()).sampling_period),
        steps_(static_cast<int>(periods_within(period_, fast_period_))),
        periods_later_(whole_periods_later(free.loop()).value()) {
    if (is_quick && !discs_.is_undamped()) pieces_ = DiscPieces(discs_, with_loop_of_damper(free));
  }
  TwoRateDiscs(const TwoRateDiscs&) = delete;
  TwoRateDiscs& operator=(const TwoRateDiscs&) = delete;

  [[nodiscard]] bool is_undamped() const { return discs_.is_undamped(); }
  [[nodiscard]] double nyquist() const { return pi / period_; }

  // The least K that the disc of the plant that the spring sees does not allow; 0 where the damper alone is not stable with
  // every user. 0 < frequency <= nyquist().
  [[nodiscard]] double limit_at(double frequency, VirtualDamper damper) const {
    return limit_of([&](int alias) {
      return closed(alias_of(frequency, alias, [&](double at) { return discs_.scaled_at({0.0, at}); }), damper);
    });
  }
  // The same by interpolated sums over aliases beyond the damper's rate, which `is_quick` prepares.
  [[nodiscard]] double quick_limit_at(double frequency, VirtualDamper damper) const {
    return limit_of([&](int alias) { return closed(quick_alias_of(frequency, alias), damper); });
  }

  // One frequency of the damper's band as the spring's samples show it, before the damper is closed.
  struct Alias {
    TerminationDiscs::Disc disc;  // scaled
    double frequency = 0.0;       // rad/s, without its sign
    bool is_negative = false;
    double gain = 0.0;           // |(1 - z^-N)/(1 - z^-1)|/N
    std::complex<double> phase;  // e^j of its angle and that of z^-m
  };
  using Aliases = std::vector<Alias>;
  [[nodiscard]] Aliases aliases_at(double frequency) const {
    Aliases all;
    for (int alias = least_alias(); alias <= steps_ / 2; ++alias) all.push_back(quick_alias_of(frequency, alias));
    return all;
  }
  [[nodiscard]] double limit_of_aliases(const Aliases& aliases, VirtualDamper damper) const {
    return limit_of(
        [&](int alias) { return closed(aliases[static_cast<std::size_t>(alias - least_alias())], damper); });
  }

  // The frequencies of the held device's modes, as they appear in the spring's band.
  void add_modes(std::vector<double>& frequencies) const {
    for (const Mode& mode : discs_.held_form().modes) {
      const double at = std::abs(std::remainder(mode.frequency, 2.0 * nyquist()));
      const double width = std::min(mode.damping_ratio, 1.0) * mode.frequency;
      for (double widths = 64.0; widths > 0.1; widths *= 0.5) {
        frequencies.push_back(at - widths * width);
        frequencies.push_back(at + widths * width);
      }
      frequencies.push_back(at);
    }
  }

 private:
  // What one alias adds; a negative radius where some user destabilises the damper there.
  struct Part {
    std::complex<double> centre;
    double radius = -1.0;
    double power = 0.0;  // |centre|² - radius²
  };

  [[nodiscard]] int least_alias() const { return -(steps_ - 1) / 2; }

  template <typename PartOf>
  [[nodiscard]] double limit_of(const PartOf& part_of) const {
    const Part own = part_of(0);
    if (!(own.radius >= 0.0)) return 0.0;
    std::complex<double> centre;
    double radius = 0.0;
    for (int alias = least_alias(); alias <= steps_ / 2; ++alias) {
      if (alias == 0) continue;
      const Part other = part_of(alias);
      if (!(other.radius >= 0.0)) return 0.0;
      centre += other.centre;
      radius += other.radius;
    }
    const double power = own.power + 2.0 * (std::conj(own.centre) * centre).real() + std::norm(centre) -
                         2.0 * own.radius * radius - radius * radius;
    return least_root(1.0, own.centre.real() + centre.real(), power);
  }

  [[nodiscard]] Alias quick_alias_of(double frequency, int alias) const {
    return alias_of(frequency, alias, [&](double at) { return pieces_.at({0.0, at}); });
  }

  // `disc_at`: scaled, at a frequency of the damper's band.
  template <typename DiscAt>
  [[nodiscard]] Alias alias_of(double frequency, int alias, const DiscAt& disc_at) const {
    double at = frequency + 2.0 * pi * alias / period_;
    const double fast_nyquist = pi / fast_period_;
    if (at > fast_nyquist) at -= 2.0 * fast_nyquist;
    Alias seen;
    seen.frequency = std::min(std::abs(at), fast_nyquist);
    seen.is_negative = at < 0.0;
    seen.disc = disc_at(seen.frequency);
    const double angle = seen.frequency * fast_period_;
    const double sum = std::sin(0.5 * angle * steps_) / std::sin(0.5 * angle);
    seen.gain = std::abs(sum) / steps_;
    seen.phase = (sum < 0.0 ? -1.0 : 1.0) * std::polar(1.0, -angle * (0.5 * (steps_ - 1) + periods_later_));
    return seen;
  }

  [[nodiscard]] Part closed(const Alias& seen, VirtualDamper gains) const {
    const TerminationDiscs::Disc& disc = seen.disc;
    if (!std::isfinite(disc.radius)) return {};
    const std::complex<double> damper = damper_response(gains, fast_period_, seen.frequency);
    const double divisor = disc.one + 2.0 * (damper * disc.centre).real() + std::norm(damper) * disc.power;
    if (!(divisor > 0.0)) return {};
    std::complex<double> centre = seen.gain * seen.phase * (disc.centre + std::conj(damper) * disc.power) / divisor;
    if (seen.is_negative) centre = std::conj(centre);
    return {centre, seen.gain * disc.radius / divisor, seen.gain * seen.gain * disc.power / divisor};
  }

  TerminationDiscs discs_;
  DiscPieces pieces_;
  double period_;
  double fast_period_;
  int steps_;
  double periods_later_;  // m
};

namespace {

std::vector<double> frequency_grid(const TwoRateDiscs& discs, const Device& device, const CriticalStiffness& nobody) {
  const double nyquist = discs.nyquist();
  const double period = device.loop().sampling_period;
  std::vector<double> frequencies;
  const int even = even_frequencies * (1 + static_cast<int>(device.loop().delay / period));
  for (int i = 1; i <= even; ++i) frequencies.push_back(nyquist * i / even);
  for (double angle = pi / even; angle > least_grid_angle;
       angle *= std::pow(10.0, -1.0 / grid_frequencies_per_decade)) {
    frequencies.push_back(angle / period);
  }
  discs.add_modes(frequencies);
  for (const Crossover& each : nobody.crossovers) {
    for (double share = 1e-5; share < 0.5; share *= 4.0) {
      frequencies.push_back(each.frequency * (1.0 - share));
      frequencies.push_back(each.frequency * (1.0 + share));
    }
    frequencies.push_back(each.frequency);
  }
  std::erase_if(frequencies, [&](double each) { return !(each >= least_grid_angle / period && each <= nyquist); });
  std::ranges::sort(frequencies);
  return frequencies;
}

}  // namespace

bool knows_all_users(const Loop& loop) { return whole_periods_later(loop).has_value(); }

std::optional<AbsoluteStabilityLimit> any_user_limit(const Device& device, const Progress& progress) {
  if (!has_damper_loop(device.loop())) return absolute_stability_limit(device, virtual_damper(device), progress);
  if (device.parameters().wall.damping == 0.0) return any_user_limit(with_one_rate(device), progress);
  // What a grasp does is known of one rate alone.
  if (!knows_all_users(device.loop()) || device.parameters().mechanism) return std::nullopt;
  tell(progress, 0.0);
  const CriticalStiffness nobody = critical_stiffness(device_without_user(device));
  if (nobody.trust.refused()) {
    AbsoluteStabilityLimit refused;
    refused.stiffness = std::numeric_limits<double>::quiet_NaN();
    refused.trust = nobody.trust;
    return refused;
  }
  return two_rate_absolute_stability(device, nobody);
}

AbsoluteStabilityLimit known_any_user_limit(const Device& device, const Progress& progress) {
  std::optional<AbsoluteStabilityLimit> limit = any_user_limit(device, progress);
  if (!limit) require_one_rate(device);
  return *std::move(limit);
}

std::optional<AbsoluteStabilityLimit> two_rate_absolute_stability(const Device& device,
                                                                  const CriticalStiffness& nobody) {
  if (!knows_all_users(device.loop())) return std::nullopt;
  AbsoluteStabilityLimit limit;
  limit.trust = nobody.trust;
  const Device free = device_without_user(device);
  const TwoRateDiscs discs(free);
  if (discs.is_undamped() || nobody.stiffness == 0.0) return limit;
  const VirtualDamper damper{free.parameters().wall.damping, free.parameters().wall.velocity_filter_hz};
  const std::vector<double> frequencies = frequency_grid(discs, free, nobody);
  std::vector<double> limits;
  for (const double each : frequencies) limits.push_back(discs.quick_limit_at(each, damper));
  double least = std::numeric_limits<double>::infinity();
  const auto take = [&](double frequency, double stiffness) {
    if (!(stiffness < least)) return;
    least = stiffness;
    limit.frequency = frequency;
  };
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    take(frequencies[i], limits[i]);
    const double before = i > 0 ? limits[i - 1] : std::numeric_limits<double>::infinity();
    const double after = i + 1 < limits.size() ? limits[i + 1] : std::numeric_limits<double>::infinity();
    if (!(limits[i] > 0.0) || limits[i] > before || limits[i] > after) continue;
    // Towards zero the limit is constant, and rounding swings.
    if (std::max(before, after) <= limits[i] * (1.0 + flat_minimum)) continue;
    std::uintmax_t most_steps = 100;
    const auto [at, compliance] = boost::math::tools::brent_find_minima(
        [&](double frequency) { return -1.0 / discs.quick_limit_at(frequency, damper); },
        frequencies[i > 0 ? i - 1 : 0], frequencies[std::min(i + 1, frequencies.size() - 1)], bits_of_minimum,
        most_steps);
    take(at, -1.0 / compliance);
  }
  if (std::isfinite(least) && least > 0.0) least = discs.limit_at(limit.frequency, damper);
  if (limits.front() <= least * (1.0 + same_as_at_zero)) limit.frequency = 0.0;
  limit.needs_no_user = nobody.stiffness <= least;
  limit.stiffness = std::min(least, nobody.stiffness);
  if (limit.needs_no_user && nobody.limit) limit.frequency = nobody.limit->frequency;
  if (limit.stiffness == 0.0 || std::isinf(limit.stiffness)) limit.frequency = 0.0;
  return limit;
}

double two_rate_limit_at(const Device& device, double angle) {
  const TwoRateDiscs discs(device_without_user(device), false);
  if (discs.is_undamped()) return 0.0;
  const Wall& wall = device.parameters().wall;
  return discs.limit_at(std::min(angle / device.loop().sampling_period, discs.nyquist()),
                        {wall.damping, wall.velocity_filter_hz});
}

struct TwoRateUsers::Grid {
  TwoRateDiscs discs;
  std::vector<TwoRateDiscs::Aliases> aliases;  // by frequency

  explicit Grid(const Device& free) : discs(free) {
    if (discs.is_undamped()) return;
    for (const double each : frequency_grid(discs, free, {})) aliases.push_back(discs.aliases_at(each));
  }
};

TwoRateUsers::TwoRateUsers(const Device& device) : grid_(std::make_unique<Grid>(device_without_user(device))) {}
TwoRateUsers::TwoRateUsers(TwoRateUsers&&) noexcept = default;
TwoRateUsers& TwoRateUsers::operator=(TwoRateUsers&&) noexcept = default;
TwoRateUsers::~TwoRateUsers() = default;

double TwoRateUsers::limit_on_grid(VirtualDamper damper) const {
  if (grid_->discs.is_undamped()) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const TwoRateDiscs::Aliases& each : grid_->aliases) {
    least = std::min(least, grid_->discs.limit_of_aliases(each, damper));
    if (!(least > 0.0)) return 0.0;
  }
  return least;
}

double TwoRateUsers::limit_at(double frequency, VirtualDamper damper) const {
  return grid_->discs.is_undamped() ? 0.0 : grid_->discs.limit_at(frequency, damper);
}

}  // namespace zwidth::internal

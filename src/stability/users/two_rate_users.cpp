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
#include "stability/users/any_user_limit.hpp"
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
// Between neighbours a parabola falls by an eighth of what they differ by.
constexpr double flat_minimum = 1e-8;  // relative, of neighbours that are a minimum
constexpr double deepest_fall = 1.0;   // of that difference: what falls more slowly to above the least is not refined
// Beside nobody's crossovers a limit may fall between the grid's frequencies, to little below what it is there.
constexpr double nearest_to_crossover = 1e-5;  // relative
constexpr double far_above = 4.0;              // times the least of the grid: no frequencies beside that crossover
constexpr double same_as_at_zero = 1e-9;       // relative: the frequency is then 0

// The device with the damper's period and the spring's delay.
Device with_delay_of_spring(const Device& device) {
  DeviceParameters parameters = with_loop_of_damper(device).parameters();
  parameters.loop.delay = device.loop().delay;
  return Device(std::move(parameters));
}

}  // namespace

class TwoRateDiscs {
 public:
  // `free`: of a loop that bounds_all_users().
  explicit TwoRateDiscs(const Device& free, bool is_quick = true)
      : discs_(with_loop_of_damper(free)),
        period_(free.loop().sampling_period),
        fast_period_(damper_timing(free.loop()).sampling_period),
        steps_(static_cast<int>(periods_within(period_, fast_period_))),
        fast_delay_(damper_timing(free.loop()).delay),
        periods_later_(damper_periods_later(free.loop()).value()) {
    if (discs_.is_undamped()) return;
    if (is_quick) pieces_ = DiscPieces(discs_, with_loop_of_damper(free));
    if (periods_later_ == std::round(periods_later_)) return;
    const Device later = with_delay_of_spring(free);
    discs_of_spring_.emplace(later);
    if (is_quick) pieces_of_spring_ = DiscPieces(*discs_of_spring_, later);
  }
  TwoRateDiscs(const TwoRateDiscs&) = delete;
  TwoRateDiscs& operator=(const TwoRateDiscs&) = delete;

  [[nodiscard]] bool is_undamped() const { return discs_.is_undamped(); }
  [[nodiscard]] double nyquist() const { return pi / period_; }

  // The least K that the disc of the plant that the spring sees does not allow; 0 where the damper alone is not stable with
  // every user. 0 < frequency <= nyquist().
  [[nodiscard]] double limit_at(double frequency, VirtualDamper damper) const {
    const auto disc_of = [](const TerminationDiscs& discs, const DiscPieces&, double at) {
      return discs.scaled_at({0.0, at});
    };
    const DamperResponse gains(damper, fast_period_);
    return limit_of([&](int alias) {
      Alias seen = alias_of(frequency, alias, disc_of);
      if (discs_of_spring_) set_apart(disc_of, seen);
      return closed(seen, gains);
    });
  }
  // One frequency of the damper's band as the spring's samples show it, before the damper is closed.
  struct Alias {
    TerminationDiscs::Disc disc;  // scaled
    double frequency = 0.0;       // rad/s, without its sign
    bool is_negative = false;
    double gain = 0.0;                // |(1 - z^-N)/(1 - z^-1)|/N
    std::complex<double> phase;       // e^j of its angle and that of z^-m
    std::complex<double> difference;  // 1 - z^-1
    // What the spring's plant is apart from the damper's, z^m p_s - p: of the aliases beyond the damper's rate.
    std::complex<double> apart_centre;
    double apart_radius = 0.0;
  };
  using Aliases = std::vector<Alias>;
  // By interpolated sums over aliases beyond the damper's rate, which `is_quick` prepares.
  [[nodiscard]] Aliases aliases_at(double frequency) const {
    Aliases all;
    for (int alias = least_alias(); alias <= steps_ / 2; ++alias) {
      all.push_back(alias_of(frequency, alias, quick_disc));
      if (discs_of_spring_) set_apart(quick_disc, all.back());
    }
    return all;
  }
  [[nodiscard]] double limit_of_aliases(const Aliases& aliases, VirtualDamper damper) const {
    const DamperResponse gains(damper, fast_period_);
    return limit_of([&](int alias) { return closed(aliases[static_cast<std::size_t>(alias - least_alias())], gains); });
  }
  // At a frequency that share of the way between two of such aliases; what is apart is interpolated.
  [[nodiscard]] double limit_between(double frequency, const Aliases& before, const Aliases& after, double share,
                                     VirtualDamper damper) const {
    const DamperResponse gains(damper, fast_period_);
    return limit_of([&](int alias) {
      Alias seen = alias_of(frequency, alias, quick_disc);
      if (discs_of_spring_) {
        const auto i = static_cast<std::size_t>(alias - least_alias());
        seen.apart_centre = (1.0 - share) * before[i].apart_centre + share * after[i].apart_centre;
        seen.apart_radius = std::lerp(before[i].apart_radius, after[i].apart_radius, share);
      }
      return closed(seen, gains);
    });
  }

  // The dampers that some user destabilises there without any spring: D <= 0, a range of B.
  void add_excluded(const Aliases& aliases, double velocity_filter_hz, std::vector<StableInterval>& excluded) const {
    const DamperResponse velocity({1.0, velocity_filter_hz}, fast_period_);
    for (const Alias& each : aliases) {
      const std::complex<double> unit = velocity.at(each.difference);
      const double half = (unit * each.disc.centre).real();
      const double quadratic = std::norm(unit) * each.disc.power;
      const double first = least_root(each.disc.one, half, quadratic);
      if (std::isinf(first)) continue;
      // The product of the roots is constant/quadratic.
      excluded.push_back({first, std::nullopt});
      if (quadratic > 0.0 && first > 0.0) excluded.back().upper = each.disc.one / (quadratic * first);
    }
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

  static TerminationDiscs::Disc quick_disc(const TerminationDiscs&, const DiscPieces& pieces, double at) {
    return pieces.at({0.0, at});
  }

  // `disc_of`: scaled, at a frequency of the damper's band.
  template <typename DiscOf>
  [[nodiscard]] Alias alias_of(double frequency, int alias, const DiscOf& disc_of) const {
    double at = frequency + 2.0 * pi * alias / period_;
    const double fast_nyquist = pi / fast_period_;
    if (at > fast_nyquist) at -= 2.0 * fast_nyquist;
    Alias seen;
    seen.frequency = std::min(std::abs(at), fast_nyquist);
    seen.is_negative = at < 0.0;
    seen.disc = disc_of(discs_, pieces_, seen.frequency);
    const double angle = seen.frequency * fast_period_;
    const double sum = std::sin(0.5 * angle * steps_) / std::sin(0.5 * angle);
    seen.gain = std::abs(sum) / steps_;
    seen.difference = backward_difference(angle);
    seen.phase = (sum < 0.0 ? -1.0 : 1.0) * std::polar(1.0, -angle * (0.5 * (steps_ - 1) + periods_later_));
    return seen;
  }

  // With m no whole number, alias k of the damper's rate turns by e^{-j 2 pi k m} in the spring's plant; the difference from
  // z^-m p is bounded as if its user were another one:
  //
  //     centre z^m c_s - c,   radius <= sum_k |e^{-j 2 pi k m} - 1| r_k <= 2 |sin(pi m)| (r_1 + r_-1) + 2 (r - r_0 - r_1 - r_-1)
  template <typename DiscOf>
  void set_apart(const DiscOf& disc_of, Alias& seen) const {
    const double at = seen.frequency;
    const double angle = at * fast_period_;
    const auto radius_of = [&](int k) { return discs_.alias(at, k, 0.0).radius; };
    const double next = radius_of(1) + radius_of(-1);
    double others = 0.0;
    if (angle < clear_angle && discs_.sharp_images().empty()) {
      // What both have in common grows without bound towards zero; the sums over the other aliases leave it out.
      const TerminationDiscs::OtherAliases of_damper = discs_.other_aliases(at);
      const std::complex<double> hold =
          2.0 * std::sin(0.5 * angle) / fast_period_ * std::polar(1.0, 0.5 * (pi - angle) - at * fast_delay_);
      seen.apart_centre = hold * (discs_of_spring_->other_aliases(at).centre - of_damper.centre);
      others = std::abs(hold) * of_damper.radius - next;
    } else {
      const TerminationDiscs::Disc of_spring = disc_of(*discs_of_spring_, pieces_of_spring_, at);
      seen.apart_centre =
          std::polar(1.0, angle * periods_later_) * of_spring.centre / of_spring.one - seen.disc.centre / seen.disc.one;
      others = seen.disc.radius / seen.disc.one - radius_of(0) - next;
    }
    seen.apart_radius = 2.0 * (std::abs(std::sin(pi * periods_later_)) * next + std::max(others, 0.0));
  }

  [[nodiscard]] Part closed(const Alias& seen, const DamperResponse& gains) const {
    const TerminationDiscs::Disc& disc = seen.disc;
    if (!std::isfinite(disc.radius)) return {};
    const std::complex<double> damper = gains.at(seen.difference);
    const double divisor = disc.one + 2.0 * (damper * disc.centre).real() + std::norm(damper) * disc.power;
    if (!(divisor > 0.0)) return {};
    std::complex<double> centre = seen.gain * seen.phase * (disc.centre + std::conj(damper) * disc.power) / divisor;
    if (seen.is_negative) centre = std::conj(centre);
    Part part{centre, seen.gain * disc.radius / divisor, seen.gain * seen.gain * disc.power / divisor};
    if (discs_of_spring_) set_apart(seen, damper, divisor, part);
    return part;
  }

  // (p + e)/(1 + g p) with an e of its own: centre + e_c conj(1 + g c)/D, radius ((|1 - g e_c| + |g| e_r) r + e_r |1 + g c|)/D.
  static void set_apart(const Alias& seen, std::complex<double> damper, double divisor, Part& part) {
    const std::complex<double> opened = seen.disc.one + damper * seen.disc.centre;
    const std::complex<double> turned = damper * seen.apart_centre;
    const double longer = (std::norm(turned) - 2.0 * turned.real()) / (std::abs(1.0 - turned) + 1.0);
    std::complex<double> moved = seen.gain * seen.phase * seen.apart_centre * std::conj(opened) / divisor;
    if (seen.is_negative) moved = std::conj(moved);
    const double wider =
        seen.gain *
        ((longer + std::abs(damper) * seen.apart_radius) * seen.disc.radius + seen.apart_radius * std::abs(opened)) /
        divisor;
    part.power +=
        2.0 * (std::conj(part.centre) * moved).real() + std::norm(moved) - 2.0 * part.radius * wider - wider * wider;
    part.centre += moved;
    part.radius += wider;
    if (!std::isfinite(part.power)) part.radius = -1.0;
  }

  TerminationDiscs discs_;  // at the damper's rate and delay
  DiscPieces pieces_;
  std::optional<TerminationDiscs>
      discs_of_spring_;  // at the damper's rate and the spring's delay, where m is no whole number
  DiscPieces pieces_of_spring_;
  double period_;
  double fast_period_;
  int steps_;
  double fast_delay_;
  double periods_later_;  // m
};

namespace {

bool is_in_band(double frequency, double period) {
  return frequency >= least_grid_angle / period && frequency <= pi / period;
}

std::vector<double> frequency_grid(const TwoRateDiscs& discs, const Device& device) {
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
  std::erase_if(frequencies, [&](double each) { return !is_in_band(each, period); });
  std::ranges::sort(frequencies);
  return frequencies;
}

}  // namespace

std::optional<AbsoluteStabilityLimit> two_rate_absolute_stability(const Device& device,
                                                                  const CriticalStiffness& nobody) {
  if (!bounds_all_users(device)) return std::nullopt;
  const Wall& wall = device.parameters().wall;
  return TwoRateUsers(device).limit({wall.damping, wall.velocity_filter_hz}, nobody);
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
  double period;
  std::vector<double> frequencies;
  std::vector<TwoRateDiscs::Aliases> aliases;  // by frequency

  explicit Grid(const Device& free) : discs(free), period(free.loop().sampling_period) {
    if (discs.is_undamped()) return;
    frequencies = frequency_grid(discs, free);
    for (const double each : frequencies) aliases.push_back(discs.aliases_at(each));
  }

  // The least K at a frequency; those of the grid, and among them some beside nobody's crossovers.
  struct Sample {
    double frequency = 0.0;
    double stiffness = 0.0;
  };
  [[nodiscard]] std::vector<Sample> samples(VirtualDamper damper, const CriticalStiffness& nobody) const {
    std::vector<Sample> all;
    all.reserve(2 * frequencies.size());
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      all.push_back({frequencies[i], discs.limit_of_aliases(aliases[i], damper)});
      least = std::min(least, all.back().stiffness);
    }
    const auto add = [&](double frequency) {
      if (!is_in_band(frequency, period)) return least;
      all.push_back({frequency, limit_at(frequency, damper)});
      return all.back().stiffness;
    };
    for (const Crossover& each : nobody.crossovers) {
      if (add(each.frequency) > far_above * least) continue;
      for (double share = nearest_to_crossover; share < 0.5; share *= 4.0) {
        (void)add(each.frequency * (1.0 - share));
        (void)add(each.frequency * (1.0 + share));
      }
    }
    std::ranges::sort(all, {}, &Sample::frequency);
    return all;
  }

  [[nodiscard]] double limit_at(double frequency, VirtualDamper damper) const {
    const auto place = std::ranges::lower_bound(frequencies, frequency);
    const auto after = std::min(static_cast<std::size_t>(place - frequencies.begin()), frequencies.size() - 1);
    const std::size_t before = after > 0 ? after - 1 : 0;
    const double width = frequencies[after] - frequencies[before];
    const double share = width > 0.0 ? std::clamp((frequency - frequencies[before]) / width, 0.0, 1.0) : 0.0;
    return discs.limit_between(frequency, aliases[before], aliases[after], share, damper);
  }
};

TwoRateUsers::TwoRateUsers(const Device& device) : grid_(std::make_unique<Grid>(device_without_user(device))) {}
TwoRateUsers::TwoRateUsers(TwoRateUsers&&) noexcept = default;
TwoRateUsers& TwoRateUsers::operator=(TwoRateUsers&&) noexcept = default;
TwoRateUsers::~TwoRateUsers() = default;

AbsoluteStabilityLimit TwoRateUsers::limit(VirtualDamper damper, const CriticalStiffness& nobody) const {
  AbsoluteStabilityLimit limit;
  limit.trust = nobody.trust;
  const TwoRateDiscs& discs = grid_->discs;
  if (discs.is_undamped() || nobody.stiffness == 0.0) return limit;
  const std::vector<Grid::Sample> samples = grid_->samples(damper, nobody);
  double least = std::numeric_limits<double>::infinity();
  const auto take = [&](double frequency, double stiffness) {
    if (!(stiffness < least)) return;
    least = stiffness;
    limit.frequency = frequency;
  };
  for (const Grid::Sample& each : samples) take(each.frequency, each.stiffness);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double here = samples[i].stiffness;
    const double before = i > 0 ? samples[i - 1].stiffness : std::numeric_limits<double>::infinity();
    const double after = i + 1 < samples.size() ? samples[i + 1].stiffness : std::numeric_limits<double>::infinity();
    if (!(here > 0.0) || here > before || here > after) continue;
    // Towards zero the limit is constant, and rounding swings.
    const double highest = std::max(before, after);
    if (highest <= here * (1.0 + flat_minimum) || here - deepest_fall * (highest - here) > least) continue;
    std::uintmax_t most_steps = 100;
    const auto [at, compliance] = boost::math::tools::brent_find_minima(
        [&](double frequency) { return -1.0 / grid_->limit_at(frequency, damper); },
        samples[i > 0 ? i - 1 : 0].frequency, samples[std::min(i + 1, samples.size() - 1)].frequency, bits_of_minimum,
        most_steps);
    take(at, -1.0 / compliance);
  }
  if (std::isfinite(least) && least > 0.0) least = discs.limit_at(limit.frequency, damper);
  if (samples.front().stiffness <= least * (1.0 + same_as_at_zero)) limit.frequency = 0.0;
  limit.needs_no_user = nobody.stiffness <= least;
  limit.stiffness = std::min(least, nobody.stiffness);
  if (limit.needs_no_user && nobody.limit) limit.frequency = nobody.limit->frequency;
  if (limit.stiffness == 0.0 || std::isinf(limit.stiffness)) limit.frequency = 0.0;
  return limit;
}

std::vector<double> TwoRateUsers::ends_of_damper(double velocity_filter_hz) const {
  std::vector<StableInterval> excluded;
  for (const TwoRateDiscs::Aliases& each : grid_->aliases)
    grid_->discs.add_excluded(each, velocity_filter_hz, excluded);
  std::ranges::sort(excluded, {}, &StableInterval::lower);
  std::vector<double> ends;
  double covered = 0.0;
  for (const StableInterval& each : excluded) {
    if (ends.empty() || each.lower > covered) {
      if (!ends.empty()) ends.push_back(covered);
      ends.push_back(each.lower);
      covered = each.lower;
    }
    covered = std::max(covered, each.upper.value_or(std::numeric_limits<double>::infinity()));
  }
  if (!ends.empty() && std::isfinite(covered)) ends.push_back(covered);
  return ends;
}

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

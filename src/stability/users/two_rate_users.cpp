#include "stability/users/two_rate_users.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "model/one_rate.hpp"
#include "stability/users/disc_pieces.hpp"
#include "stability/users/disc_stiffness.hpp"
#include "stability/users/termination_discs.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;

constexpr int even_looks = 128;       // in the band of the spring's rate, and as many for each of its periods of delay
constexpr double least_look = 1e-7;   // rad per period of the spring
constexpr int looks_per_decade = 24;  // towards zero
constexpr int bits_of_minimum = 40;
constexpr double same_as_at_zero = 1e-9;  // relative: the limit towards w = 0 is named rather than another frequency
constexpr double whole_within = 1e-6;     // periods of the damper, of the difference of the delays

class TwoRateDiscs {
 public:
  TwoRateDiscs(const Device& free, double whole)
      : discs_(with_loop_of_damper(free)),
        damper_{free.parameters().wall.damping, free.parameters().wall.velocity_filter_hz},
        period_(free.loop().sampling_period),
        fast_period_(damper_timing(free.loop()).sampling_period),
        steps_(static_cast<int>(std::lround(rate_ratio(period_, fast_period_)))),
        whole_(whole) {
    if (!discs_.is_undamped()) pieces_ = DiscPieces(discs_, with_loop_of_damper(free));
  }
  TwoRateDiscs(const TwoRateDiscs&) = delete;
  TwoRateDiscs& operator=(const TwoRateDiscs&) = delete;

  [[nodiscard]] bool is_undamped() const { return discs_.is_undamped(); }
  [[nodiscard]] double nyquist() const { return pi / period_; }

  // The least K that the disc of the plant that the spring sees does not allow; 0 where the damper alone is not stable with
  // every user. 0 < frequency <= nyquist().
  [[nodiscard]] double limit_at(double frequency) const {
    return limit_of([&](int alias) {
      return part(frequency, alias, [&](double at) { return discs_.scaled_at({0.0, at}); });
    });
  }
  // The same by interpolated sums over aliases beyond the damper's rate.
  [[nodiscard]] double quick_limit_at(double frequency) const {
    return limit_of([&](int alias) {
      return part(frequency, alias, [&](double at) { return pieces_.at({0.0, at}); });
    });
  }

  // Of the held device, as they appear in the spring's band.
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

  template <typename PartOf>
  [[nodiscard]] double limit_of(const PartOf& part_of) const {
    const Part own = part_of(0);
    if (!(own.radius >= 0.0)) return 0.0;
    std::complex<double> centre;
    double radius = 0.0;
    for (int alias = -(steps_ - 1) / 2; alias <= steps_ / 2; ++alias) {
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

  // `disc_at`: scaled, at a frequency of the damper's band.
  template <typename DiscAt>
  [[nodiscard]] Part part(double frequency, int alias, const DiscAt& disc_at) const {
    double at = frequency + 2.0 * pi * alias / period_;
    const double fast_nyquist = pi / fast_period_;
    if (at > fast_nyquist) at -= 2.0 * fast_nyquist;
    const double positive = std::min(std::abs(at), fast_nyquist);
    const TerminationDiscs::Disc disc = disc_at(positive);
    if (!std::isfinite(disc.radius)) return {};
    const std::complex<double> damper = damper_response(damper_, fast_period_, positive);
    const double divisor = disc.one + 2.0 * (damper * disc.centre).real() + std::norm(damper) * disc.power;
    if (!(divisor > 0.0)) return {};
    // (1 - z^-N)/(1 - z^-1) z^-m / N
    const double angle = positive * fast_period_;
    const double share = std::abs(std::sin(0.5 * angle * steps_) / std::sin(0.5 * angle)) / steps_;
    const double sign = std::sin(0.5 * angle * steps_) / std::sin(0.5 * angle) < 0.0 ? -1.0 : 1.0;
    const std::complex<double> turn = sign * std::polar(1.0, -angle * (0.5 * (steps_ - 1) + whole_));
    std::complex<double> centre = share * turn * (disc.centre + std::conj(damper) * disc.power) / divisor;
    if (at < 0.0) centre = std::conj(centre);
    return {centre, share * disc.radius / divisor, share * share * disc.power / divisor};
  }

  TerminationDiscs discs_;
  DiscPieces pieces_;
  VirtualDamper damper_;
  double period_;
  double fast_period_;
  int steps_;
  double whole_;
};

std::vector<double> frequencies_to_look_at(const TwoRateDiscs& discs, const Device& device,
                                           const CriticalStiffness& nobody) {
  const double nyquist = discs.nyquist();
  const double period = device.loop().sampling_period;
  std::vector<double> frequencies;
  const int even = even_looks * (1 + static_cast<int>(device.loop().delay / period));
  for (int i = 1; i <= even; ++i) frequencies.push_back(nyquist * i / even);
  for (double angle = pi / even; angle > least_look; angle *= std::pow(10.0, -1.0 / looks_per_decade)) {
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
  std::erase_if(frequencies, [&](double each) { return !(each >= least_look / period && each <= nyquist); });
  std::ranges::sort(frequencies);
  return frequencies;
}

}  // namespace

std::optional<AbsoluteStabilityLimit> two_rate_absolute_stability(const Device& device,
                                                                  const CriticalStiffness& nobody) {
  const auto [period, delay] = damper_timing(device.loop());
  const double apart = (device.loop().delay - delay) / period;
  if (rate_ratio(device.loop().sampling_period, period) < 1.0) return std::nullopt;
  if (!(std::abs(apart - std::round(apart)) <= whole_within)) return std::nullopt;
  AbsoluteStabilityLimit limit;
  limit.trust = nobody.trust;
  const Device free = device_without_user(device);
  const TwoRateDiscs discs(free, std::round(apart));
  if (discs.is_undamped() || nobody.stiffness == 0.0) return limit;
  const std::vector<double> frequencies = frequencies_to_look_at(discs, free, nobody);
  std::vector<double> limits;
  for (const double each : frequencies) limits.push_back(discs.quick_limit_at(each));
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
    std::uintmax_t most_steps = 100;
    const auto [at, compliance] = boost::math::tools::brent_find_minima(
        [&](double frequency) { return -1.0 / discs.quick_limit_at(frequency); }, frequencies[i > 0 ? i - 1 : 0],
        frequencies[std::min(i + 1, frequencies.size() - 1)], bits_of_minimum, most_steps);
    take(at, -1.0 / compliance);
  }
  if (std::isfinite(least) && least > 0.0) least = discs.limit_at(limit.frequency);
  if (limits.front() <= least * (1.0 + same_as_at_zero)) limit.frequency = 0.0;
  limit.needs_no_user = nobody.stiffness <= least;
  limit.stiffness = std::min(least, nobody.stiffness);
  if (limit.needs_no_user && nobody.limit) limit.frequency = nobody.limit->frequency;
  if (limit.stiffness == 0.0 || std::isinf(limit.stiffness)) limit.frequency = 0.0;
  return limit;
}

}  // namespace zwidth::internal

#include "design/synthesis/margin_wall.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "infinity.hpp"
#include "model/known_structure.hpp"
#include "stability/loop/damper_response.hpp"
#include "stability/margins/loops_of_stiffness.hpp"
#include "stability/users/disc_stiffness.hpp"
#include "stability/users/user_discs.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;

constexpr int points_per_decade = 60;
constexpr std::size_t angles_per_report = 64;  // of progress
constexpr double lowest_angle = 1e-6;
constexpr int points_near_nyquist = 60;  // evenly, over the upper half
// Around a resonance of damping ratio zeta, in units of its half width zeta w.
constexpr std::array offsets{0.0, 0.3, 0.6, 1.0, 1.5, 2.2, 3.2, 4.6, 6.6, 10.0, 15.0, 25.0, 40.0};
constexpr double narrowest_half_width = 1e-5;  // of an undamped mode, relative

// The walk from a stiffness whose margins fail to one that keeps them, and back by bisection.
constexpr double step_down = 0.8;
constexpr int most_steps = 120;
constexpr std::uintmax_t most_evaluations = 60;
constexpr int bisections_on_grid = 8;
constexpr double resolved = 1e-9;  // relative, of the stiffest wall
constexpr double rounding = 1e-9;  // of margins that stand exactly at what is required
constexpr double certain = 1e-7;   // relative, by which margins seen on a grid fall short where they certainly do

// Without the care for infinities that a quotient of complex numbers takes.
std::complex<double> reciprocal(std::complex<double> a) { return std::conj(a) / std::norm(a); }

bool loop_keeps(const LoopsOfStiffness& loops, double stiffness, const RequiredMargins& margins) {
  return loops.slack(stiffness, margins.gain, margins.phase) >= -rounding;
}

// Between a stiffness that keeps the margins and one that does not.
template <typename Slack>
std::pair<double, double> last_between(const Slack& slack, double keeps, double fails) {
  std::uintmax_t evaluations = most_evaluations;
  const auto resolved_enough = [](double a, double b) { return std::abs(b - a) <= resolved * std::abs(b); };
  return boost::math::tools::toms748_solve(slack, keeps, fails, resolved_enough, evaluations);
}

double last_that_keeps(const LoopsOfStiffness& loops, const SeenCrossings* seen, const RequiredMargins& margins,
                       double keeps, double fails, const Progress& progress) {
  const auto slack_of = [&](const auto& loop) {
    return [&](double stiffness) {
      tell(progress, 0.0);
      return std::min(loop.slack(stiffness, margins.gain, margins.phase) + rounding, 1.0);
    };
  };
  if (seen != nullptr) {  // mostly the same place: then one look at every crossing is enough
    const auto slack = slack_of(*seen);
    if (slack(keeps) >= 0.0 && slack(fails) < 0.0) {
      const double softer = last_between(slack, keeps, fails).first;
      if (loop_keeps(loops, softer, margins)) return softer;
      if (softer > keeps) fails = softer;
    }
  }
  const auto slack = slack_of(loops);
  const auto [low, high] = last_between(slack, keeps, fails);
  return slack(high) >= 0.0 ? high : slack(low) >= 0.0 ? low : keeps;
}

void add_resonances(const Device& device, std::vector<double>& angles) {
  const double period = device.loop().sampling_period;
  const ModalForm form = modal_form(device);
  std::vector<Mode> modes = form.modes;
  if (form.suspended_rigid_body) modes.push_back(*form.suspended_rigid_body);
  for (const Mode& mode : modes) {
    const double half_width = std::max(mode.damping_ratio, narrowest_half_width) * mode.frequency * period;
    for (const double offset : offsets) {
      for (const double sign : {-1.0, 1.0}) {
        const double seen = std::abs(std::remainder(mode.frequency * period + sign * offset * half_width, 2.0 * pi));
        if (seen > lowest_angle) angles.push_back(seen);
      }
    }
  }
}

std::vector<double> grid_of(const Device& device) {
  std::vector<double> angles;
  const int decades = static_cast<int>(std::ceil(std::log10(pi / lowest_angle)));
  const int below = decades * points_per_decade;
  angles.reserve(static_cast<std::size_t>(below) + static_cast<std::size_t>(points_near_nyquist));
  for (int i = 0; i < below; ++i) {
    angles.push_back(pi * std::pow(10.0, -static_cast<double>(i) / points_per_decade));
  }
  for (int i = 0; i < points_near_nyquist; ++i) {
    angles.push_back(pi * (1.0 - 0.5 * static_cast<double>(i) / points_near_nyquist));
  }
  add_resonances(device, angles);
  std::ranges::sort(angles);
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

// The least K > 0 of the loop 1 + gain (K + B v) P at a phase crossover, linear between the grid's points.
class LeastCrossover {
 public:
  explicit LeastCrossover(double gain) : gain_(gain) {}

  void add(std::complex<double> minus_one_over_plant, std::complex<double> damper) {
    const std::complex<double> required = minus_one_over_plant / gain_ - damper;  // K, where it is real
    if (seen_ && (required.imag() < 0.0) != (last_.imag() < 0.0)) {
      const double share = last_.imag() / (last_.imag() - required.imag());
      const double stiffness = last_.real() + share * (required.real() - last_.real());
      if (stiffness > 0.0) least_ = std::min(least_, stiffness);
    }
    last_ = required;
    seen_ = true;
  }
  void add_nyquist(double minus_one_over_plant, double damper) {
    const double stiffness = minus_one_over_plant / gain_ - damper;
    if (stiffness > 0.0) least_ = std::min(least_, stiffness);
  }
  [[nodiscard]] double value() const { return least_; }

 private:
  double gain_;
  bool seen_ = false;
  std::complex<double> last_;
  double least_ = infinity;
};

// K > 0 with |K + damper| |plant| = 1, and whether the loop's phase is then within `phase` of -1.
std::optional<double> short_of_phase(std::complex<double> minus_one_over_plant, std::complex<double> damper,
                                     double cosine) {
  const double rest = std::norm(minus_one_over_plant) - damper.imag() * damper.imag();
  if (!(rest > 0.0)) return std::nullopt;
  const double stiffness = std::sqrt(rest) - damper.real();
  if (!(stiffness > 0.0)) return std::nullopt;
  // -L = (K + damper) / (-1/P): its angle is the distance to -1
  const std::complex<double> turned = (stiffness + damper) / minus_one_over_plant;
  return turned.real() > cosine * std::abs(turned) ? std::optional(stiffness) : std::nullopt;
}

}  // namespace

std::optional<OptionProblem> find_problem(const RequiredMargins& margins) {
  constexpr double most_gain = 1e5;  // 100 dB
  if (!(margins.gain >= 1.0 && margins.gain <= most_gain)) {
    return option_problem("gain_margin",
                          {.code = ProblemCode::gain_margin_out_of_range,
                           .evidence = {{"decibels", 20.0 * std::log10(margins.gain)}, {"factor", margins.gain}}});
  }
  if (!(margins.phase >= 0.0 && margins.phase <= 0.5 * std::numbers::pi)) {
    return option_problem("phase_margin", {.code = ProblemCode::phase_margin_out_of_range,
                                           .evidence = {{"degrees", degrees(margins.phase)}}});
  }
  return std::nullopt;
}

double stiffest_wall(const Device& device, const RequiredMargins& margins) {
  require_known_structure(device);
  require_one_rate(device);
  const VirtualDamper damper = virtual_damper(device);
  StiffnessRange range;
  if (margins.any_user) range.at_most = absolute_stability_limit(device, damper).lower_bound() / margins.gain;
  return range.at_most > 0.0 ? stiffest_wall(filtered_plant(device), damper, margins, range) : 0.0;
}

double stiffest_wall(const FilteredPlant& plant, VirtualDamper damper, const RequiredMargins& margins,
                     const StiffnessRange& range, const Progress& progress, const SeenCrossings* seen) {
  const auto seen_to_fail = [&](double stiffness) {
    return seen != nullptr && seen->slack(stiffness, margins.gain, margins.phase) < -certain;
  };
  if (range.at_least > 0.0 && seen != nullptr &&
      (seen_to_fail(range.at_least) || seen->limit() * (1.0 + certain) <= margins.gain * range.at_least)) {
    return 0.0;
  }
  const LoopsOfStiffness loops(plant, damper);
  const double limit = critical_stiffness_of(plant, loops.crossings()).stiffness;
  const double top = std::min(limit / margins.gain, range.at_most);
  if (!(top > range.at_least)) return 0.0;
  if (!std::isfinite(top)) return margins.phase == 0.0 ? infinity : 0.0;  // no stiffness to begin the walk at
  // Nothing more is asked: the boundary itself.
  if (margins.phase == 0.0 && (damper.damping == 0.0 || margins.gain == 1.0)) return top;
  const auto keeps = [&](double stiffness) {
    return !seen_to_fail(stiffness) && loop_keeps(loops, stiffness, margins);
  };
  double high = top * (1.0 - rounding);
  if (keeps(high)) return high;
  if (range.at_least > 0.0) {
    return loop_keeps(loops, range.at_least, margins)
               ? last_that_keeps(loops, seen, margins, range.at_least, high, progress)
               : 0.0;
  }
  for (int i = 0; i < most_steps; ++i) {
    tell(progress, 0.0);
    const double low = step_down * high;
    if (keeps(low)) return last_that_keeps(loops, seen, margins, low, high, progress);
    high = low;
  }
  return 0.0;
}

bool keeps_margins(const Device& device, double stiffness, const RequiredMargins& margins) {
  require_known_structure(device);
  require_one_rate(device);
  const FilteredPlant plant = filtered_plant(device);
  const VirtualDamper damper = virtual_damper(device);
  const LoopsOfStiffness loops(plant, damper);
  const double grown = stiffness * margins.gain;
  return loop_keeps(loops, stiffness, margins) && grown < critical_stiffness_of(plant, loops.crossings()).stiffness &&
         (!margins.any_user || grown < absolute_stability_limit(device, damper).lower_bound());
}

LoopGrid::LoopGrid(const Device& device, bool with_users, const Progress& progress)
    : period_(device.loop().sampling_period), angles_(grid_of(device)) {
  const FilteredPlant plant = filtered_plant(device);
  std::optional<UserDiscs> users;
  if (with_users) users.emplace(device, progress);
  plant_.reserve(angles_.size());
  damper_.reserve(angles_.size());
  deltas_.reserve(angles_.size());
  tell(progress, 0.0);
  for (const double angle : angles_) {
    const double half = std::sin(0.5 * angle);
    deltas_.emplace_back(-2.0 * half * half, std::sin(angle));
    if (plant_.size() % angles_per_report == 0) tell(progress, 0.0);
    const double frequency = angle / period_;
    plant_.push_back(response(plant, frequency));
    damper_.push_back(damper_response(virtual_damper(device), period_, frequency));
    clear_.push_back(SeenCrossings::is_clear_of_rounding(plant, angle));
    if (!users) continue;
    // The discs are those behind the wall's own filters (UserDiscs closes them).
    discs_.push_back(users->at(frequency));
  }
}

LoopGrid LoopGrid::with_damper(VirtualDamper damper) const {
  LoopGrid other = *this;
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    other.damper_[i] = damper_response(damper, period_, angles_[i] / period_);
  }
  return other;
}

LoopGrid::Response LoopGrid::filter(const WallFilter& filter) const {
  const FilterSection section = filter_section(filter, period_);
  const auto [n0, n1, n2] = whole_numerator(section);
  const bool pair = section.degree == 2;
  const double d0 = section.denominator[0];
  const double d1 = pair ? section.denominator[1] : 1.0;
  const double d2 = pair ? 1.0 : 0.0;
  Response factor;
  factor.reserve(angles_.size());
  for (const std::complex<double>& delta : deltas_) {
    const std::complex<double> numerator = (n2 * delta + n1) * delta + n0;
    const std::complex<double> denominator = (d2 * delta + d1) * delta + d0;
    factor.push_back(numerator * reciprocal(denominator));
  }
  return factor;
}

SeenCrossings LoopGrid::seen(const FilteredPlant& plant, VirtualDamper damper, const Response& factor) const {
  std::vector<SeenCrossings::Point> points(angles_.size());
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    points[i] = {angles_[i], plant_[i] * factor[i], damper_[i], clear_[i]};
  }
  return {plant, damper, std::move(points)};
}

LoopGrid::Response LoopGrid::damper(VirtualDamper damper) const {
  Response response;
  response.reserve(angles_.size());
  for (const double angle : angles_) response.push_back(damper_response(damper, period_, angle / period_));
  return response;
}

double LoopGrid::stiffest(const Response& factor, const RequiredMargins& margins, double enough) const {
  return stiffest(factor, damper_, margins, enough);
}

double LoopGrid::stiffest(const Response& factor, const Response& damper, const RequiredMargins& margins,
                          double enough) const {
  const double cosine = std::cos(margins.phase);
  LeastCrossover alone(1.0);
  LeastCrossover half(std::sqrt(margins.gain));
  LeastCrossover whole(margins.gain);
  double least = infinity;
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    const std::complex<double> seen = plant_[i] * factor[i];
    if (seen == 0.0) continue;
    const std::complex<double> required = -reciprocal(seen);
    alone.add(required, damper[i]);
    half.add(required, damper[i]);
    whole.add(required, damper[i]);
    if (margins.phase > 0.0) {
      if (const auto stiffness = short_of_phase(required, damper[i], cosine)) least = std::min(least, *stiffness);
    }
    if (std::min({least, alone.value() / margins.gain, half.value(), whole.value()}) <= enough) return enough;
    if (i + 1 == angles_.size()) {
      alone.add_nyquist(required.real(), damper[i].real());
      half.add_nyquist(required.real(), damper[i].real());
      whole.add_nyquist(required.real(), damper[i].real());
    }
  }
  least = std::min({least, alone.value() / margins.gain, half.value(), whole.value()});
  return margins.any_user ? std::min(least, any_user(factor, damper, 1.0) / margins.gain) : least;
}

double LoopGrid::any_user(const Response& factor) const { return any_user(factor, damper_, 1.0); }

double LoopGrid::any_user(const Response& factor, const Response& damper, double scale) const {
  double least = infinity;
  for (std::size_t i = 0; i < discs_.size(); ++i) {
    const double size = std::abs(factor[i]);
    const TerminationDiscs::Disc seen{discs_[i].centre * factor[i], discs_[i].radius * size,
                                      discs_[i].power * size * size};
    least = std::min(least, least_stiffness(seen, scale * damper[i]));
  }
  return least;
}

bool LoopGrid::keeps_phase(const Response& factor, const Response& damper, double stiffness,
                           double phase_margin) const {
  std::complex<double> last;
  double last_norm = 0.0;
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    const std::complex<double> loop = plant_[i] * factor[i] * (stiffness + damper[i]);
    const double norm = std::norm(loop);
    if (i > 0 && (norm > 1.0) != (last_norm > 1.0) && norm > 0.0 && last_norm > 0.0) {
      const double share = std::log(last_norm) / (std::log(last_norm) - std::log(norm));
      const double angle = std::arg(-last) + share * std::arg(loop * std::conj(last));
      if (std::abs(std::remainder(angle, 2.0 * pi)) < phase_margin) return false;
    }
    last = loop;
    last_norm = norm;
  }
  return true;
}

double LoopGrid::stiffest_in_phase(const Response& factor, const StiffnessRange& range, double phase_margin) const {
  return stiffest_in_phase(factor, damper_, range, phase_margin);
}

double LoopGrid::stiffest_in_phase(const Response& factor, const Response& damper, const StiffnessRange& range,
                                   double phase_margin) const {
  const auto keeps = [&](double stiffness) { return keeps_phase(factor, damper, stiffness, phase_margin); };
  double high = range.at_most;
  if (phase_margin == 0.0 || !std::isfinite(high) || keeps(high)) return high;
  for (int i = 0; i < most_steps && high > range.at_least; ++i) {
    double low = step_down * high;
    if (keeps(low)) {
      for (int step = 0; step < bisections_on_grid; ++step) {
        const double middle = 0.5 * (low + high);
        (keeps(middle) ? low : high) = middle;
      }
      return low;
    }
    high = low;
  }
  return 0.0;
}

double LoopGrid::largest_damping(const Response& factor, const Response& unit_damper) const {
  LeastCrossover free(1.0);
  double least = infinity;
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    const std::complex<double> seen = plant_[i] * factor[i] * unit_damper[i];
    if (seen == 0.0) continue;
    free.add(-1.0 / seen, 0.0);
    if (i + 1 == angles_.size()) free.add_nyquist((-1.0 / seen).real(), 0.0);
    if (discs_.empty()) continue;
    const std::complex<double> turned = factor[i] * unit_damper[i];
    const double size = std::abs(turned);
    least = std::min(
        least,
        least_stiffness({discs_[i].centre * turned, discs_[i].radius * size, discs_[i].power * size * size}, 0.0));
  }
  return std::min(least, free.value());
}

}  // namespace zwidth::internal

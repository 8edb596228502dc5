#include "stability/users/absolute_stability_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numbers>
#include <vector>

#include "stability/limit/gain_crossings.hpp"
#include "stability/limit/guarded_stiffness.hpp"
#include "stability/loop/damper_response.hpp"
#include "stability/second_route/pole_count.hpp"
#include "stability/users/any_grasp.hpp"
#include "stability/users/disc_stiffness.hpp"
#include "stability/users/wall_condition.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/device_user.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double lowest_angle = 1e-7;  // rad per sample
constexpr int even_samples = 64;
constexpr double samples_per_delay = 16.0;  // more of them for each sample of delay: e^{-j w t_d} turns that often
constexpr int low_samples_per_decade = 24;
constexpr double narrowest_band = 1e-5;  // relative, around a crossover of the free device
constexpr double far_above = 10.0;       // times the least K: a disc there would hold the origin or nearly so
constexpr int refining_bits = 30;
constexpr std::uintmax_t max_refinements = 60;
constexpr double worth_refining = 1.05;  // of the least sample
constexpr double flat = 1e-13;           // relative: among samples so much alike a minimum is one of rounding
// How far below the least K found the condition is shown to hold, relative; more where that cannot be shown.
constexpr double proven_within[] = {2e-10, 2e-9, 2e-8, 2e-7, 2e-6, 2e-5, 2e-4, 2e-3};
constexpr double sound_within = 1e-4;  // more taken off makes the limit doubtful
// Of the typical stiffness over frequency: where nothing dissipates at all, rounding leaves a limit of about this.
constexpr double nothing = 1e-14;
constexpr int most_divisions = 60;              // of one piece
constexpr std::size_t divisions_per_share = 4;  // of an undecided piece, before the next share above will do
constexpr std::size_t most_pieces = 3000;       // beyond those to start with
constexpr int looks_within_piece = 32;
constexpr double beaten = 1e-6;          // relative: a user below the limit
constexpr double same_stiffness = 1e-9;  // relative: the limit towards w = 0 is named rather than another frequency

/// Where the condition may be tightest whatever the damper: evenly, towards zero, and around every mode of the held
/// device and its alias.
std::vector<double> frequencies_to_scan(const TerminationDiscs& discs, double period, double delay,
                                        const std::vector<WallFilter>& filters) {
  const double nyquist = pi / period;
  std::vector<double> scan{nyquist};
  const int even = even_samples + static_cast<int>(samples_per_delay * delay / period);
  for (int i = 1; i < even; ++i) scan.push_back(nyquist * i / even);
  for (double angle = pi / even_samples; angle > lowest_angle; angle *= std::pow(10.0, -1.0 / low_samples_per_decade)) {
    scan.push_back(angle / period);
  }
  std::vector<Mode> modes = discs.held_form().modes;
  if (discs.held_form().suspended_rigid_body) modes.push_back(*discs.held_form().suspended_rigid_body);
  // A filter bends the condition as a mode does.
  for (const WallFilter& filter : filters) {
    if (filter.frequency_hz > 0.0) modes.push_back({2.0 * pi * filter.frequency_hz, filter.damping_ratio});
  }
  for (const Mode& mode : modes) {
    const double centre = std::abs(std::remainder(mode.frequency, 2.0 * nyquist));
    const double width = std::min(mode.damping_ratio, 1.0) * mode.frequency;
    for (const double widths : {0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 64.0}) {
      for (const double side : {-1.0, 1.0}) {
        const double at = centre + side * widths * width;
        if (at > lowest_angle / period && at < nyquist) scan.push_back(at);
      }
    }
  }
  std::sort(scan.begin(), scan.end());
  scan.erase(std::unique(scan.begin(), scan.end()), scan.end());
  return scan;
}

/// The middle one of the finite stiffnesses; 0 without any.
double typical_of(std::vector<double> stiffnesses) {
  std::erase_if(stiffnesses, [](double each) { return !std::isfinite(each); });
  if (stiffnesses.empty()) return 0.0;
  const auto middle = stiffnesses.begin() + static_cast<std::ptrdiff_t>(stiffnesses.size() / 2);
  std::nth_element(stiffnesses.begin(), middle, stiffnesses.end());
  return *middle;
}

}  // namespace

AbsoluteStabilitySearch::AbsoluteStabilitySearch(const Device& device, const Progress& progress)
    : free_(device_without_user(device)), discs_(device, progress), period_(device.loop().sampling_period) {
  if (is_grasped_in_many_directions(device)) {
    grasps_.emplace(free_);
    return;
  }
  if (discs_.is_undamped()) return;
  pieces_ = DiscPieces(discs_, device);
  frequencies_ = frequencies_to_scan(discs_, period_, device.loop().delay, device.parameters().wall.filters);
  discs_at_.reserve(frequencies_.size());
  for (const double frequency : frequencies_) discs_at_.push_back(pieces_.at({0.0, frequency}));
}

WallResponse AbsoluteStabilitySearch::wall_at(VirtualDamper damper, double frequency) const {
  const std::complex<double> velocity = damper_response(damper, period_, frequency);
  return free_gain_ == FreeGain::damping ? WallResponse{velocity, 0.0} : WallResponse{1.0, velocity};
}

double AbsoluteStabilitySearch::limit_at(VirtualDamper damper, const TerminationDiscs::Place& place) const {
  return least_gain(discs_.scaled_at(place), wall_at(damper, place.frequency()));
}

double AbsoluteStabilitySearch::quick_limit_at(VirtualDamper damper, const TerminationDiscs::Place& place) const {
  return least_gain(pieces_.at(place), wall_at(damper, place.frequency()));
}

/// By rising frequency. The free device's own crossovers lie on the discs: the limit is never above them, and the band
/// around one where K is finite may be narrow, so closer and closer around. A band that is narrow is so because the
/// disc is small beside its centre, and K there is hardly below the crossover's: those far above the least K need no
/// closer look.
std::vector<AbsoluteStabilitySearch::Sample> AbsoluteStabilitySearch::scan(VirtualDamper damper,
                                                                           const CriticalStiffness& free) const {
  std::vector<Sample> samples;
  samples.reserve(frequencies_.size());
  double least = infinity;
  for (std::size_t i = 0; i < frequencies_.size(); ++i) {
    const double frequency = frequencies_[i];
    samples.push_back({{0.0, frequency}, least_gain(discs_at_[i], wall_at(damper, frequency))});
    least = std::min(least, samples.back().stiffness);
  }
  const auto known = static_cast<std::ptrdiff_t>(samples.size());
  for (const Crossover& each : free.crossovers) {
    if (each.stiffness > far_above * least) continue;
    for (double share = 0.0; share < 0.5; share = share == 0.0 ? narrowest_band : 4.0 * share) {
      for (const double at : {each.frequency * (1.0 - share), each.frequency * (1.0 + share)}) {
        if (at > lowest_angle / period_ && at < pi / period_) {
          samples.push_back({{0.0, at}, quick_limit_at(damper, {0.0, at})});
        }
      }
    }
  }
  const auto by_frequency = [](const Sample& a, const Sample& b) { return a.place.offset < b.place.offset; };
  std::sort(samples.begin() + known, samples.end(), by_frequency);
  std::inplace_merge(samples.begin(), samples.begin() + known, samples.end(), by_frequency);
  return samples;
}

/// Refines the local minima among samples, all of one base and by rising offset, that may lead below the least.
void AbsoluteStabilitySearch::take_least_of(VirtualDamper damper, const std::vector<Sample>& samples,
                                            Sample& least) const {
  const auto take = [&](const TerminationDiscs::Place& place) {
    const double stiffness = limit_at(damper, place);
    if (stiffness < least.stiffness) least = {place, stiffness};
  };
  const auto lowest = std::min_element(samples.begin(), samples.end(),
                                       [](const Sample& a, const Sample& b) { return a.stiffness < b.stiffness; });
  if (lowest == samples.end()) return;
  take(lowest->place);
  Sample best = *lowest;
  const double sampled = lowest->stiffness;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Sample& here = samples[i];
    const double left = i > 0 ? samples[i - 1].stiffness : infinity;
    const double right = i + 1 < samples.size() ? samples[i + 1].stiffness : infinity;
    if (here.stiffness > left || here.stiffness > right) continue;
    if (std::max(left, right) - here.stiffness <= flat * here.stiffness) continue;
    // Between the samples it may fall as far again as from the higher neighbour to here.
    const double may_reach = here.stiffness - (std::max(left, right) - here.stiffness);
    if (!(std::isfinite(here.stiffness) && may_reach <= worth_refining * sampled)) continue;
    std::uintmax_t iterations = max_refinements;
    // 1/K, which stays finite where no K violates the condition
    const double base = here.place.base;
    const auto [offset, compliance] = boost::math::tools::brent_find_minima(
        [&](double x) {
          return -1.0 / quick_limit_at(damper, {base, x});
        },
        samples[i > 0 ? i - 1 : 0].place.offset, samples[std::min(i + 1, samples.size() - 1)].place.offset,
        refining_bits, iterations);
    if (-1.0 / compliance < best.stiffness) best = {{base, offset}, -1.0 / compliance};
  }
  take(best.place);
}

/// The least K of a piece, looking closer around `at`.
AbsoluteStabilitySearch::Sample AbsoluteStabilitySearch::least_within(VirtualDamper damper,
                                                                      const DiscPieces::Piece& piece,
                                                                      const TerminationDiscs::Place& at) const {
  std::vector<double> offsets{at.offset};
  for (int i = 0; i <= looks_within_piece; ++i) {
    const double offset = piece.place_at(-1.0 + 2.0 * i / looks_within_piece).offset;
    if (piece.base + offset > 0.0) offsets.push_back(offset);
  }
  const double width = piece.end - piece.begin;
  for (double share = 1.0 / looks_within_piece; share > narrowest_band; share *= 0.5) {
    for (const double offset : {at.offset - share * width, at.offset + share * width}) {
      if (piece.side * offset > piece.begin && piece.side * offset < piece.end) offsets.push_back(offset);
    }
  }
  std::sort(offsets.begin(), offsets.end());
  std::vector<Sample> samples;
  for (const double offset : offsets) {
    const TerminationDiscs::Place place{piece.base, offset};
    samples.push_back({place, quick_limit_at(damper, place)});
  }
  Sample least{at, infinity};
  take_least_of(damper, samples, least);
  return least;
}

/// At the zeros of Re Y on the axis or beside it, and ever closer around their images.
void AbsoluteStabilitySearch::look_at_zeros(VirtualDamper damper, Sample& least) const {
  constexpr double widest = 0.1;  // of the image
  constexpr double narrowest = 1e-14;
  constexpr double ratio = 0.2;
  constexpr double one_sided = 1e-100;
  for (const TerminationDiscs::SharpImage& each : discs_.sharp_images()) {
    if (!(each.image > 0.0 && each.image <= pi / period_)) continue;
    const SharpZero& zero = discs_.zeros().sharp[each.zero];
    // Where discs grow as 1/e a half plane on one side of the zero is another than on the other.
    std::vector<double> distances{0.0, one_sided * each.image};
    for (double share = widest; share > narrowest; share *= ratio) distances.push_back(share * each.image);
    for (const double depths : {0.3, 1.0, 3.0}) distances.push_back(depths * zero.depth * zero.frequency);
    std::sort(distances.begin(), distances.end());
    for (const double side : {-1.0, 1.0}) {
      std::vector<Sample> samples;
      for (const double distance : distances) {
        const TerminationDiscs::Place place{each.image, side * distance};
        if (place.frequency() <= 0.0 || place.frequency() > pi / period_) continue;
        samples.push_back({place, quick_limit_at(damper, place)});
      }
      if (side < 0.0) std::reverse(samples.begin(), samples.end());
      take_least_of(damper, samples, least);
    }
  }
}

/// Another route: the lossless spring or mass that resonates with the device at a zero of Re Y, so that its damped bodies
/// hardly move. Its critical stiffness where that is below a limit and poles counted with a hundred digits agree.
std::optional<double> AbsoluteStabilitySearch::beaten_by_tuned_user(VirtualDamper damper, double stiffness) const {
  std::optional<double> least;
  for (const SharpZero& zero : discs_.zeros().sharp) {
    // Y + 1/(jX) = 0
    const double reactance = 1.0 / (zero.frequency * response(discs_.held_form(), zero.frequency).real());
    if (!std::isfinite(reactance) || reactance == 0.0) continue;
    DeviceParameters held = free_.parameters();
    if (reactance > 0.0) held.user.mass = reactance / zero.frequency;
    if (reactance < 0.0) held.user.stiffness = -reactance * zero.frequency;
    const double below = stiffness * (1.0 - beaten);
    const bool is_damper = free_gain_ == FreeGain::damping;
    held.wall.damping = is_damper ? below : damper.damping;
    held.wall.velocity_filter_hz = damper.velocity_filter_hz;
    const Device device(std::move(held));
    const FilteredPlant plant = filtered_plant(device);
    const double critical =
        (is_damper ? critical_stiffness_of(plant, damping_crossings(plant, damper)) : critical_stiffness(plant, damper))
            .stiffness;
    if (!(critical < below)) continue;
    if (PoleCount(device).in_digits(is_damper ? weak_spring(device) : below).value_or(0) > 0) {
      least = std::min(critical, least.value_or(critical));
    }
  }
  return least;
}

/// Shows that no K below the least found violates the condition, or finds the lower ones and shows it of those.
/// The share of the least by which that could not be shown.
double AbsoluteStabilitySearch::prove(VirtualDamper damper, const Progress& progress, Sample& least) {
  struct Open {
    std::size_t piece;
    std::size_t divisions;  // because it was undecided
  };
  std::vector<Open> stack;
  for (std::size_t i = pieces_.first_pieces(); i-- > 0;) stack.push_back({i, 0});
  std::size_t left = pieces_.first_pieces() + most_pieces;
  double within = 0.0;
  const double filter_pole =
      damper.damping > 0.0 && damper.velocity_filter_hz > 0.0 ? 2.0 * pi * damper.velocity_filter_hz : infinity;
  while (!stack.empty()) {
    tell(progress, 0.0);
    const std::size_t index = stack.back().piece;
    const std::size_t divisions = stack.back().divisions;
    // No piece needs to be shown closer than the worst so far.
    const double share =
        std::max(within, proven_within[std::min(divisions / divisions_per_share, std::size(proven_within) - 1)]);
    const bool may_divide = pieces_[index].depth < most_divisions && left > 0;
    if (left > 0) --left;
    const auto divide = [&](std::size_t more) {
      stack.pop_back();
      pieces_.divide(index);
      // Towards a zero of Re Y a piece may be divided as often as need be.
      const std::size_t near = pieces_[index].begins_at_zero_of_dissipation() ? 0 : more;
      stack.push_back({static_cast<std::size_t>(pieces_[index].second_half), divisions + more});
      stack.push_back({static_cast<std::size_t>(pieces_[index].first_half), divisions + near});
    };
    if (may_divide && !pieces_.is_clear_of_poles(index, filter_pole)) {
      divide(0);
      continue;
    }
    const DiscPieces::Piece& piece = pieces_.sampled(index);
    std::array<WallResponse, interpolation_points> walls{};
    for (std::size_t i = 0; i < interpolation_points; ++i) walls[i] = wall_at(damper, piece.nodes[i].frequency);
    const WallCondition condition(piece, walls);
    const auto answer_at = [&](double below) { return condition.up_to(least.stiffness * (1.0 - below)); };
    if (const auto at_zero = condition.least_stiffness_at_zero()) {
      if (*at_zero <= least.stiffness * (1.0 + same_stiffness))
        least = {{0.0, 0.0}, std::min(*at_zero, least.stiffness)};
      if (least.stiffness == 0.0) return 0.0;
    }
    const WallCondition::Answer answer = answer_at(share);
    if (answer.verdict == WallCondition::Verdict::holds) {
      stack.pop_back();
      within = std::max(within, share);
      continue;
    }
    if (answer.verdict == WallCondition::Verdict::broken) {
      const Sample lower = least_within(damper, piece, piece.place_at(answer.at));
      if (lower.stiffness < least.stiffness * (1.0 - 0.5 * proven_within[0])) {
        least = lower;
        if (left > 0) continue;
      }
    }
    if (may_divide) {
      divide(1);
      continue;
    }
    stack.pop_back();
    const auto proven = std::find_if(std::begin(proven_within), std::end(proven_within), [&](double below) {
      return answer_at(below).verdict == WallCondition::Verdict::holds;
    });
    within = std::max(within, proven != std::end(proven_within) ? *proven : 1.0);
    if (within == 1.0) return within;  // nothing of it is left
  }
  return within;
}

AbsoluteStabilityLimit AbsoluteStabilitySearch::limit(VirtualDamper damper, const Progress& progress) {
  free_gain_ = FreeGain::stiffness;
  return limit_of(damper, critical_stiffness(discs_.free_plant(), damper), progress);
}

AbsoluteStabilityLimit AbsoluteStabilitySearch::damping_limit(double velocity_filter_hz, const Progress& progress) {
  free_gain_ = FreeGain::damping;
  const VirtualDamper unit{1.0, velocity_filter_hz};
  const FilteredPlant& plant = discs_.free_plant();
  return limit_of(unit, critical_stiffness_of(plant, damping_crossings(plant, unit)), progress);
}

AbsoluteStabilityLimit AbsoluteStabilitySearch::limit_of(VirtualDamper damper, const CriticalStiffness& free,
                                                         const Progress& progress) {
  if (grasps_) {
    tell(progress, 0.0);
    return grasps_->limit(free_gain_, damper, free);
  }
  AbsoluteStabilityLimit limit;
  if (free.status == StiffnessStatus::none_stable || discs_.is_undamped()) return limit;
  Sample least{{0.0, 0.0}, infinity};
  const std::vector<Sample> samples = scan(damper, free);
  take_least_of(damper, samples, least);
  look_at_zeros(damper, least);
  // Nobody is a passive user too. Where users hardly reach the wall's loop their discs are too small for rounding.
  const auto nobody = [&] { return free.limit && free.stiffness <= least.stiffness; };
  if (nobody()) least = {{0.0, free.limit->frequency}, free.stiffness};
  std::vector<double> gains;
  gains.reserve(samples.size());
  for (const Sample& each : samples) {
    // Most frequencies allow any damper alone; rounding leaves some of them a gain far beyond the loop's.
    const auto of_loop = [&](double frequency) {
      return 1.0 / std::abs(wall_at(damper, frequency).unit * response(discs_.free_plant(), frequency));
    };
    gains.push_back(free_gain_ == FreeGain::damping ? of_loop(each.place.frequency()) : each.stiffness);
  }
  const bool is_nothing = least.stiffness <= nothing * typical_of(gains);
  if (is_nothing) least.stiffness = 0.0;
  double unproven = 0.0;
  if (least.stiffness > 0.0) unproven = prove(damper, progress, least);
  if (least.stiffness == 0.0) return limit;
  limit.frequency = std::isfinite(least.stiffness) ? least.place.frequency() : 0.0;
  limit.truncation = std::min(discs_.truncation() + unproven, 1.0);
  // What the free device reaches stands where users are shown to reach no less.
  limit.needs_no_user = nobody() && limit.truncation <= sound_within;
  limit.stiffness = limit.needs_no_user ? least.stiffness : least.stiffness * (1.0 - limit.truncation);
  if (discs_.zeros().is_unknown) {
    limit.trust.doubt({.code = FindingCode::any_user_limit_may_miss_frequency});
  } else if (const auto tuned = beaten_by_tuned_user(damper, limit.stiffness)) {
    limit.stiffness = *tuned;
    limit.needs_no_user = false;
    limit.trust.doubt(
        {.code = FindingCode::any_user_limit_lowered, .effect = {{"critical_stiffness", limit.stiffness}}});
  }
  if (unproven > sound_within) {
    limit.trust.doubt(
        {.code = FindingCode::any_user_limit_loose, .evidence = {{"unproven", unproven}, {"threshold", sound_within}}});
  }
  if (discs_.truncation() > sound_within) {
    limit.trust.doubt({.code = FindingCode::any_user_limit_truncated,
                       .evidence = {{"truncation", discs_.truncation()}, {"threshold", sound_within}}});
  }
  return limit;
}

}  // namespace zwidth::internal

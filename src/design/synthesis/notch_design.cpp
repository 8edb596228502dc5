#include "zwidth/design/notch_design.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "counted.hpp"
#include "design/synthesis/margin_wall.hpp"
#include "design/synthesis/notch_search.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;

constexpr std::size_t modal_shifts_verified = 41;
constexpr int rounds = 4;              // of search and verification
constexpr double worth_having = 1e-3;  // relative gain below which there is no notch

constexpr int bits_of_modal_shift = 16;
constexpr std::uintmax_t max_refinements = 20;  // of the modal shift around a local minimum
constexpr double shaved = 1e-6;  // off the least over the modal shift: what lies between its refined samples
constexpr double step_down = 0.99;
constexpr int most_steps_down = 200;
constexpr double bound_by_phase = 0.1;  // of the stiffness that the gain margin allows

Device with_filter(const Device& device, const WallFilter& filter) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.filters.push_back(filter);
  return Device(std::move(parameters));
}

// One of the modal shifts at which a proposal is recomputed exactly.
struct Verified {
  Device device;
  std::optional<AbsoluteStabilityLimit> any_user;  // without the notch; nothing: not to be kept
};

class Verification {
 public:
  Verification(const Device& device, const NotchOptions& options, bool keep_absolute_stability_limit)
      : device_(device), margins_(required(options)), progress_(options.progress) {
    const std::size_t count = options.modal_frequency_uncertainty > 0.0 ? modal_shifts_verified : 1;
    for (std::size_t i = 0; i < count; ++i) {
      const double share =
          count == 1 ? 0.0 : 2.0 * static_cast<double>(i) / static_cast<double>(modal_shifts_verified - 1) - 1.0;
      tell(progress_, static_cast<double>(i) / static_cast<double>(count));
      Device each = with_modal_shift(device, share * options.modal_frequency_uncertainty);
      std::optional<AbsoluteStabilityLimit> any_user;
      if (keep_absolute_stability_limit) any_user = absolute_stability_limit(each, virtual_damper(each));
      const double without = internal::stiffest_wall(each, margins_);
      without_.push_back({share * options.modal_frequency_uncertainty, without, without});
      modal_shifts_.push_back({std::move(each), std::move(any_user)});
    }
  }

  [[nodiscard]] const std::vector<NotchAtModalShift>& without() const { return without_; }
  [[nodiscard]] const Device& at(std::size_t i) const { return modal_shifts_[i].device; }
  [[nodiscard]] std::size_t size() const { return modal_shifts_.size(); }

  [[nodiscard]] std::vector<NotchAtModalShift> with(const WallFilter& notch) const {
    std::vector<NotchAtModalShift> samples = without_;
    for (std::size_t i = 0; i < modal_shifts_.size(); ++i) {
      tell(progress_, 0.0);
      samples[i].with = internal::stiffest_wall(with_filter(modal_shifts_[i].device, notch), margins_);
    }
    return samples;
  }

  struct Least {
    double stiffness = 0.0;
    double modal_shift = 0.0;
  };
  // The least of that member, refined around every local minimum of the samples and shaved; `notch` is null for the
  // walls without.
  [[nodiscard]] Least least(const std::vector<NotchAtModalShift>& samples, double NotchAtModalShift::*member,
                            const WallFilter* notch) const {
    Least result{samples.front().*member, samples.front().modal_shift};
    const auto consider = [&](double modal_shift, double stiffness) {
      if (stiffness < result.stiffness) result = {stiffness, modal_shift};
    };
    const auto at = [&](double modal_shift) {
      tell(progress_, 0.0);
      const Device plain = with_modal_shift(device_, modal_shift);
      return internal::stiffest_wall(notch != nullptr ? with_filter(plain, *notch) : plain, margins_);
    };
    const std::size_t last = samples.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
      const double here = samples[i].*member;
      consider(samples[i].modal_shift, here);
      const NotchAtModalShift& left = samples[i > 0 ? i - 1 : 0];
      const NotchAtModalShift& right = samples[std::min(i + 1, last)];
      if (last == 0 || here == 0.0 || !std::isfinite(here) || here > left.*member || here > right.*member) continue;
      if (here > 1.05 * result.stiffness) continue;  // too far above the least to fall below it between samples
      std::uintmax_t steps = max_refinements;
      const auto [modal_shift, stiffness] =
          boost::math::tools::brent_find_minima(at, left.modal_shift, right.modal_shift, bits_of_modal_shift, steps);
      consider(modal_shift, stiffness);
    }
    result.stiffness *= 1.0 - shaved;
    return result;
  }

  // A softer wall may keep the margins less well: down to a stiffness that keeps them at every modal shift; 0 where there is
  // none, or a user may destabilise the notched device below the limit without, as far as both are known.
  [[nodiscard]] double kept_everywhere(const WallFilter& notch, double stiffness) const {
    std::vector<Device> notched;
    for (const Verified& each : modal_shifts_) {
      tell(progress_, 0.0);
      notched.push_back(with_filter(each.device, notch));
      const Device& device = notched.back();
      if (!each.any_user) continue;
      if (each.any_user->trust.refused()) return 0.0;
      const AbsoluteStabilityLimit with_notch = absolute_stability_limit(device, virtual_damper(device));
      if (is_lower(with_notch.lower_bound(), each.any_user->stiffness)) return 0.0;
    }
    const RequiredMargins margins{margins_.gain * (1.0 - shaved), margins_.phase * (1.0 - shaved), margins_.any_user};
    for (int step = 0; step < most_steps_down; ++step, stiffness *= step_down) {
      const auto keeps = [&](const Device& each) {
        tell(progress_, 0.0);
        return keeps_margins(each, stiffness, margins);
      };
      if (std::ranges::all_of(notched, keeps)) {
        return stiffness;
      }
    }
    return 0.0;
  }

 private:
  const Device& device_;
  RequiredMargins margins_;
  const Progress& progress_;
  std::vector<Verified> modal_shifts_;
  std::vector<NotchAtModalShift> without_;
};

// The device as it is, with the designed wall in it.
NotchState state_of(const Device& device, double stiffness) {
  DeviceParameters parameters = device.parameters();
  if (stiffness > 0.0 && std::isfinite(stiffness)) parameters.wall.stiffness = stiffness;
  Device walled(std::move(parameters));
  Analysis analysis = analyze(walled, {.any_user = true, .draws = 0});
  return {std::move(walled), std::move(analysis)};
}

void add_states(const Device& device, NotchDesign& design) {
  design.state_without = state_of(device, design.with);
  design.trust.inherit(design.state_without->analysis.trust);
  if (!design.notch) return;
  design.state_with = state_of(with_filter(device, *design.notch), design.with);
  design.trust.inherit(design.state_with->analysis.trust);
}

void remark_on(const NotchOptions& options, NotchDesign& design) {
  if (design.without == 0.0 && !design.notch) {
    design.remarks.push_back(warning({.code = FindingCode::no_wall_keeps_margins}));
  } else if (design.state_without && design.state_without->analysis.critical.status == StiffnessStatus::finite &&
             design.with < bound_by_phase * design.state_without->analysis.critical.stiffness / options.gain_margin) {
    design.remarks.push_back(
        warning({.code = FindingCode::phase_margin_bounds,
                 .evidence = {{"stiffness", design.with}, {"phase_margin", options.phase_margin}},
                 .effect = {{"critical_stiffness", design.state_without->analysis.critical.stiffness}}}));
  } else if (!design.notch && std::isfinite(design.without)) {
    design.remarks.push_back(
        note({.code = options.lower_absolute_stability_limit ? FindingCode::no_notch_helps
                                                             : FindingCode::no_counted_notch_helps}));
  }
}

}  // namespace

std::optional<OptionProblem> find_problem(const NotchOptions& options, const Device& device) {
  if (auto problem = find_modal_frequency_uncertainty_problem(options.modal_frequency_uncertainty, device))
    return problem;
  if (auto problem = find_problem(RequiredMargins{options.gain_margin, options.phase_margin})) return problem;
  if (options.goal == StiffnessGoal::absolute_stability_limit && !can_be_held(device)) {
    return option_problem("goal", {.code = ProblemCode::any_user_goal_needs_bodies,
                                   .evidence = {counted("most", most_bodies_for_absolute_stability)}});
  }
  if (has_damper_loop(device.loop())) {
    return option_problem("notch", {.code = ProblemCode::filters_beside_damper_loop});
  }
  if (seen_modes(device).empty()) {
    return option_problem("notch", {.code = ProblemCode::no_mode_to_tune_to});
  }
  return std::nullopt;
}

Device with_modal_shift(const Device& device, double modal_shift) {
  if (!(modal_shift > -1.0 && modal_shift <= 10.0)) {
    throw Error(ErrorCode::invalid_argument,
                {.code = ProblemCode::drift_not_possible, .evidence = {{"value", modal_shift}}});
  }
  if (modal_shift == 0.0) return device;
  if (device.links().empty()) throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::drift_without_links});
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty.reset();
  for (Link& link : parameters.links) {
    link.stiffness *= (1.0 + modal_shift) * (1.0 + modal_shift);
    link.damping *= 1.0 + modal_shift;
  }
  return Device(std::move(parameters));
}

double stiffest_wall(const Device& device, const NotchOptions& options) {
  require_no_coordinates(device);
  return internal::stiffest_wall(device, required(options));
}

NotchDesign design_notch(const Device& device, const NotchOptions& options) {
  require_no_coordinates(device);
  require_valid(find_problem(options, device));
  StagedProgress stages(options.progress);
  NotchOptions staged = options;
  staged.progress = stages.stage();
  NotchDesign design;
  design.trust = critical_stiffness(device).trust;
  if (design.trust.refused()) return design;
  const std::vector<double> modes = seen_modes(device);
  stages.next(0.2);
  const bool keep_absolute_stability_limit = !staged.lower_absolute_stability_limit && can_be_held(device);
  const Verification verification(device, staged, keep_absolute_stability_limit);
  design.over_modal_shift = verification.without();
  design.without = design.with =
      verification.least(design.over_modal_shift, &NotchAtModalShift::without, nullptr).stiffness;
  stages.next(0.5);
  if (std::isfinite(design.without)) {
    NotchSearch search(staged, modes, device.loop().sampling_period, keep_absolute_stability_limit);
    search.add(device);
    if (verification.size() > 1) {
      search.add(verification.at(0));
      search.add(verification.at(verification.size() - 1));
    }
    std::vector<NotchSearch::Point> candidates = search.candidates(staged.progress);
    bool settled = false;
    for (int round = 0; round < rounds && !candidates.empty() && !settled; ++round) {
      stages.next(0.5 + 0.5 * (round + 1) / rounds);
      std::vector<std::pair<double, NotchSearch::Point>> found =
          search.refine(candidates, design.without * (1.0 + worth_having));
      std::ranges::sort(found, std::greater{});
      double worst_modal_shift = 0.0;  // of the best proposal
      for (std::size_t i = 0; i < found.size() && !settled; ++i) {
        const auto& [promised, at] = found[i];
        if (promised <= design.with * (1.0 + worth_having)) break;
        const WallFilter notch = NotchSearch::notch_at(at);
        std::vector<NotchAtModalShift> over_modal_shift = verification.with(notch);
        const Verification::Least worst = verification.least(over_modal_shift, &NotchAtModalShift::with, &notch);
        if (i == 0) worst_modal_shift = worst.modal_shift;
        double with = worst.stiffness;
        if (with > design.with) with = verification.kept_everywhere(notch, with);
        if (with > design.with * (1.0 + worth_having)) {
          design.notch = notch;
          design.with = with;
          design.over_modal_shift = std::move(over_modal_shift);
          design.low_frequency_delay =
              2.0 * notch.damping_ratio * (1.0 - notch.depth) / (2.0 * pi * notch.frequency_hz);
        }
        settled = with > 0.0 && worst.stiffness >= promised * 0.99;
      }
      if (found.front().first <= design.without * (1.0 + worth_having)) break;  // nothing to gain
      search.add(with_modal_shift(device, worst_modal_shift));
      candidates = {found.front().second};
    }
  }
  add_states(device, design);
  remark_on(staged, design);
  stages.done();
  return design;
}

}  // namespace zwidth

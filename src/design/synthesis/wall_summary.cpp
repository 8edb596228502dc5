#include "zwidth/design/wall_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "design/synthesis/recommended_wall.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "infinity.hpp"
#include "model/known_structure.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "stability/users/any_user_limits.hpp"
#include "stability/wall_judgement.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr int samples_of_damping = 24;     // evenly in log B, from the first share on
constexpr double first_share = 1e-3;       // of the largest damper
constexpr double last_share = 1.0 - 1e-6;  // the limit falls to 0 at the largest
constexpr int damping_bits = 14;           // of log B; the limit is flat there
constexpr std::uintmax_t most_steps = 24;
constexpr double share_of_damper = 0.3;  // of the progress

/// K up to which the loop is stable from K = 0 on, for one device and many dampers.
class LimitOverDamping {
 public:
  LimitOverDamping(const Device& device, const Progress& progress)
      : device_(device),
        velocity_filter_hz_(device.parameters().wall.velocity_filter_hz),
        users_(device.is_mechanical() ? std::make_unique<AnyUserLimits>(device, progress) : nullptr),
        progress_(progress) {}

  [[nodiscard]] Holder holder() const { return users_ ? Holder::any_user : Holder::nobody; }

  [[nodiscard]] StiffestDampedWall at(double damping) {
    tell(progress_, 0.0);
    const VirtualDamper damper{damping, velocity_filter_hz_};
    StiffestDampedWall wall{0.0, damping, damping > 0.0 ? velocity_filter_hz_ : 0.0, holder(), {}};
    if (users_) {
      AbsoluteStabilityLimit limit = users_->limit(damper, progress_);
      wall.stiffness = limit.stiffness;
      wall.trust = std::move(limit.trust);
    } else {
      wall.stiffness = unguarded_stiffness(with_wall(device_, 0.0, damper)).stiffness;
    }
    return wall;
  }

 private:
  const Device& device_;
  double velocity_filter_hz_;
  std::unique_ptr<AnyUserLimits> users_;  // none for a transfer function
  const Progress& progress_;
};

/// Over 0 <= B < `largest`.
StiffestDampedWall stiffest_up_to(LimitOverDamping& limits, double largest) {
  StiffestDampedWall best = limits.at(0.0);
  if (!(largest > 0.0) || !std::isfinite(best.stiffness)) return best;
  const double begin = std::log(first_share * largest);
  const double end = std::log(last_share * largest);
  std::vector<StiffestDampedWall> walls;
  walls.reserve(samples_of_damping);
  for (int i = 0; i < samples_of_damping; ++i) {
    walls.push_back(limits.at(std::exp(std::lerp(begin, end, double(i) / (samples_of_damping - 1)))));
  }
  const auto by_stiffness = [](const auto& a, const auto& b) { return a.stiffness < b.stiffness; };
  const auto top = std::max_element(walls.begin(), walls.end(), by_stiffness);
  best = std::max(best, *top, by_stiffness);
  if (!std::isfinite(best.stiffness)) return best;
  const double left = top == walls.begin() ? begin : std::log(std::prev(top)->damping);
  const double right = std::next(top) == walls.end() ? end : std::log(std::next(top)->damping);
  std::uintmax_t steps = most_steps;
  const double log_damping =
      boost::math::tools::brent_find_minima([&](double log_b) { return -limits.at(std::exp(log_b)).stiffness; }, left,
                                            right, damping_bits, steps)
          .first;
  return std::max(best, limits.at(std::exp(log_damping)), by_stiffness);
}

/// The largest damper alone for whoever may hold the device; nothing where that is not known.
std::optional<double> largest_damper(const Device& device, const Analysis& analysis, const Progress& progress) {
  if (!device.is_mechanical()) {
    if (analysis.limits.nobody.critical_damping) return analysis.limits.nobody.critical_damping;
    const CriticalDamping damping = critical_damping(device);
    return damping.trust.sound() ? std::optional(damping.damping) : std::nullopt;
  }
  if (analysis.limits.any_user && analysis.limits.any_user->critical_damping) {
    return analysis.limits.any_user->critical_damping;
  }
  const AbsoluteStabilityDamping damping = absolute_stability_damping(device, progress);
  return damping.trust.sound() ? std::optional(damping.damping) : std::nullopt;
}

void add_damper(const Device& device, const Analysis& analysis, const Progress& progress, WallSummary& summary) {
  const std::optional<double> largest = largest_damper(device, analysis, progress);
  if (!largest) {
    summary.why_no_damper = Finding{.code = FindingCode::largest_damper_unknown};
    return;
  }
  if (std::isinf(*largest)) {
    summary.why_no_damper = Finding{.code = FindingCode::no_damper_too_large};
    return;
  }
  LimitOverDamping limits(device, progress);
  summary.with_damper = stiffest_up_to(limits, *largest);
}

void add_margins(const Device& device, const Progress& progress, WallSummary& summary) {
  WallRecommendation recommendation = recommended_wall(device, {.alternatives = false, .progress = progress});
  if (recommendation.wall) {
    summary.with_margins = std::move(recommendation.wall);
  } else if (recommendation.trust.refused()) {
    summary.why_no_margins = recommendation.trust.findings.front();
  } else {
    summary.why_no_margins = recommendation.reason;
  }
}

}  // namespace

WallSummary wall_summary(const Device& device, const Analysis& analysis, const WallSummaryOptions& options) {
  require_known_structure(device);
  WallSummary summary;
  if (is_of_mechanism(device) && has_damper_loop(device.loop())) {
    summary.why_no_damper = summary.why_no_margins = Finding{.code = FindingCode::any_grasp_not_known};
    return summary;
  }
  if (analysis.trust.refused()) {
    summary.why_no_damper = summary.why_no_margins = Finding{.code = FindingCode::device_refused};
    return summary;
  }
  if (!knows_all_users(device)) {
    summary.why_no_damper = summary.why_no_margins = left_out_beside_damper_loop("damper").finding;
    return summary;
  }
  if (device.degrees_of_freedom() > options.most_bodies) {
    summary.why_no_damper = summary.why_no_margins = Finding{
        .code = FindingCode::too_many_bodies_for_wall_summary,
        .evidence = {counted("bodies", device.degrees_of_freedom()), counted("threshold", options.most_bodies)}};
    return summary;
  }
  StagedProgress stages(options.progress);
  stages.next(share_of_damper);
  add_damper(device, analysis, stages.stage(), summary);
  stages.next(1.0);
  add_margins(device, stages.stage(), summary);
  stages.done();
  return summary;
}

}  // namespace zwidth

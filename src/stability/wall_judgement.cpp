#include "stability/wall_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stability/limit/guarded_stiffness.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "stability/margins/confirmed_margins.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth::internal {
namespace {

/// Of a wall many powers of ten below all limits its search does not settle: nothing else is lost by that.
void add_disk_margin(const FilteredPlant& plant, const Wall& wall, Analysis& analysis) {
  if (!analysis.wall->stable) return;
  try {
    analysis.disk_margin = disk_margin_of_stable(plant, wall);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    analysis.remarks.push_back(note({FindingCode::disk_margin_left_out}));
  }
}

void withdraw_numbers(Analysis& analysis) {
  analysis.wall.reset();
  analysis.critical.trust.inherit(analysis.trust);
  withdraw(analysis.critical);
  if (!analysis.rigid) return;
  analysis.rigid->critical.trust.inherit(analysis.trust);
  withdraw(analysis.rigid->critical);
}

/// Within rounding of a crossover there is nothing to agree on.
bool is_on_crossover(const CriticalStiffness& critical, double stiffness) {
  constexpr double on_crossover = 1e-6;
  return std::ranges::any_of(critical.crossovers, [&](const Crossover& each) {
    return std::abs(each.stiffness / stiffness - 1.0) <= on_crossover;
  });
}

}  // namespace

void judge_wall(const Device& device, const FilteredPlant& plant, const PoleCount& poles, Analysis& analysis) {
  analysis.wall = wall_margins(device);
  const double stiffness = analysis.wall->stiffness;
  constexpr double on_crossover = 1e-6;
  const double damping = analysis.wall->damping;
  const auto near_damping = [&](const DampingCrossover& each) {
    return std::abs(each.damping / damping - 1.0) <= on_crossover;
  };
  if (stiffness > 0.0) {
    if (is_on_crossover(analysis.critical, stiffness)) return;
    distrust(agreement(poles, stiffness, analysis.wall->stable), stiffness, analysis.trust);
  } else {
    if (damping == 0.0 || std::ranges::any_of(critical_damping(device).crossovers, near_damping)) return;
    distrust(agreement(poles, weak_spring(device), analysis.wall->stable), stiffness, analysis.trust);
  }
  if (analysis.trust.refused()) return withdraw_numbers(analysis);
  add_disk_margin(plant, device.parameters().wall, analysis);
  confirm_margins(device, analysis);
}

void judge_two_rate_wall(const Device& device, Analysis& analysis) {
  const double damping = device.parameters().wall.damping;
  if (damping == 0.0 || *device.parameters().wall.stiffness == 0.0) {  // one of the two runs alone
    const Device alone = damping == 0.0 ? with_one_rate(device) : with_loop_of_damper(device);
    return judge_wall(alone, filtered_plant(alone), PoleCount(alone), analysis);
  }
  analysis.wall = wall_margins(device);
  const double stiffness = analysis.wall->stiffness;
  if (!is_on_crossover(analysis.critical, stiffness)) {
    const TwoRateDevice loop(device, damping);
    distrust(agreement(loop, loop.as_it_runs(device), stiffness, analysis.wall->stable), stiffness, analysis.trust);
  }
  if (analysis.trust.refused()) return withdraw_numbers(analysis);
  analysis.remarks.push_back(left_out_beside_damper_loop("disk"));
  analysis.remarks.push_back(left_out_beside_damper_loop("gain"));
  const WallMargins& wall = *analysis.wall;
  if (wall.stable && !(wall.delay_margin && wall.spring_delay_margin && wall.damper_delay_margin)) {
    analysis.remarks.push_back(left_out_beside_damper_loop("long_delays"));
  }
}

// A damping ratio is about a hundredth of the phase margin in degrees (Franklin, Powell & Emami-Naeini, sec. 6.4).
void judge_damping_of_wall(Analysis& analysis) {
  constexpr double least = 20.0;  // degrees
  if (!analysis.wall || !analysis.wall->phase_margin || !analysis.wall_stable_for) return;
  if (stability_of(*analysis.wall_stable_for) == WallStability::unstable) return;
  const double phase_margin = *analysis.wall->phase_margin * 180.0 / std::numbers::pi;
  if (phase_margin >= least) return;
  Finding finding{.code = FindingCode::wall_poorly_damped,
                  .evidence = {{"phase_margin_deg", phase_margin}, {"least_deg", least}},
                  .key = "wall.stiffness"};
  if (analysis.limits.user) finding.subjects.push_back({"of_holder", std::string(words_of(Holder::user))});
  analysis.remarks.push_back(note(std::move(finding)));
}

Remark left_out_beside_damper_loop(const char* what) {
  return note({.code = FindingCode::left_out_beside_damper_loop, .subjects = {{"what", what}}});
}

}  // namespace zwidth::internal

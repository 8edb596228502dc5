#include "zwidth/design/region.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "design/region/region_check.hpp"
#include "design/region/region_structure.hpp"
#include "stability/users/any_grasp.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/wall_judgement.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
using namespace internal;
namespace {

// Of the progress, what is done after the limits and after the walls; the rest is of the users.
constexpr double limits_share = 0.05;
constexpr double walls_share = 0.2;

std::vector<ComparedApproximation> compared(const Device& device, const WallRegion& walls) {
  std::vector<ComparedApproximation> result;
  if (has_damper_loop(device.loop()) || is_point_wall(device)) return result;  // each is of one rate and direction
  for (RegionApproximation& formula : region_approximations(device, walls.walls->velocity_filter_hz())) {
    if (formula.any_user && walls.any_user) {
      const ApproximationError error = approximation_error(formula, *walls.any_user);
      result.push_back({std::move(formula), error});
    } else if (!formula.any_user && walls.region.most_damped) {
      const ApproximationError error = approximation_error(formula, *walls.walls, walls.region.most_damped->damping);
      result.push_back({std::move(formula), error});
    }
  }
  return result;
}

void refuse(WallRegion& result, Finding finding) {
  Trust trust = std::move(result.trust);
  trust.refuse(std::move(finding));
  result = {};
  result.trust = std::move(trust);
}

/// The walls of one holder.
struct FoundWalls {
  std::optional<StableWalls> walls;
  StableRegion region;
};

// Follows the boundary and asks the second route; what is said of it goes to `result`. Empty where it is refused.
FoundWalls find_walls(const Device& device, const OutlineOptions& outline, WallRegion& result,
                      const Progress& progress) {
  StagedProgress stages(progress);
  stages.next(0.7);
  FoundWalls found;
  found.walls.emplace(device, stages.stage());
  if (const std::optional<Finding>& refusal = found.walls->structure().refusal) {
    refuse(result, *refusal);
    return {};
  }
  stages.next(1.0);
  found.region = stable_region(*found.walls, outline);
  const RegionCheck check = check_region(device, *found.walls, found.region, outline.deviation, stages.stage());
  const Units units = units_of(device.parameters().motion);
  if (check.contradiction) {
    refuse(result, {.code = FindingCode::region_contradicts,
                    .evidence = {{"stiffness", check.contradiction->stiffness, units.stiffness},
                                 {"damping", check.contradiction->damping}},
                    .subjects = {{"damping_unit", std::string(units.damping)}}});
    return {};
  }
  if (check.asked == 0 && found.region.bounded) {
    result.trust.doubt({.code = FindingCode::region_not_confirmed});
  }
  if (check.asked > 0 && check.confirmed == 0) {
    result.trust.doubt(
        {.code = FindingCode::region_poles_on_circle, .evidence = {{"walls_asked", static_cast<double>(check.asked)}}});
  }
  if (found.region.vertex_error > usual_vertex_error) {
    result.trust.doubt({.code = FindingCode::region_vertex_open,
                        .evidence = {{"share", found.region.vertex_error}, {"threshold", usual_vertex_error}}});
  }
  if (!found.walls->structure().proven) {
    result.remarks.push_back(note({.code = FindingCode::boundary_sampled,
                                   .evidence = {{"walls_confirmed", static_cast<double>(check.confirmed)}}}));
  }
  return found;
}

/// A wall in every direction drives no mode by itself: it has none.
ModalForm form_of(const Device& device) { return is_point_wall(device) ? ModalForm{} : modal_form(device); }

/// The region with nobody holding beside that with the file's user, and what both have in common.
void add_nobody(const Device& alone, const OutlineOptions& outline, WallRegion& result, const Progress& progress) {
  WallRegion said;
  FoundWalls found = find_walls(alone, outline, said, progress);
  for (const std::string& reason : said.trust.reasons) {
    Finding with{.code = FindingCode::nobody_holding, .subjects = {{"reason", reason}}};
    if (said.trust.refused()) return refuse(result, std::move(with));
    result.trust.doubt(std::move(with));
  }
  for (Remark& remark : said.remarks) {
    Finding alone_too = *std::move(remark.finding);
    alone_too.subjects.push_back({"of_holder", std::string(words_of(Holder::nobody))});
    result.remarks.push_back(remark.severity == Remark::Severity::note ? note(std::move(alone_too))
                                                                       : warning(std::move(alone_too)));
  }
  const ModalForm form = form_of(alone);
  result.shared = shared_walls(*found.walls, found.region, *result.walls, result.region);
  result.nobody = NobodysRegion{found.region.bounded, std::move(found.walls), std::move(found.region), form.modes,
                                form.suspended_rigid_body};
}

/// Of coordinates: along a normal of a mechanism whose damper runs with its spring, and not too many.
bool asks_any_user(const Device& device, const RegionOptions& options) {
  if (!options.any_user || !device.is_mechanical() || is_point_wall(device)) return false;
  if (device.has_bodies()) return true;
  return is_of_mechanism(device) && !has_damper_loop(device.loop()) &&
         device.degrees_of_freedom() <= most_bodies_for_absolute_stability;
}

}  // namespace

std::optional<OptionProblem> find_problem(const RegionOptions& options) {
  const double deviation = options.outline.deviation;
  if (!(deviation > 0.0 && deviation < 1.0)) {
    return option_problem("outline.deviation", {.code = ProblemCode::no_fraction, .evidence = {{"value", deviation}}});
  }
  return std::nullopt;
}

WallRegion region(const Device& device, const RegionOptions& options) {
  require_valid(find_problem(options));
  WallRegion result;
  StagedProgress stages(options.progress);
  result.trust = trust_of(device);
  if (result.trust.refused()) return result;
  try {
    stages.next(limits_share);
    result.limits = holding_limits(device, {.any_user = asks_any_user(device, options), .progress = stages.stage()});
    stages.next(asks_any_user(device, options) ? walls_share : 0.95);
    const bool is_held = device_has_user(device);
    StagedProgress holders(stages.stage());
    holders.next(is_held ? 0.5 : 1.0);
    FoundWalls found = find_walls(device, options.outline, result, holders.stage());
    result.walls = std::move(found.walls);
    result.region = std::move(found.region);
    if (is_held && !result.trust.refused()) {
      holders.next(1.0);
      add_nobody(zwidth::device_without_user(device), options.outline, result, holders.stage());
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    refuse(result, {.code = FindingCode::region_not_converged, .subjects = {{"reason", error.what()}}});
  }
  if (result.trust.refused()) return result;
  using enum WallRegion::Status;
  result.status = !result.region.bounded ? unbounded : result.region.components.empty() ? none_stable : bounded;
  const ModalForm form = form_of(device);
  result.modes = form.modes;
  result.suspended_rigid_body = form.suspended_rigid_body;
  if (const double resolution = device.parameters().sensor.resolution; resolution > 0.0) {
    const double period = damper_timing(device.loop()).sampling_period;
    result.force_per_count = force_per_count_rates(device.parameters().wall, period, resolution);
  }
  if (asks_any_user(device, options) && result.region.most_damped && result.region.most_damped->damping > 0.0) {
    if (!bounds_all_users(device)) {
      result.remarks.push_back(left_out_beside_damper_loop("any_user"));
    } else if (device.degrees_of_freedom() <= most_bodies_for_absolute_stability) {
      stages.next(0.95);
      result.any_user = absolute_stability_region(device, result.nobody ? *result.nobody->walls : *result.walls,
                                                  result.region.most_damped->damping, {.progress = stages.stage()});
      if (result.any_user->trust.refused()) {
        result.any_user.reset();
      } else {
        result.trust.inherit(result.any_user->trust);
      }
      if (has_damper_loop(device.loop())) result.remarks.push_back(any_user_limit_scanned(device.loop()));
    } else {
      result.remarks.push_back(note({.code = FindingCode::too_many_bodies_for_any_user_region,
                                     .evidence = {{"bodies", static_cast<double>(device.degrees_of_freedom())},
                                                  {"most", static_cast<double>(most_bodies_for_absolute_stability)}}}));
    }
  }
  if (options.any_user && device.parameters().coordinates) {
    for (Remark& each : any_grasp_remarks(device, result.any_user.has_value())) {
      result.remarks.push_back(std::move(each));
    }
  }
  stages.next(1.0);
  if (options.approximations) result.approximations = compared(device, result);
  stages.done();
  return result;
}

WallRaster wall_raster(const WallRegion& region, std::size_t count) {
  if (count == 0) throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::raster_without_walls});
  if (region.status != WallRegion::Status::bounded) return {};
  const auto middles = [count](double largest) {
    constexpr double beyond = 1.1;
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = beyond * largest * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    }
    return values;
  };
  WallRaster raster{middles(region.region.stiffest->stiffness), middles(region.region.most_damped->damping), {}};
  raster.stable = stable_on_grid(*region.walls, raster.stiffnesses, raster.dampings);
  if (!region.nobody) return raster;
  const std::vector<std::uint8_t> alone = stable_on_grid(*region.nobody->walls, raster.stiffnesses, raster.dampings);
  std::ranges::transform(raster.stable, alone, raster.stable.begin(), std::bit_and());
  return raster;
}

}  // namespace zwidth

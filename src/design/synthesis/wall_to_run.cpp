#include "zwidth/design/wall_to_run.hpp"

#include <cmath>
#include <utility>

#include "zwidth/model/mechanism_key.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
namespace {

Device with_stiffness(const Device& device, double stiffness) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.stiffness = stiffness;
  return Device(std::move(parameters));
}

}  // namespace

std::optional<OptionProblem> find_problem(const WallToRunOptions& options, const Device& device) {
  if (options.stiffness && options.safety_factor) {
    return option_problem("safety_factor", {.code = ProblemCode::stiffness_given_twice});
  }
  if (options.stiffness && !(std::isfinite(*options.stiffness) && *options.stiffness > 0.0)) {
    return option_problem("stiffness",
                          {.code = ProblemCode::not_finite_and_positive,
                           .evidence = {{"value", *options.stiffness}},
                           .subjects = {{"in", std::string(units_of(device.parameters().motion).stiffness)}}});
  }
  if (options.stiffness) {
    DeviceParameters parameters = device.parameters();
    parameters.wall.stiffness = options.stiffness;
    if (const auto problem = find_problem(parameters)) {
      return option_problem(
          "stiffness", {.code = ProblemCode::of_the_device,
                        .subjects = {{"key", problem->key}, {"what", problem->what}, {"allowed", problem->allowed}}});
    }
  }
  if (options.safety_factor) return find_problem(SafeWallOptions{.safety_factor = *options.safety_factor});
  if (!options.stiffness && !device.parameters().wall.stiffness) {
    return option_problem("wall.stiffness", {.code = ProblemCode::no_wall_to_write});
  }
  return std::nullopt;
}

WallToRun wall_to_run(const Device& device, const WallToRunOptions& options) {
  require_one_direction(device);
  require_valid(find_problem(options, device));
  WallToRun result{.device = device};
  if (options.safety_factor) {
    result.share = safe_wall(device, {.safety_factor = *options.safety_factor});
    if (result.share->status != SafeWall::Status::chosen) {
      result.analysis.trust = result.share->trust;
      return result;
    }
    result.device = with_stiffness(device, result.share->stiffness);
  } else if (options.stiffness) {
    result.device = with_stiffness(device, *options.stiffness);
  }
  result.analysis = analyze(result.device, {.any_user_draws = 0});
  if (result.share) result.analysis.trust.inherit(result.share->trust);
  const Trust& trust = result.analysis.trust;
  result.released = !trust.refused() && (trust.sound() || options.accept_doubt);
  return result;
}

}  // namespace zwidth

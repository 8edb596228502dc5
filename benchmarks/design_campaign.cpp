// What a notch, a recommendation and the values for a target cost on random devices.
//
//   design_campaign notch|recommend|target|target_any_user [COUNT [FIRST [SECONDS [BODIES]]]]
//
// One line per device that took longer than SECONDS of all cores (0: all), with its answer to all digits so that two builds can be
// compared, of devices with BODIES or more (0: all); then median and worst by the number of bodies.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "property/random_devices.hpp"
#include "property/random_notch_options.hpp"
#include "zwidth/words/finding_text.hpp"
#include "zwidth/zwidth.hpp"

namespace {

using namespace zwidth;

constexpr std::uint64_t seed = 20261124;
constexpr std::array kinds = {"two_mass",   "three_mass",   "light_damping",    "virtual_damper", "slow_sampling",
                              "grounded",   "user_side",    "fractional_delay", "operator",       "rotary",
                              "chain",      "actuator_lag", "filtered_damper",  "long_delay",     "wall_filter",
                              "everything", "fast_sampling"};

std::string notch(const Device& device, test::RandomDevices& random) {
  const NotchOptions options = test::random_notch_options(random);
  if (find_problem(options, device)) return "not asked";
  const NotchDesign design = design_notch(device, options);
  const WallFilter filter = design.notch.value_or(WallFilter{});
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), "phase %.2f drift %.2f: %.12g %.12g at %.12g Hz, %.12g, %.12g",
                options.phase_margin, options.modal_frequency_uncertainty, design.without, design.with,
                design.notch ? filter.frequency_hz : 0.0, filter.damping_ratio, filter.depth);
  return text.data();
}

std::string recommendation(Device device, test::RandomDevices& random) {
  DeviceParameters parameters = device.parameters();
  if (random.chance(0.7)) parameters.sensor.resolution = random.log_uniform(1e-7, 1e-4);
  RecommendationOptions options;
  options.goal = std::array{WallGoal::stiffness, WallGoal::width, WallGoal::critical_damping}[random.index(3)];
  if (random.chance(0.5)) options.quantisation_force = random.log_uniform(1e-3, 1.0);
  const WallRecommendation answer = recommend_wall(Device(parameters), options);
  if (!answer.wall) return text(answer.reason);
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), "%.12g %.12g %.12g, notch at %.12g Hz, %zu alternatives, %s",
                *answer.wall->wall.stiffness, answer.wall->wall.damping, answer.wall->wall.velocity_filter_hz,
                answer.wall->notch ? answer.wall->notch->frequency_hz : 0.0, answer.alternatives.size(),
                answer.trust.sound() ? "sound" : "not sound");
  return text.data();
}

std::string target(const Device& device, StiffnessGoal goal, double share) {
  const Analysis analysis = analyze(device, {.any_user = goal == StiffnessGoal::absolute_stability_limit, .draws = 0});
  double now = analysis.critical.stiffness;
  if (goal == StiffnessGoal::absolute_stability_limit)
    now = std::min(now, analysis.any_user ? analysis.any_user->stiffness : 0.0);
  if (analysis.critical.trust.refused() || !(now > 0.0) || !std::isfinite(now)) return "not asked";
  std::string text;
  for (const DesignTarget& each : design_targets(device, {.stiffness = share * now, .goal = goal}).targets) {
    std::array<char, 200> value{};
    std::snprintf(value.data(), value.size(), " %s %.12g", each.key.c_str(), each.value_needed.value_or(0.0));
    text += value.data();
  }
  return text;
}

std::string answer(std::string_view what, const Device& device, test::RandomDevices& random) {
  if (what == "notch") return notch(device, random);
  if (what == "recommend") return recommendation(device, random);
  const StiffnessGoal goal =
      what == "target" ? StiffnessGoal::critical_stiffness : StiffnessGoal::absolute_stability_limit;
  return target(device, goal, random.log_uniform(0.3, 3.0));
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "notch";
  const auto count = static_cast<std::size_t>(argc > 2 ? std::atoll(argv[2]) : 100);
  const auto first = static_cast<std::size_t>(argc > 3 ? std::atoll(argv[3]) : 0);
  const double worth_a_line = argc > 4 ? std::atof(argv[4]) : 0.0;
  const auto fewest_bodies = static_cast<std::size_t>(argc > 5 ? std::atoll(argv[5]) : 0);
  std::map<std::size_t, std::vector<double>> times;
  for (std::size_t i = first; i < first + count; ++i) {
    test::RandomDevices random(seed + i);
    const std::string kind = kinds[i % kinds.size()];
    const Device device(random.device(kind));
    if (device.bodies().size() < fewest_bodies) continue;
    const std::clock_t begin = std::clock();
    const std::string found = answer(what, device, random);
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    if (found == "not asked") continue;
    times[device.bodies().size()].push_back(seconds);
    if (seconds < worth_a_line) continue;
    std::printf("%zu %s, %zu bodies: %.3f s; %s\n", i, kind.c_str(), device.bodies().size(), seconds, found.c_str());
    std::fflush(stdout);
  }
  for (auto& [bodies, seconds] : times) {
    std::ranges::sort(seconds);
    std::printf("%zu bodies: %zu devices, median %.3f s, 90 %% %.3f s, worst %.3f s\n", bodies, seconds.size(),
                seconds[seconds.size() / 2], seconds[seconds.size() * 9 / 10], seconds.back());
  }
}

#include <algorithm>

#include "identification/model/rivals/catalogue.hpp"
#include "identification/model/segment_player.hpp"

namespace zwidth::internal {
namespace {

// Half of the held body's mass, at one sigma: a grip on a handle, a cover, a finger's tip. An assumption.
constexpr double mass_ratio_typical = 1.0;
constexpr double mass_ratio_deviation = 0.5;
constexpr double mass_ratio_start = 0.02;
// 1.3 to 7 times the highest frequency at one sigma: lower, and the record had shown it. An assumption.
constexpr double times_highest = 3.0;
constexpr double frequency_deviation = 0.85;
// 0.002 to 0.05 at one sigma: modes of metal and of bolted structures. An assumption.
constexpr double damping_ratio_typical = 0.01;
constexpr double damping_ratio_deviation = 1.6;

/// One more body behind the held one, swinging above what the record tells of (FurtherBody).
void add_further_body(const RivalSetting& setting, ModelParts& parts) {
  const std::string& held = setting.device.bodies[setting.device.loop.held].name;
  const std::vector<std::string> moving = moving_bodies_of(setting);
  const bool has_room = moving.size() < static_cast<std::size_t>(SegmentPlayer::most_bodies);
  if (!has_room || parts.further_body || std::ranges::find(moving, held) == moving.end()) return;
  using Scale = Number::Scale;
  parts.further_body = {.behind = held,
                        .mass_ratio = parts.add({"further_body.mass_ratio", Scale::not_negative, mass_ratio_typical,
                                                 0.0, mass_ratio_deviation, mass_ratio_start}),
                        .frequency = parts.add({"further_body.frequency", Scale::logarithmic,
                                                times_highest * setting.highest_frequency, 0.0, frequency_deviation}),
                        .damping_ratio = parts.add({"further_body.damping_ratio", Scale::logarithmic,
                                                    damping_ratio_typical, 0.0, damping_ratio_deviation})};
}

}  // namespace

Rival further_body() { return {"further_body", add_further_body, RivalMeasure::ratio}; }

}  // namespace zwidth::internal

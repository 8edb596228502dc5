#include "identification/fit_method.hpp"

#include <algorithm>
#include <cstddef>

#include "counted.hpp"
#include "identification/model/segment_player.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t least_samples_of_motion = 300;
constexpr auto most_bodies_of_motion = static_cast<std::size_t>(SegmentPlayer::most_bodies);

}  // namespace

bool knows_structure(const IdentifyOptions& options) {
  return options.structure_values == IdentifyOptions::StructureValues::known;
}

bool frees_lateness(const IdentifyOptions& options) {
  using enum IdentifyOptions::LoopDelay;
  return options.loop_delay == by_free ? frees_all(options.fit.free) : options.loop_delay == from_data;
}

IdentifyOptions::Method fit_method(std::span<const Recording> recordings, const Device& structure,
                                   const IdentifyOptions& options) {
  const bool is_long = std::ranges::all_of(recordings, [](const Recording& each) {
    return each.channels.size() == 2 && each.channels[1].samples.size() >= least_samples_of_motion;
  });
  const bool has_motion = options.response.output == OutputQuantity::position && is_long &&
                          structure.bodies().size() <= most_bodies_of_motion;
  return options.method.value_or(has_motion ? IdentifyOptions::Method::motion : IdentifyOptions::Method::lines);
}

void require_motion(std::span<const Recording> recordings, const Device& structure, const IdentifyOptions& options) {
  if (options.method != IdentifyOptions::Method::motion) return;
  if (structure.bodies().size() > most_bodies_of_motion)
    refuse_member("method",
                  {.code = ProblemCode::motion_not_fitted,
                   .evidence = {counted("bodies", structure.bodies().size()), counted("most", most_bodies_of_motion)}});
  for (const Recording& each : recordings) {
    if (each.channels.size() == 2 && each.channels[1].samples.size() < least_samples_of_motion)
      refuse_member("method", {.code = ProblemCode::motion_not_fitted,
                               .evidence = {counted("samples", each.channels[1].samples.size()),
                                            counted("least", least_samples_of_motion)}});
  }
}

}  // namespace zwidth::internal

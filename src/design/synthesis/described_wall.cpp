#include "design/synthesis/described_wall.hpp"

#include <string>
#include <utility>

namespace zwidth::internal {

void add_alternative(RecommendedWall wall, const Trust& trust, WallRecommendation& result) {
  if (trust.refused()) {
    result.trust.doubt({.code = FindingCode::alternative_left_out,
                        .subjects = {{"what", std::string(words_of(wall.kind))}, {"reason", trust.reasons.front()}}});
    return;
  }
  result.trust.inherit(trust);
  result.alternatives.push_back(std::move(wall));
}

void remark_on_resolution(const Device& device, const RecommendationOptions& options, WallRecommendation& result) {
  if (device.parameters().sensor.resolution > 0.0) return;
  Finding finding{
      .code = FindingCode::force_per_count_unknown, .subjects = {{"what", "wall"}}, .key = "sensor.resolution"};
  result.remarks.push_back(options.quantisation_force ? warning(std::move(finding)) : note(std::move(finding)));
}

}  // namespace zwidth::internal

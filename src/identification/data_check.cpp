#include "identification/data_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "identification/response/plausibility.hpp"
#include "identification/verdict/turned_sign.hpp"
#include "zwidth/identification/parameter_fit.hpp"

namespace zwidth::internal {

std::vector<Finding> doubts_of_recordings(std::span<const Recording> recordings, const Device& structure,
                                          const IdentifyOptions& options) {
  std::vector<Finding> doubts;
  for (const Recording& each : recordings) {
    std::ranges::move(doubts_of_recording(each, recordings, options.response.output, structure),
                      std::back_inserter(doubts));
  }
  return doubts;
}

VerdictInput before_fit(const MeasuredResponse& measured, const Device& structure, std::vector<Finding> doubts) {
  VerdictInput fit{.motion = structure.parameters().motion, .doubts_of_data = std::move(doubts)};
  if (auto turned = turned_sign(measured.response)) fit.contradictions.push_back(*std::move(turned));
  for (const Finding& each : measured.trust.findings) {
    if (each.code == FindingCode::clipped_for_response) fit.doubts_of_data.push_back(each);
  }
  return fit;
}

bool is_drowned(const FrequencyResponse& response, const Device& structure, const IdentifyOptions& options) {
  constexpr double clear = 3.0;
  const auto standing_out = std::ranges::count_if(response.points, [](const ResponsePoint& point) {
    return std::norm(point.value) > clear * clear * point.variance;
  });
  return 2 * static_cast<std::size_t>(standing_out) <
         free_parameters(structure, options.fit.free, options.fit.locked).size();
}

bool follows_force(std::span<const FittedMotion> motions) {
  constexpr double most = 0.1;
  return std::ranges::all_of(motions, [](const FittedMotion& each) { return each.unexplained < most; });
}

}  // namespace zwidth::internal

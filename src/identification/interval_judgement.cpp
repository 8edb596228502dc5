#include "identification/interval_judgement.hpp"

#include <string>
#include <utility>

#include "identification/interval_narrowing.hpp"
#include "identification/ringing_mode.hpp"
#include "identification/unseen_limit.hpp"

namespace zwidth::internal {

std::optional<Device> judge_interval(Identification& result, bool is_measured, std::span<const Recording> recordings,
                                     const IdentifyOptions& options) {
  const Device as_fitted = result.fit.device;
  const Analysis as_analysed = result.analysis;
  if (is_measured) narrow_interval(result);
  if (auto ringing = doubt_of_ringing(result, recordings, options)) result.trust.doubt(*std::move(ringing));
  if (auto doubt = doubt_of_interval(result)) result.trust.doubt(*std::move(doubt));
  if (!result.trust.sound()) return std::nullopt;
  std::optional<Device> better = judge_unseen_limit(result, as_fitted, options);
  if (result.trust.sound()) return better;
  // Another crossover may limit: what is open is open.
  result.fit.device = as_fitted;
  result.analysis = as_analysed;
  return better;
}

}  // namespace zwidth::internal

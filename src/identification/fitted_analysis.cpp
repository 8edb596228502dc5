#include <utility>

#include "identification/device_file_trust.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"

namespace zwidth {
namespace {

/// Of a refused fit no limit is held. The device says the trust in one sentence, so that the fit's own stands instead, unless the
/// limit itself is trusted less.
Analysis judged_analysis(const Device& device, Trust trust, const AnalysisOptions& options) {
  Analysis analysis = analyze(internal::with_trust(device, trust), options);
  if (analysis.trust.verdict > trust.verdict) trust.inherit(analysis.trust);
  analysis.trust = std::move(trust);
  return analysis;
}

}  // namespace

Analysis analyze_fit(const Identification& identified) {
  return judged_analysis(identified.fit.device, identified.trust, {.draws = 0, .any_user_draws = 0});
}

Analysis analyze_fit(const RigidBodyIdentification& identified) {
  return judged_analysis(identified.device, identified.trust, {});
}

}  // namespace zwidth

#include "zwidth/model/device_trust.hpp"

#include <algorithm>
#include <string>

#include "model/uncertainty_problem.hpp"

namespace zwidth {

Trust trust_of(const Device& device) {
  Trust trust;
  const std::optional<Uncertainty>& uncertainty = device.parameters().uncertainty;
  if (!uncertainty) return trust;
  Trust written{std::max(uncertainty->verdict, Trust::Verdict::doubtful), uncertainty->reasons};
  if (!uncertainty->warning.empty()) written.reasons.insert(written.reasons.begin(), uncertainty->warning);
  if (!uncertainty->assumed.empty()) written.reasons.push_back(internal::assumed_reason(uncertainty->assumed));
  if (written.reasons.empty() && uncertainty->verdict != Trust::Verdict::sound) {
    written.reasons.emplace_back("the device file says so, without a reason: measure or identify the device again");
  }
  trust.inherit(written);
  return trust;
}

}  // namespace zwidth

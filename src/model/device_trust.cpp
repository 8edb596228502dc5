#include "zwidth/model/device_trust.hpp"

#include <string>
#include <utility>

#include "model/uncertainty_problem.hpp"

namespace zwidth {

Trust trust_of(const Device& device) {
  Trust trust;
  const std::optional<Uncertainty>& uncertainty = device.parameters().uncertainty;
  if (!uncertainty) return trust;
  const auto add = [&](Finding finding) {
    uncertainty->verdict == Trust::Verdict::refused ? trust.refuse(std::move(finding))
                                                    : trust.doubt(std::move(finding));
  };
  const auto stated = [](const std::string& reason) {
    return Finding{.code = FindingCode::stated, .subjects = {{"reason", reason}}, .key = "uncertainty"};
  };
  if (!uncertainty->warning.empty()) add(stated(uncertainty->warning));
  for (const std::string& reason : uncertainty->reasons) add(stated(reason));
  if (!uncertainty->assumed.empty()) add(internal::assumed_numbers(uncertainty->assumed));
  if (trust.sound() && uncertainty->verdict != Trust::Verdict::sound) {
    add({.code = FindingCode::untrusted_without_reason, .key = "uncertainty"});
  }
  return trust;
}

}  // namespace zwidth

#include "identification/device_file_trust.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "model/uncertainty_problem.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::internal {

Device with_trust(const Device& device, const Trust& trust) {
  if (trust.sound()) return device;
  DeviceParameters parameters = device.parameters();
  if (!parameters.uncertainty) parameters.uncertainty.emplace();
  parameters.uncertainty->verdict = trust.verdict;
  parameters.uncertainty->warning = fmt::format("{}", fmt::join(trust.reasons, "; "));
  return Device(std::move(parameters));
}

Device with_reason(const Device& device, const Finding& finding) {
  DeviceParameters parameters = device.parameters();
  if (!parameters.uncertainty) parameters.uncertainty.emplace();
  parameters.uncertainty->reasons.push_back(text(finding));
  return Device(std::move(parameters));
}

std::vector<std::string> unseen_placeholders(const std::vector<std::string>& locked) {
  std::vector<std::string> keys;
  for (const std::string& body : locked) {
    for (const char* number : {"mass", "damping"}) keys.push_back(fmt::format("body.{}.{}", body, number));
  }
  return keys;
}

void keep_what_is_assumed(const Device& structure, std::span<const ParameterEstimate> estimates,
                          std::vector<std::string> placeholders, Device& fitted, Trust& trust) {
  const DeviceParameters& given = structure.parameters();
  const auto is_identified = [&](const std::string& key) {
    return std::ranges::any_of(estimates, [&](const ParameterEstimate& each) {
      return each.identifiable && each.key == full_parameter_key(given, key);
    });
  };
  const auto is_taken = [&](const std::string& key) {
    const bool is_of_the_mechanics = key.starts_with("body.") || key.starts_with("link.");
    return is_of_the_mechanics && !key.ends_with(".coulomb") && parameter(given, key).value_or(0.0) != 0.0 &&
           !is_identified(key);
  };
  std::vector<std::string> assumed = std::move(placeholders);
  if (given.uncertainty) {
    const std::vector<std::string>& of_structure = given.uncertainty->assumed;
    Trust stated = trust_of(structure);
    if (!of_structure.empty()) {
      std::erase(stated.reasons, text(assumed_numbers(of_structure)));
      std::erase_if(stated.findings, [](const Finding& each) { return each.code == FindingCode::assumed_numbers; });
    }
    if (!stated.reasons.empty() && std::ranges::any_of(parameter_keys(given), is_taken)) trust.inherit(stated);
    for (const std::string& each : of_structure) {
      const std::string key = full_parameter_key(given, each);
      if (std::ranges::find(assumed, key) == assumed.end()) assumed.push_back(key);
    }
  }
  std::erase_if(assumed, is_identified);
  if (assumed.empty()) return;
  trust.doubt(assumed_numbers(assumed));
  DeviceParameters parameters = fitted.parameters();
  if (!parameters.uncertainty) parameters.uncertainty.emplace();
  parameters.uncertainty->assumed = std::move(assumed);
  fitted = Device(std::move(parameters));
}

}  // namespace zwidth::internal

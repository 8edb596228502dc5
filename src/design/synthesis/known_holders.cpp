#include "design/synthesis/known_holders.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "zwidth/model/device_user.hpp"

namespace zwidth::internal {
namespace {

constexpr std::string_view of_user = "operator.";

/// Without the rows and columns of the user's numbers; absent where nothing is left to say.
std::optional<Uncertainty> without_user(const Uncertainty& given) {
  Uncertainty kept = given;
  kept.parameters.clear();
  kept.covariance.clear();
  const auto stays = [&](std::size_t i) { return !given.parameters[i].starts_with(of_user); };
  for (std::size_t i = 0; i < given.parameters.size(); ++i) {
    if (!stays(i)) continue;
    kept.parameters.push_back(given.parameters[i]);
    std::vector<double> row;
    for (std::size_t j = 0; j < given.parameters.size(); ++j) {
      if (stays(j)) row.push_back(given.covariance[i][j]);
    }
    kept.covariance.push_back(std::move(row));
  }
  std::erase_if(kept.assumed, [](const std::string& key) { return key.starts_with(of_user); });
  const bool says_nothing = kept.parameters.empty() && kept.warning.empty() && kept.reasons.empty() &&
                            kept.assumed.empty() && kept.verdict == Trust::Verdict::sound;
  return says_nothing ? std::nullopt : std::optional(std::move(kept));
}

}  // namespace

std::vector<Device> known_holders(const Device& device) {
  if (!device_has_user(device)) return {device};
  DeviceParameters parameters = device.parameters();
  parameters.user = {};
  if (parameters.uncertainty) parameters.uncertainty = without_user(*parameters.uncertainty);
  return {Device(std::move(parameters)), device};
}

}  // namespace zwidth::internal

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "model/option_beyond.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/model/device_key.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
namespace {

const std::map<std::string_view, std::vector<std::string>>& bodies_by_name() {
  static const std::map<std::string_view, std::vector<std::string>> bodies{
      {"rigid", {"body"}}, {"two-body", {"motor", "handle"}}, {"three-body", {"motor", "body", "handle"}}};
  return bodies;
}

}  // namespace

bool names_structure(std::string_view name) { return bodies_by_name().contains(name); }

std::optional<OptionProblem> find_problem(const NamedStructureOptions& options) {
  constexpr const char* member = "sampling_period";
  if (!options.sampling_period && !options.record_period) {
    return option_problem(member, {.code = ProblemCode::no_period_of_table});
  }
  for (const std::optional<double>& each : {options.sampling_period, options.record_period}) {
    if (!each) continue;
    if (auto problem = internal::option_beyond(member, *each, positive_numbers, "s")) return problem;
  }
  return std::nullopt;
}

std::optional<NamedStructure> named_structure(std::string_view name, const NamedStructureOptions& options) {
  const auto named = bodies_by_name().find(name);
  if (named == bodies_by_name().end()) return std::nullopt;
  require_valid(find_problem(options));
  DeviceParameters device;
  device.name = name;
  device.motion = options.motion.value_or(options.record_motion.value_or(Motion::linear));
  for (const std::string& body : named->second) {
    if (!device.bodies.empty()) device.links.push_back({device.bodies.size() - 1, device.bodies.size(), 1.0, 1.0});
    device.bodies.push_back({body, 1.0, 1.0, 0.0, 0.0});
  }
  device.loop.held = device.bodies.size() - 1;
  device.loop.sampling_period = options.sampling_period ? *options.sampling_period : *options.record_period;
  return NamedStructure{std::move(device)};
}

}  // namespace zwidth

#include "zwidth/model/parameter.hpp"

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

/// The numbers that the filter's kind has.
template <typename Filter, typename Visitor>
void visit_filter(const std::string& key, Filter& filter, Visitor&& visit) {
  using enum WallFilter::Kind;
  if (filter.kind == digital || (filter.kind == biquad && filter.frequency_hz == 0.0)) return;
  visit(key + ".frequency_hz", filter.frequency_hz);
  if (filter.kind == notch || (filter.kind == low_pass && filter.order == 2)) {
    visit(key + ".damping_ratio", filter.damping_ratio);
  }
  if (filter.kind == notch) visit(key + ".depth", filter.depth);
  if (filter.kind == lead_lag) visit(key + ".ratio", filter.ratio);
}

/// Calls visit(key, member) for every number that a key names; a member is a double or an optional<double>.
template <typename Parameters, typename Visitor>
void visit_parameters(Parameters& parameters, Visitor&& visit) {
  for (auto& body : parameters.bodies) {
    const std::string key = "body." + body.name;
    visit(key + ".mass", body.mass);
    visit(key + ".damping", body.damping);
    visit(key + ".stiffness", body.stiffness);
    visit(key + ".coulomb", body.coulomb);
  }
  for (std::size_t k = 0; k < parameters.links.size(); ++k) {
    const std::string key = "link." + std::to_string(k);
    visit(key + ".stiffness", parameters.links[k].stiffness);
    visit(key + ".damping", parameters.links[k].damping);
  }
  visit("loop.sampling_period", parameters.loop.sampling_period);
  visit("loop.delay", parameters.loop.delay);
  visit("actuator.time_constant", parameters.actuator.time_constant);
  visit("actuator.force_limit", parameters.actuator.force_limit);
  visit("sensor.resolution", parameters.sensor.resolution);
  visit("wall.stiffness", parameters.wall.stiffness);
  visit("wall.damping", parameters.wall.damping);
  visit("wall.velocity_filter_hz", parameters.wall.velocity_filter_hz);
  for (std::size_t k = 0; k < parameters.wall.filters.size(); ++k) {
    visit_filter("wall.filter." + std::to_string(k), parameters.wall.filters[k], visit);
  }
  if (parameters.transfer_function) return;
  visit("operator.mass", parameters.user.mass);
  visit("operator.damping", parameters.user.damping);
  visit("operator.stiffness", parameters.user.stiffness);
}

}  // namespace

std::string without_alias(std::string_view key) {
  constexpr std::string_view inertia = ".inertia";
  if (!key.ends_with(inertia)) return std::string(key);
  return std::string(key.substr(0, key.size() - inertia.size())) + ".mass";
}

std::string full_parameter_key(const DeviceParameters& parameters, std::string_view key) {
  constexpr std::string_view prefix = "link.";
  if (parameters.links.size() == 1 && (key == "link.stiffness" || key == "link.damping")) {
    return "link.0." + std::string(key.substr(prefix.size()));
  }
  constexpr std::string_view filter = "wall.filter.";
  if (parameters.wall.filters.size() == 1 && key.starts_with(filter) && key.find('.', filter.size()) == key.npos) {
    return "wall.filter.0." + std::string(key.substr(filter.size()));
  }
  return without_alias(key);
}

std::vector<std::string> parameter_keys(const DeviceParameters& parameters) {
  std::vector<std::string> keys;
  visit_parameters(parameters, [&](const std::string& key, const auto&) { keys.push_back(key); });
  return keys;
}

std::optional<double> parameter(const DeviceParameters& parameters, std::string_view key) {
  std::optional<double> found;
  const std::string wanted = full_parameter_key(parameters, key);
  visit_parameters(parameters, [&](const std::string& each, const auto& value) {
    if (each == wanted) found = value;
  });
  return found;
}

void set_parameter(DeviceParameters& parameters, std::string_view key, double value) {
  bool found = false;
  const std::string wanted = full_parameter_key(parameters, key);
  visit_parameters(parameters, [&](const std::string& each, auto& member) {
    if (each != wanted) return;
    member = value;
    found = true;
  });
  if (!found) throw Error(ErrorCode::invalid_argument, "no parameter is called " + wanted);
}

}  // namespace zwidth

#include "zwidth/model/parameter.hpp"

#include <fmt/format.h>

#include <map>
#include <string>
#include <type_traits>
#include <utility>

#include "model/key_members.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/mechanism_key.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// The numbers of the mechanism's file, and those that are others here; what a visitor changes is another from then on.
template <typename File, typename Visitor>
void visit_file_numbers(File& mechanism, const Visitor& visit) {
  std::map<std::string, double> numbers = mechanism.numbers;
  for (const auto& [key, number] : mechanism.file_numbers) numbers.emplace(key, number.value);
  for (auto& [key, value] : numbers) {
    const double before = value;
    const MechanismNumberName of(key);
    visit(fmt::format("{}.{}.{}", path_of(DeviceTable::mechanism), of.kind, of.part), of.attribute, value);
    if constexpr (!std::is_const_v<File>) {
      if (value != before) mechanism.numbers[key] = value;
    }
  }
}

/// Calls visit(path, name, member) for every number that a key names; a member is a double or an optional<double>.
template <typename Parameters, typename Visitor>
void visit_parameters(Parameters& parameters, Visitor&& visit) {
  const auto visit_table = [&](DeviceTable kind, const std::string& path, auto& table) {
    visit_members(kind, table, [&](const DeviceKey& key, auto& member) {
      if constexpr (is_real_number<std::remove_reference_t<decltype(member)>>) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(table)>, WallFilter>) {
          if (!is_number_of(table, key.name)) return;
        }
        visit(path, key.name, member);
      }
    });
  };
  const auto visit_tables = [&](DeviceTable kind, auto& tables) {
    for (std::size_t k = 0; k < tables.size(); ++k) {
      visit_table(kind, fmt::format("{}.{}", path_of(kind), k), tables[k]);
    }
  };
  for (auto& body : parameters.bodies) visit_table(DeviceTable::body, "body." + body.name, body);
  visit_tables(DeviceTable::link, parameters.links);
  if (parameters.mechanism) {
    auto& mechanism = parameters.mechanism->mechanism;
    for (auto& [joint, position] : mechanism.pose) visit(path_of(DeviceTable::mechanism_pose), joint, position);
    visit_file_numbers(mechanism, visit);
    visit_tables(DeviceTable::transmission, mechanism.transmissions);
  }
  visit_table(DeviceTable::loop, "loop", parameters.loop);
  // A damper that has no numbers of its own is none.
  LoopDamper damper = parameters.loop.damper.value_or(LoopDamper{});
  visit_table(DeviceTable::loop_damper, "loop.damper", damper);
  if constexpr (!std::is_const_v<Parameters>) {
    if (damper.sampling_period || damper.delay) parameters.loop.damper = damper;
  }
  visit_table(DeviceTable::actuator, "actuator", parameters.actuator);
  visit_table(DeviceTable::sensor, "sensor", parameters.sensor);
  visit_table(DeviceTable::wall, "wall", parameters.wall);
  visit_tables(DeviceTable::filter, parameters.wall.filters);
  if (!parameters.transfer_function) visit_table(DeviceTable::user, "operator", parameters.user);
}

/// Whether that is path.name.
bool is_key(std::string_view wanted, const std::string& path, std::string_view name) {
  return wanted.size() == path.size() + 1 + name.size() && wanted.starts_with(path) && wanted[path.size()] == '.' &&
         wanted.ends_with(name);
}

}  // namespace

std::string without_alias(std::string_view key) {
  constexpr std::string_view inertia = ".inertia";
  if (!key.ends_with(inertia) || is_key_of_mechanism(key)) return std::string(key);
  return std::string(key.substr(0, key.size() - inertia.size())) + ".mass";
}

std::string full_parameter_key(const DeviceParameters& parameters, std::string_view key) {
  const std::size_t motors = parameters.mechanism ? parameters.mechanism->mechanism.transmissions.size() : 0;
  for (const auto& [prefix, count] : {std::pair{std::string_view("link."), parameters.links.size()},
                                      std::pair{std::string_view("transmission."), motors},
                                      std::pair{std::string_view("wall.filter."), parameters.wall.filters.size()}}) {
    if (count == 1 && key.starts_with(prefix) && key.find('.', prefix.size()) == std::string_view::npos) {
      return fmt::format("{}0.{}", prefix, key.substr(prefix.size()));
    }
  }
  return without_alias(key);
}

Device Device::with(std::string_view key, double value) const {
  DeviceParameters changed = parameters_;
  set_parameter(changed, key, value);
  return Device(std::move(changed));
}

std::vector<std::string> parameter_keys(const DeviceParameters& parameters) {
  std::vector<std::string> keys;
  visit_parameters(parameters, [&](const std::string& path, std::string_view name, const auto&) {
    keys.push_back(fmt::format("{}.{}", path, name));
  });
  return keys;
}

std::optional<double> parameter(const DeviceParameters& parameters, std::string_view key) {
  std::optional<double> found;
  const std::string wanted = full_parameter_key(parameters, key);
  visit_parameters(parameters, [&](const std::string& path, std::string_view name, const auto& value) {
    if (is_key(wanted, path, name)) found = value;
  });
  return found;
}

void set_parameter(DeviceParameters& parameters, std::string_view key, double value) {
  bool found = false;
  const std::string wanted = full_parameter_key(parameters, key);
  visit_parameters(parameters, [&](const std::string& path, std::string_view name, auto& member) {
    if (!is_key(wanted, path, name)) return;
    member = value;
    found = true;
  });
  if (!found) {
    throw Error(ErrorCode::invalid_argument,
                Problem{.code = ProblemCode::no_parameter_of_device, .subjects = {{"name", wanted}}});
  }
  if (is_key_of_mechanism(wanted)) parameters.coordinates.reset();
}

}  // namespace zwidth

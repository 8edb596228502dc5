#include "zwidth/model/mechanism_key.hpp"

#include <string>

#include "zwidth/model/device_key.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {

bool is_key_of_mechanism(std::string_view key) {
  return key.starts_with("mechanism.") || key.starts_with("transmission.");
}

bool is_key_of_pose(std::string_view key) { return key.starts_with(path_of(DeviceTable::mechanism_pose) + "."); }

bool is_key_of_mechanism_file(std::string_view key) {
  return key.starts_with(path_of(DeviceTable::mechanism_joint) + ".") ||
         key.starts_with(path_of(DeviceTable::mechanism_tendon) + ".");
}

MechanismNumberName::MechanismNumberName(std::string_view key)
    : kind(key.substr(0, key.find('.'))),
      part(key.substr(kind.size() + 1, key.rfind('.') - kind.size() - 1)),
      attribute(key.substr(key.rfind('.') + 1)) {}

Motion motion_of_key(const DeviceParameters& parameters, std::string_view key) {
  if (!is_key_of_mechanism(key)) return parameters.motion;
  if (!parameters.mechanism) return Motion::rotary;
  const MechanismFile& file = parameters.mechanism->mechanism;
  if (is_key_of_mechanism_file(key)) {
    const auto number = file.file_numbers.find(std::string(key.substr(path_of(DeviceTable::mechanism).size() + 1)));
    return number == file.file_numbers.end() ? Motion::rotary : number->second.motion;
  }
  if (!is_key_of_pose(key)) return Motion::rotary;
  const auto& units = file.units_of_pose;
  const auto unit = units.find(std::string(key.substr(path_of(DeviceTable::mechanism_pose).size() + 1)));
  return unit == units.end() ? Motion::rotary : unit->second;
}

void require_one_direction(const Device& device) {
  if (is_point_wall(device)) refuse_key("mechanism.normal", {.code = ProblemCode::point_wall_not_known});
}

}  // namespace zwidth

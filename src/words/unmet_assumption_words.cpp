#include "zwidth/stability/unmet_assumption.hpp"

namespace zwidth {

std::string_view words_of(UnmetAssumption assumption) {
  switch (assumption) {
    case UnmetAssumption::flexible_links:
      return "flexible links";
    case UnmetAssumption::springs_to_ground:
      return "springs to ground";
    case UnmetAssumption::delay:
      return "a delay";
    case UnmetAssumption::actuator_lag:
      return "an actuator lag";
    case UnmetAssumption::tracking:
      return "a drive that tracks the position";
    case UnmetAssumption::velocity_filter:
      return "a velocity filter";
    case UnmetAssumption::virtual_damper:
      return "a virtual damper";
    case UnmetAssumption::wall_filters:
      return "filters in the wall";
    case UnmetAssumption::user_stiffness:
      break;
  }
  return "a user with stiffness";
}

std::vector<std::string> words_of(std::span<const UnmetAssumption> assumptions) {
  std::vector<std::string> words;
  for (const UnmetAssumption each : assumptions) words.emplace_back(words_of(each));
  return words;
}

}  // namespace zwidth

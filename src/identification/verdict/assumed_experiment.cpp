#include "identification/verdict/assumed_experiment.hpp"

#include "zwidth/model/device_user.hpp"

namespace zwidth::internal {

std::vector<Remark> assumptions_of_experiment(const Device& structure, bool is_known,
                                              const std::vector<std::string>& locked) {
  std::vector<Remark> remarks;
  if (device_has_user(structure)) {
    remarks.push_back(warning({.code = FindingCode::operator_taken_to_hold, .key = "operator"}));
  } else if (!is_known && locked.empty()) {
    remarks.push_back(note({.code = FindingCode::nobody_taken_to_hold}));
  }
  if (!is_known) remarks.push_back(note({.code = FindingCode::force_taken_for_command}));
  return remarks;
}

}  // namespace zwidth::internal

#include "rig/driver.hpp"

#include "zwidth/require_valid.hpp"
#include "zwidth/words/drive_problem_text.hpp"

namespace zwidth::rig {

DriverFailed::DriverFailed(DriveProblem found) : std::runtime_error(text(found)), problem(std::move(found)) {}

DriverFailed::DriverFailed(DriveProblemCode code, std::vector<Evidence> evidence, std::vector<Subject> subjects)
    : DriverFailed(DriveProblem{code, std::move(evidence), std::move(subjects)}) {}

OptionProblem no_damper_problem(std::string_view name) {
  return option_problem("damper_on_drive", {.code = ProblemCode::no_damper_of_its_own,
                                            .subjects = {{"drive", std::string(name.substr(0, name.find(':')))}}});
}

void Driver::close_damper(const Device& /*device*/, std::optional<double> /*force_limit*/) {
  require_valid(no_damper_problem(facts().name));
}

}  // namespace zwidth::rig

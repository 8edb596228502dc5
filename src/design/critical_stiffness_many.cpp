#include "zwidth/design/critical_stiffness_many.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <limits>
#include <utility>

#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

CriticalStiffnessOfOne failed(std::string why) {
  return {StiffnessStatus::refused, none, none, std::nullopt, {}, std::move(why)};
}

CriticalStiffnessOfOne answer_of(DeviceParameters parameters) {
  if (const auto problem = find_problem(parameters)) {
    return failed(fmt::format("{} {}; {}", problem->key, problem->what, problem->allowed));
  }
  try {
    CriticalStiffness critical = critical_stiffness(Device(std::move(parameters)));
    CriticalStiffnessOfOne one{critical.status, critical.stiffness, none, std::nullopt, std::move(critical.trust), {}};
    if (critical.limit) {
      one.frequency = critical.limit->frequency;
      one.limited_by = critical.limit->limited_by;
    }
    return one;
  } catch (const Error& error) {
    return failed(error.what());
  }
}

}  // namespace

std::vector<CriticalStiffnessOfOne> critical_stiffness_many(const Device& device,
                                                            std::span<const ParameterValues> changes,
                                                            const Progress& progress) {
  if (const auto problem = find_problem(device, changes)) {
    throw Error(ErrorCode::invalid_argument, fmt::format("{}: {}; {}", problem->key, problem->what, problem->allowed));
  }
  std::vector<CriticalStiffnessOfOne> answers(changes.front().values.size());
  internal::SharedProgress shared(progress, answers.size());
  tbb::parallel_for(std::size_t{0}, answers.size(), [&](std::size_t i) {
    DeviceParameters parameters = device.parameters();
    for (const ParameterValues& each : changes) set_parameter(parameters, each.key, each.values[i]);
    answers[i] = answer_of(std::move(parameters));
    shared.add();
  });
  return answers;
}

}  // namespace zwidth

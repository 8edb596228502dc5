#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "zwidth/identification/identification.hpp"

namespace zwidth {
namespace {

std::optional<OptionProblem> find_fit_problem(const ParameterFitOptions& options) {
  if (!(std::isfinite(options.robust_threshold) && options.robust_threshold >= 0.0)) {
    return OptionProblem{"robust_threshold", fmt::format("is {}", options.robust_threshold), "must be finite and >= 0"};
  }
  for (const auto& [name, value] : {std::pair{"lowest", options.lowest}, std::pair{"highest", options.highest}}) {
    if (value && !(std::isfinite(*value) && *value > 0.0)) {
      return OptionProblem{name, fmt::format("is {} rad/s", *value), "must be finite and > 0"};
    }
  }
  if (options.lowest && options.highest && *options.lowest >= *options.highest) {
    return OptionProblem{"highest", fmt::format("is {} rad/s", *options.highest),
                         fmt::format("must be above lowest, {} rad/s", *options.lowest)};
  }
  if (options.free.size() > max_free_parameters) {
    return OptionProblem{"free", fmt::format("has {} keys", options.free.size()),
                         fmt::format("must be at most {}", max_free_parameters)};
  }
  return std::nullopt;
}

}  // namespace

std::optional<OptionProblem> find_problem(const IdentifyOptions& options) {
  const auto within = [](const std::string& part, std::optional<OptionProblem> problem) {
    if (problem) problem->member = fmt::format("{}.{}", part, problem->member);
    return problem;
  };
  if (auto problem = within("response", find_problem(options.response))) return problem;
  if (auto problem = within("fit", find_fit_problem(options.fit))) return problem;
  if (!(std::isfinite(options.segment) && options.segment > 0.0))
    return OptionProblem{"segment", fmt::format("is {} s", options.segment), "must be finite and above 0"};
  if (options.method == IdentifyOptions::Method::motion && options.response.output != OutputQuantity::position)
    return OptionProblem{"method", "fits the motion", "must fit the lines where no position is recorded"};
  for (std::size_t i = 0; i < options.limits.size(); ++i) {
    if (auto problem = within(fmt::format("limits[{}]", i), find_problem(options.limits[i]))) return problem;
  }
  return std::nullopt;
}

}  // namespace zwidth

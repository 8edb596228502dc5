#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "counted.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth {
namespace {

using internal::counted;

std::optional<OptionProblem> find_fit_problem(const ParameterFitOptions& options) {
  if (!(std::isfinite(options.robust_threshold) && options.robust_threshold >= 0.0)) {
    return option_problem("robust_threshold",
                          {.code = ProblemCode::negative, .evidence = {{"value", options.robust_threshold}}});
  }
  for (const auto& [name, value] : {std::pair{"lowest", options.lowest}, std::pair{"highest", options.highest}}) {
    if (value && !(std::isfinite(*value) && *value > 0.0)) {
      return option_problem(name, {.code = ProblemCode::not_finite_and_positive,
                                   .evidence = {{"value", *value}},
                                   .subjects = {{"unit", "rad/s"}}});
    }
  }
  if (options.lowest && options.highest && *options.lowest >= *options.highest) {
    return option_problem("highest", {.code = ProblemCode::not_above_lowest_frequency,
                                      .evidence = {{"value", *options.highest}, {"lowest", *options.lowest}}});
  }
  if (options.free.size() > max_free_parameters) {
    return option_problem("free",
                          {.code = ProblemCode::too_many_free,
                           .evidence = {counted("free", options.free.size()), counted("most", max_free_parameters)}});
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
    return option_problem("segment", {.code = ProblemCode::not_finite_and_above,
                                      .evidence = {{"value", options.segment}, {"bound", 0.0}},
                                      .subjects = {{"unit", "s"}}});
  if (options.method == IdentifyOptions::Method::motion && options.response.output != OutputQuantity::position)
    return option_problem("method", {.code = ProblemCode::motion_not_fitted});
  for (std::size_t i = 0; i < options.limits.size(); ++i) {
    if (auto problem = within(fmt::format("limits[{}]", i), find_problem(options.limits[i]))) return problem;
  }
  return std::nullopt;
}

}  // namespace zwidth

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/subcommand.hpp"
#include "server/api/command_request.hpp"

namespace zwidth::cli {

/// What the device of a request is called in the command's messages; the library names a nameless one so.
inline constexpr const char* device_name = "device";
inline constexpr const char* study_name = "study";

/// A command's problems as the request's: their places are options, the device and its keys, and recordings.
[[nodiscard]] server::Problem problem_in(const BadInput& refused, const server::CommandRequest& request);
[[nodiscard]] server::Problem problem_in(const InputProblem& told, const server::CommandRequest& request);

/// Why the work failed: it has no place, and its lines stay together.
[[nodiscard]] server::Problem failure_in(const WorkFailed& failure);

/// CLI11's message about an option as the request's problem. `file`: what its positional argument is, device or recording.
[[nodiscard]] server::Problem problem_of_cli11(const std::string& message, std::string_view file,
                                               const server::CommandRequest& request);

/// The problem with the command's `options` ("accept-doubt") called as who asked calls them; `recording`: the one that is
/// no option of a request, if there is one.
[[nodiscard]] server::Problem with_names(server::Problem problem, server::CommandRequest::Naming naming,
                                         const std::vector<std::string>& options, std::string_view recording);

/// An option's name in a list of them.
[[nodiscard]] std::string listed(std::string option, server::CommandRequest::Naming naming);

}  // namespace zwidth::cli

#pragma once

#include "server/api/command_request.hpp"

namespace zwidth::cli {

/// The program's commands for requests: the options are those of the command line, parsed and checked by the same
/// declarations; names of files stand for what the request brought along, and nothing is read or written beside it.
class RequestCommands : public server::Commands {
 public:
  [[nodiscard]] std::vector<std::string> names() const override;
  [[nodiscard]] tl::expected<std::string, server::Problem> run(const server::CommandRequest& request,
                                                               const Progress& progress) const override;
};

}  // namespace zwidth::cli

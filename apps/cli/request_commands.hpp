#pragma once

#include <map>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "cli/request_context.hpp"
#include "server/api/command_request.hpp"

namespace zwidth::cli {

/// An option that a request may give, by its long name.
struct OfferedOption {
  std::string name;
  std::string value;  ///< what it takes, "KEY=VALUE"; empty: a flag
  std::string text;   ///< its help
};

/// What a command answers.
struct RequestAnswer {
  std::string printed;
  std::optional<std::string> device;                  ///< the device that it found, as a file's text
  std::map<std::string, std::vector<double>> series;  ///< samples that the document does not hold, by name
};

/// The program's commands for requests: the options are those of the command line, parsed and checked by the same
/// declarations; names of files stand for what the request brought along, and nothing is read or written beside it.
class RequestCommands : public server::Commands {
 public:
  explicit RequestCommands(const RequestBounds& bounds = {}) : bounds_(bounds) {}
  [[nodiscard]] std::vector<std::string> names() const override;
  [[nodiscard]] tl::expected<std::string, server::Problem> run(const server::CommandRequest& request,
                                                               const Progress& progress) const override;
  /// run() with what the printed document leaves out.
  [[nodiscard]] tl::expected<RequestAnswer, server::Problem> answer(const server::CommandRequest& request,
                                                                    const Progress& progress) const;
  /// In the order of the help, those that name a file to write left out; none where there is no such command.
  [[nodiscard]] std::vector<OfferedOption> options(const std::string& command) const;

 private:
  RequestBounds bounds_;
};

}  // namespace zwidth::cli

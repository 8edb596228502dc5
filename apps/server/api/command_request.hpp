#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <variant>
#include <vector>

#include "server/api/memory_file.hpp"
#include "zwidth/input_problem.hpp"
#include "zwidth/io/recorded_columns.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::server {

/// Why a request is not answered, and what would be. In its place the device is called "device", and an option as who
/// asked calls it; lines are those of a text that the request holds.
struct Problem : InputProblem {
  Problem(std::string place_in_request, std::string what_is_wrong, std::string what_is_allowed)
      : InputProblem{{}, std::move(what_is_wrong), std::move(what_is_allowed), {}},
        where(std::move(place_in_request)) {}
  Problem(std::string place_in_request, InputProblem why)
      : InputProblem(std::move(why)), where(std::move(place_in_request)) {}

  std::string where;            ///< "options.points", "device.loop.delay"; empty where the work itself failed
  std::vector<Problem> others;  ///< of the same input
};

/// A command of the program with what it works on.
struct CommandRequest {
  /// An option by its long name without dashes; a flag has no value, one that repeats or takes a list has several.
  struct Option {
    std::string name;
    std::vector<std::string> values;
  };
  /// A file that is open in memory, the path of one, or columns that are in no file.
  struct Recorded {
    std::string name;
    std::variant<std::shared_ptr<const MemoryFile>, std::filesystem::path, std::shared_ptr<const RecordedColumns>> held;
  };
  /// How a message calls an option: "options.accept-doubt", as in a document, or "accept_doubt", as a keyword of Python.
  enum class Naming { document, keyword };
  std::string command;
  Naming naming = Naming::document;
  std::vector<Option> options;
  bool prints_text = false;           ///< for people, instead of its document
  std::optional<std::string> device;  ///< TOML text
  bool device_is_text = false;        ///< it came as that: places in it mean something to who sent it
  std::vector<Recorded> recordings;
  /// What varies, of a study: TOML text, or the path of a file, beside which its files of samples lie.
  std::optional<std::variant<std::string, std::filesystem::path>> study;
};

/// The client has left, or the work has taken too long: thrown by the Progress that work is given.
struct Cancelled : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The program's commands, by whoever declares their options; run from many threads at once.
class Commands {
 public:
  virtual ~Commands() = default;
  [[nodiscard]] virtual std::vector<std::string> names() const = 0;
  /// What the command prints with --json, or as text where it has no such option. Reads and writes no file.
  [[nodiscard]] virtual tl::expected<std::string, Problem> run(const CommandRequest& request,
                                                               const Progress& progress) const = 0;
};

}  // namespace zwidth::server

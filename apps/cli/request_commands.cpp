#include "cli/request_commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>
#include <variant>

#include "cli/command_description.hpp"
#include "cli/option_units.hpp"
#include "cli/request_problem.hpp"
#include "cli/subcommand.hpp"
#include "cli/usage_error.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::cli {
namespace {

using server::CommandRequest;
using server::Problem;

constexpr std::string_view positional = "FILE";

/// A command that requests may name, and the arguments that its device and its recordings are; empty: it takes none.
struct OfferedCommand {
  std::string_view name;
  void (*add)(CLI::App&);
  std::string_view device;
  std::string_view recording;
  std::string_view study = {};
};

constexpr std::array offered_commands{OfferedCommand{"analyze", add_analyze, positional, ""},
                                      OfferedCommand{"bode", add_bode, positional, ""},
                                      OfferedCommand{"design", add_design, positional, ""},
                                      OfferedCommand{"diagnose", add_diagnose, positional, "--recording"},
                                      OfferedCommand{"excite", add_excite, "--device", ""},
                                      OfferedCommand{"export", add_export, positional, ""},
                                      OfferedCommand{"frf", add_frf, "", positional},
                                      OfferedCommand{"identify", add_identify, "--structure", positional},
                                      OfferedCommand{"region", add_region, positional, ""},
                                      OfferedCommand{"relay", add_relay, positional, "--recording"},
                                      OfferedCommand{"simulate", add_simulate, positional, "--user-force"},
                                      OfferedCommand{"study", add_study, positional, "", "--study"},
                                      OfferedCommand{"workspace", add_workspace, positional, ""}};

struct Refused {
  Problem problem;
};

/// `recommend` is the command line's `design --recommend`.
constexpr std::string_view recommend = "recommend";

void put_named(std::vector<std::string>& arguments, std::string_view argument, const std::string& name) {
  if (argument == positional) {
    arguments.insert(arguments.begin(), name);
  } else {
    arguments.push_back(fmt::format("{}={}", argument, name));
  }
}

/// False where there is one of that name.
bool put_recording(const CommandRequest::Recorded& recorded, RequestContext& own) {
  if (own.recordings.contains(recorded.name) || own.columns.contains(recorded.name)) return false;
  if (const auto* columns = std::get_if<std::shared_ptr<const RecordedColumns>>(&recorded.held)) {
    own.columns.emplace(recorded.name, *columns);
  } else if (const auto* file = std::get_if<std::filesystem::path>(&recorded.held)) {
    own.recordings.emplace(recorded.name, file->string());
  } else {
    own.recordings.emplace(recorded.name, std::get<std::shared_ptr<const server::MemoryFile>>(recorded.held)->path());
  }
  return true;
}

/// What a request names is in its context; the arguments name it.
void put_inputs(const CommandRequest& request, const OfferedCommand& command, RequestContext& own,
                std::vector<std::string>& arguments) {
  if (request.device) {
    if (command.device.empty()) throw Refused{{"device", fmt::format("{} takes none", command.name), "a recording"}};
    own.devices.emplace(device_name, *request.device);
    put_named(arguments, command.device, device_name);
  }
  if (request.study) {
    if (command.study.empty()) throw Refused{{"study", fmt::format("{} takes none", command.name), "a device"}};
    own.study = request.study;
    put_named(arguments, command.study, study_name);
  }
  if (request.recordings.empty()) return;
  if (command.recording.empty()) throw Refused{{"recording", fmt::format("{} takes none", command.name), "a device"}};
  if (request.recordings.size() > 1 && command.recording != positional) {
    throw Refused{{"recordings", fmt::format("{} takes one", command.name), "one recording"}};
  }
  for (auto each = request.recordings.rbegin(); each != request.recordings.rend(); ++each) {
    if (!put_recording(*each, own)) {
      throw Refused{{"recordings", "two have the same name", "names that differ"}};
    }
    put_named(arguments, command.recording, each->name);
  }
}

/// The long names of a command's options, without dashes.
std::vector<std::string> names_of_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* each : command.get_options()) {
    names.insert(names.end(), each->get_lnames().begin(), each->get_lnames().end());
  }
  return names;
}

/// "--name=value": no value can become an option. A flag is "--name".
void put_option(const CLI::App& command, const CommandRequest::Option& given, CommandRequest::Naming naming,
                std::vector<std::string>& arguments) {
  const auto refused = [&](std::string what, std::string allowed) {
    return Refused{{"options." + given.name, problem_of_value(given.name, std::move(what), std::move(allowed))}};
  };
  const CLI::Option* option = given.name == "help" ? nullptr : command.get_option_no_throw("--" + given.name);
  if (option == nullptr || given.name.find('=') != std::string::npos) {
    std::vector<std::string> known = names_of_options(command);
    std::erase(known, "help");
    for (std::string& name : known) name = listed(name, naming);
    const std::string near = nearest_word(listed(given.name, naming), known);
    throw refused(fmt::format("{} has no such option", command.get_name()),
                  near.empty() ? fmt::format("{}", fmt::join(known, ", ")) : fmt::format("did you mean {}?", near));
  }
  if (given.name == "json") return;  // always
  const bool is_flag = option->get_items_expected_max() == 0;
  if (is_flag != given.values.empty()) {
    throw refused(is_flag ? "is a flag" : "needs a value", is_flag ? "true or false" : option->get_type_name());
  }
  if (is_flag) {
    arguments.push_back("--" + given.name);
  } else if (option->get_delimiter() != '\0') {
    arguments.push_back(
        fmt::format("--{}={}", given.name, fmt::join(given.values, std::string(1, option->get_delimiter()))));
  } else {
    for (const std::string& value : given.values) arguments.push_back(fmt::format("--{}={}", given.name, value));
  }
}

auto find_command(std::string_view name) {
  return std::ranges::find(offered_commands, name == recommend ? "design" : name, &OfferedCommand::name);
}

RequestAnswer answer_in(RequestContext& own) {
  return {std::move(own.output), std::move(own.device), std::move(own.series)};
}

RequestAnswer answered(const CommandRequest& request, const OfferedCommand& offered, RequestContext& own) {
  Program app("", "zwidth");
  app.request = &own;
  app.require_subcommand(1);
  offered.add(app);
  const CLI::App& command = *app.get_subcommand(std::string(offered.name));
  accept_units(app);
  std::vector<std::string> arguments;
  for (const CommandRequest::Option& option : request.options) {
    if (!offered.study.empty() && "--" + option.name == offered.study) {
      throw Refused{{"options." + option.name, "names a file", "study or study_toml beside the options"}};
    }
    put_option(command, option, request.naming, arguments);
  }
  const auto asks_for = [&](const char* option) {
    return std::ranges::count(request.options, option, &CommandRequest::Option::name) > 0;
  };
  // Text where the command has no document, or where its text is asked for on standard output.
  const bool is_text = request.prints_text || asks_for("output") || asks_for("output-device");
  if (command.get_option_no_throw("--json") != nullptr && !is_text) arguments.emplace_back("--json");
  if (request.command == recommend && !asks_for("recommend")) arguments.emplace_back("--recommend");
  put_inputs(request, offered, own, arguments);
  arguments.insert(arguments.begin(), std::string(offered.name));
  std::ranges::reverse(arguments);  // CLI11 takes them from the back
  app.parse(arguments);
  return answer_in(own);
}

tl::expected<RequestAnswer, Problem> answer_or_problem(const CommandRequest& request, const OfferedCommand& offered,
                                                       RequestContext& own) {
  try {
    return answered(request, offered, own);
  } catch (const Refused& refused) {
    return tl::unexpected(refused.problem);
  } catch (const CLI::ParseError& error) {
    return tl::unexpected(
        problem_of_cli11(error.what(), offered.device == positional ? "device" : "recording", request));
  } catch (const RefusedValue& refused) {
    return tl::unexpected(problem_in(refused.problem, request));
  } catch (const BadInput& error) {
    return tl::unexpected(problem_in(error, request));
  } catch (const WorkFailed& error) {
    // The document says itself what of it is refused.
    if (!own.output.empty()) return answer_in(own);
    return tl::unexpected(failure_in(error));
  } catch (const Error& error) {
    return tl::unexpected(Problem{"", error.what(), ""});
  }
}

}  // namespace

std::vector<std::string> RequestCommands::names() const {
  std::vector<std::string> all{std::string(recommend)};
  for (const OfferedCommand& each : offered_commands) all.emplace_back(each.name);
  return all;
}

std::vector<OfferedOption> RequestCommands::options(const std::string& command) const {
  const auto offered = find_command(command);
  std::vector<OfferedOption> options;
  if (offered == offered_commands.end()) return options;
  CLI::App app("", "zwidth");
  offered->add(app);
  for (const CommandDescription& each : describe(app)) {
    if (each.name != offered->name) continue;
    for (const OptionDescription& option : each.options) {
      const std::string& name = option.names.back();
      const bool is_input = name == offered->recording || name == offered->device;
      constexpr std::array of_text_and_figures{"--explain", "--formulas", "--width"};
      const bool is_no_matter =
          std::ranges::count(of_text_and_figures, name) > 0 || (name == "--db" && offered->name == "analyze");
      if (name == "--json" || name == "--help" || name == "--list" || is_no_matter || (option.takes_file && !is_input))
        continue;
      options.push_back({name.substr(2), option.value, option.text});
    }
  }
  return options;
}

tl::expected<std::string, Problem> RequestCommands::run(const CommandRequest& request, const Progress& progress) const {
  return answer(request, progress).map([](RequestAnswer&& given) { return std::move(given.printed); });
}

tl::expected<RequestAnswer, Problem> RequestCommands::answer(const CommandRequest& request,
                                                             const Progress& progress) const {
  const auto offered = find_command(request.command);
  if (offered == offered_commands.end()) return tl::unexpected(Problem{"request", "there is no such command", ""});
  RequestContext own;
  own.progress = progress;
  own.bounds = bounds_;
  return answer_or_problem(request, *offered, own).map_error([&](Problem&& problem) {
    CLI::App app("", "zwidth");
    offered->add(app);
    const CLI::App& command = *app.get_subcommand(std::string(offered->name));
    const std::string_view recording = offered->recording.starts_with("--") ? offered->recording.substr(2) : "";
    return with_names(std::move(problem), request.naming, names_of_options(command), recording);
  });
}

}  // namespace zwidth::cli

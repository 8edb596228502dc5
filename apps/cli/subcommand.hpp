#pragma once

#include <CLI/App.hpp>
#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zwidth/error.hpp"
#include "zwidth/io/number_with_unit.hpp"

namespace zwidth::cli {

/// A sentence with the options that it names, "add --csv FILE". Only a literal names any.
struct CommandText : OptionText {
  // NOLINTBEGIN(google-explicit-constructor): as OptionText
  CommandText(const char* literal) : OptionText(std::string(literal), options_in(literal)) {}
  CommandText(std::string plain) : OptionText(std::move(plain)) {}
  CommandText(OptionText sentence) : OptionText(std::move(sentence)) {}
  // NOLINTEND(google-explicit-constructor)

 private:
  static std::vector<NamedOption> options_in(std::string_view literal) {
    std::vector<NamedOption> found;
    for (std::size_t at = literal.find("--"); at != std::string_view::npos;) {
      const std::size_t end =
          std::min(literal.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-", at), literal.size());
      if (end > at + 2) found.push_back({std::string(literal.substr(at, end - at)), at, end - at});
      at = literal.find("--", end);
    }
    return found;
  }
};

/// What is wrong with the value of an option: "--duration".
[[nodiscard]] inline InputProblem problem_of_value(std::string_view option, CommandText what, CommandText allowed,
                                                   std::optional<std::string> suggestion = std::nullopt) {
  InputProblem problem{{}, std::move(what.text), {}, std::move(suggestion), std::move(what.options)};
  problem.place.option = option;
  problem.allow(std::move(allowed));
  return problem;
}

[[nodiscard]] inline InputProblem problem_of_value(std::string_view option, const UnitProblem& problem) {
  InputProblem told = problem_of_value(option, problem.what, problem.allowed, problem.suggestion);
  told.problem = problem.problem;
  return told;
}

/// Wrong usage or bad input: main prints every problem on a line of its own and exits with status 2.
struct BadInput : std::runtime_error {
  /// In the place's option is one of the command line.
  explicit BadInput(std::vector<InputProblem> all) : std::runtime_error(lines_of(all)), problems(std::move(all)) {}
  explicit BadInput(InputProblem problem) : BadInput(std::vector<InputProblem>{std::move(problem)}) {}
  /// Of an option; empty: of none.
  BadInput(std::string_view option, CommandText what, CommandText allowed = "")
      : BadInput(problem_of_value(option, std::move(what), std::move(allowed))) {}

  std::vector<InputProblem> problems;

 private:
  static std::string lines_of(const std::vector<InputProblem>& all) {
    std::string lines;
    for (const InputProblem& each : all) lines += (lines.empty() ? "" : "\n") + each.str();
    return lines;
  }
};

/// The value of an option that is refused while the command line is parsed.
struct RefusedValue {
  InputProblem problem;
};

/// The work itself failed (cannot write, does not converge): main prints the message and exits with status 1.
struct WorkFailed : std::runtime_error {
  explicit WorkFailed(CommandText why) : WorkFailed("", std::move(why)) {}
  /// The work on what is called `name` (a file; empty: nothing).
  WorkFailed(const std::string& name, CommandText why)
      : std::runtime_error((name.empty() ? "" : name + ": ") + why.text), reason(std::move(why)) {}

  OptionText reason;  ///< without the name
};

/// Options of the command line by the member of an options struct that they set.
using OptionsByMember = std::span<const std::pair<std::string_view, std::string_view>>;

/// The option that sets the member; empty for none.
[[nodiscard]] inline std::string_view option_of(OptionsByMember options, std::string_view member) {
  const auto found = std::ranges::find(options, member, [](const auto& each) { return each.first; });
  return found == options.end() ? std::string_view() : found->second;
}

/// What is wrong with the library's arguments, in the file `name` (empty: in none).
[[nodiscard]] inline BadInput refused_by(const Error& error, const std::string& name, OptionsByMember options = {}) {
  std::vector<InputProblem> problems = error.problems();
  if (problems.empty()) problems.push_back({{}, error.what(), "", {}});
  for (InputProblem& each : problems) {
    if (each.place.file.empty()) each.place.file = name;
    const std::string_view option = option_of(options, each.place.option);
    if (option.empty() && !each.place.option.empty()) each.what = each.place.option + " " + each.what;
    each.place.option = option;
  }
  return BadInput(std::move(problems));
}

/// Runs the library's work on what is called `name` (a file; empty: nothing). What it could not compute is WorkFailed;
/// what it refuses to compute lies in the input: BadInput, of the option that sets what it refuses.
template <typename Work>
auto worked(const std::string& name, const Work& work, OptionsByMember options = {}) {
  try {
    return work();
  } catch (const Error& error) {
    if (error.code() == ErrorCode::did_not_converge) throw WorkFailed(name, error.what());
    throw refused_by(error, name, options);
  }
}

// Each adds one command to the program, in a file of its name. A command's footer is "Examples:" and one line
// "  zwidth ..." per example; the tests run every one of them beside a copy of devices/.
void add_analyze(CLI::App& app);
void add_bode(CLI::App& app);
void add_design(CLI::App& app);
void add_diagnose(CLI::App& app);
void add_excite(CLI::App& app);
void add_export(CLI::App& app);
void add_frf(CLI::App& app);
void add_identify(CLI::App& app);
void add_region(CLI::App& app);
void add_relay(CLI::App& app);
void add_reproduce(CLI::App& app);
void add_rig(CLI::App& app);
void add_serve(CLI::App& app);
void add_simulate(CLI::App& app);
void add_study(CLI::App& app);
void add_workspace(CLI::App& app);

}  // namespace zwidth::cli

#include "cli/outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

#include "cli/option_units.hpp"
#include "cli/request_context.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "report/text/text_medium.hpp"

namespace zwidth::cli {
namespace {

namespace fs = std::filesystem;

std::string ending_of(const std::string& path) {
  std::string ending = fs::path(path).extension();
  std::ranges::transform(ending, ending.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return ending;
}

/// A device or a pipe, of which a file that is renamed would take the place.
bool is_special(const std::string& path) {
  std::error_code unknown;
  return fs::is_other(fs::status(path, unknown));
}

bool same_file(const std::string& one, const std::string& other) {
  std::error_code one_is_missing;
  return fs::path(one).lexically_normal() == fs::path(other).lexically_normal() ||
         fs::equivalent(one, other, one_is_missing);
}

double paper_width(const std::string& text) {
  const double width = measured_number("--width", text, Measure::position, Motion::linear);
  if (width >= report::least_paper_width && width <= report::largest_paper_width) return width;
  throw BadInput("--width", fmt::format("is {:g} mm", 1e3 * width),
                 fmt::format("{:g} to {:g} mm, with its unit: 85mm", 1e3 * report::least_paper_width,
                             1e3 * report::largest_paper_width));
}

}  // namespace

void add_output_options(CLI::App& command, OutputArguments& arguments, const OutputHelp& help) {
  command.add_flag("--json", arguments.json, help.json);
  if (!help.csv.empty()) command.add_option("--csv", arguments.csv, help.csv)->type_name("FILE");
  if (!help.explain.empty()) {
    const auto show_all = [&arguments](std::int64_t) { arguments.findings = report::ShownFindings::all; };
    command.add_flag_function("--explain", show_all, help.explain);
  }
  if (help.figure.empty()) return;
  const std::string names = arguments.figure_option == "--output" ? "-o,--output,--figure" : arguments.figure_option;
  CLI::Option* figure = command.add_option(names, arguments.figure, help.figure)->type_name("FILE");
  command.add_option("--width", arguments.width, "Of the figure on paper, its letters of 8 pt: 85mm")
      ->type_name("LENGTH")
      ->needs(figure);
}

Outputs::Outputs(const CLI::App& command) : request_(request_of(command)) {}

void Outputs::print(std::string_view answer) const {
  if (request_ == nullptr) return write_standard_output(answer);
  if (request_->output.size() + answer.size() > request_->bounds.answer) {
    throw BadInput("", fmt::format("the answer is longer than {} bytes", request_->bounds.answer),
                   "ask for less, or on the command line");
  }
  request_->output += answer;
}

void Outputs::print_text(std::string_view text) const { print(report::for_medium(text)); }

void Outputs::tell(std::string_view text) const noexcept {
  if (request_ == nullptr) write_standard_error(text);  // else what matters of it is in the answer
}

void Outputs::warn(std::span<const Remark> remarks) const {
  for (const Remark& remark : remarks) {
    if (remark.severity == Remark::Severity::warning) tell("zwidth: " + remark_line(remark) + "\n");
  }
}

void Outputs::add(const OutputArguments& arguments) {
  add("--csv", arguments.csv);
  add(arguments.figure_option, arguments.figure, arguments.ending);
  if (arguments.width.empty()) return;
  if (!outputs_.back().figure) throw BadInput("--width", "is for a figure, not for its numbers", ".svg, .png or .pdf");
  outputs_.back().figure->paper_width = paper_width(arguments.width);
}

void Outputs::add(const std::string& option, const std::string& path, Ending ending) {
  if (path.empty()) return;
  if (request_ != nullptr) throw BadInput(option, "writes a file", "a request is answered with its document alone");
  if (path == "-") throw BadInput(option, "-: is not written to standard output", "name a file");
  Output output{option, path, std::nullopt};
  const std::string given = ending_of(path);
  if (ending == Ending::figure || ending == Ending::figure_or_csv) output.figure = report::figure_format(path);
  if (ending == Ending::figure && !output.figure) {
    throw BadInput(option, fmt::format("{}: unknown extension", path), ".svg, .png or .pdf");
  }
  if (ending == Ending::figure_or_csv && !output.figure && given != ".csv") {
    throw BadInput(option, fmt::format("{}: unknown extension", path), ".svg, .png, .pdf or .csv");
  }
  if (ending == Ending::page && !given.empty() && given != ".html" && given != ".htm") {
    throw BadInput(option, fmt::format("{}: unknown extension of a page", path), ".html");
  }
  if (ending == Ending::hdf5 && is_special(path)) {
    throw BadInput(option, fmt::format("{}: is a device or a pipe", path), "name a file");
  }
  if (ending == Ending::hdf5 && !given.empty() && given != ".h5" && given != ".hdf5") {
    throw BadInput(option, fmt::format("{}: unknown extension of a result", path), ".h5");
  }
  for (const Output& other : outputs_) {
    if (same_file(path, other.path)) {
      throw BadInput(option, fmt::format("{}: is the same file as that of {}", path, other.option), "name another");
    }
  }
  outputs_.push_back(std::move(output));
}

void Outputs::keep(const std::string& input, std::string_view name) const {
  for (const Output& output : outputs_) {
    std::error_code one_is_missing;
    if (fs::equivalent(input, output.path, one_is_missing)) {
      throw BadInput(output.option, fmt::format("{}: would overwrite the {}", output.path, name), "name another file");
    }
  }
}

void Outputs::keep(const std::vector<std::string>& inputs, std::string_view name) const {
  for (const std::string& input : inputs) keep(input, name);
}

void Outputs::require_writable() const {
  for (const Output& output : outputs_) {
    try {
      report::OutputFiles::require_writable(output.path);
    } catch (const report::OutputFailed& failure) {
      throw report::OutputFailed(fmt::format("{}: {}", output.option, failure.what()));
    }
  }
}

const Outputs::Output* Outputs::find(std::string_view option) const {
  const auto found = std::ranges::find(outputs_, option, &Output::option);
  return found == outputs_.end() ? nullptr : &*found;
}

std::optional<report::FigureFormat> Outputs::figure(std::string_view option) const {
  const Output* output = find(option);
  return output != nullptr ? output->figure : std::nullopt;
}

void Outputs::put(std::string_view option, const std::function<std::string()>& make) {
  const Output* output = find(option);
  if (output != nullptr && !output->figure) files_.write(output->path, make());
}

void Outputs::put(std::string_view option, const std::function<void(const report::Sink&)>& produce) {
  const Output* output = find(option);
  if (output != nullptr && !output->figure) files_.write(output->path, produce);
}

void Outputs::draw(std::string_view option, const std::function<std::string(report::FigureFormat)>& make) {
  const Output* output = find(option);
  if (output != nullptr && output->figure) files_.write(output->path, make(*output->figure));
}

}  // namespace zwidth::cli

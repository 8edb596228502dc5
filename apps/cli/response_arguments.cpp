#include "cli/response_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "cli/input_problem.hpp"
#include "cli/number_text.hpp"
#include "cli/option_refusal.hpp"
#include "cli/progress_line.hpp"
#include "cli/request_context.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/io/message_words.hpp"
#include "zwidth/io/number_with_unit.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::cli {
namespace {

constexpr const char* estimate_group = "Estimate";
constexpr const char* table_group = "Table of a response";

/// Options by the members of FrequencyResponseOptions and ResponseTableOptions that they set.
constexpr std::pair<std::string_view, std::string_view> response_options[] = {{"segment_length", "--segment"},
                                                                              {"skip_periods", "--skip-periods"},
                                                                              {"period", "--period"},
                                                                              {"overlap", "--overlap"},
                                                                              {"lines", "--lines"},
                                                                              {"lowest", "--lowest-hz"},
                                                                              {"highest", "--highest-hz"},
                                                                              {"scale", "--value-scale"},
                                                                              {"frequency_step", "--frequency-step"}};

void add_estimate_options(CLI::App& command, ResponseArguments& arguments) {
  CLI::Option* period = command.add_option("--period", arguments.period, "Samples after which the force repeats");
  period->type_name("N")->check(CLI::PositiveNumber)->group(estimate_group);
  command
      .add_option("--skip-periods", arguments.options.skip_periods,
                  "Leading periods in which the transient dies out; else found")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str()
      ->group(estimate_group);
  command.add_flag("--aperiodic", arguments.aperiodic, "Do not look for a period: average segments (Welch)")
      ->excludes(period)
      ->group(estimate_group);
  command
      .add_option("--segment", arguments.options.segment_length, "Samples of a segment; else chosen from the record")
      ->type_name("N")
      ->check(CLI::PositiveNumber)
      ->group(estimate_group);
  command.add_option("--overlap", arguments.options.overlap, "Of segments, from 0 to below 1")
      ->type_name("X")
      ->capture_default_str()
      ->group(estimate_group);
  command.add_option("--window", arguments.window, "Of segments: hann, hamming, blackman or rectangular")
      ->type_name("NAME")
      ->capture_default_str()
      ->check(CLI::IsMember({"hann", "hamming", "blackman", "rectangular"}))
      ->group(estimate_group);
  command.add_option("--estimator", arguments.estimator, "h1: noise on the motion only; h2: noise on the force only")
      ->type_name("NAME")
      ->capture_default_str()
      ->check(CLI::IsMember({"h1", "h2"}))
      ->group(estimate_group);
  command.add_option("--lowest-hz", arguments.lowest_hz, "Leave out what is below")
      ->type_name("HZ")
      ->group(estimate_group);
  command.add_option("--highest-hz", arguments.highest_hz, "Leave out what is above")
      ->type_name("HZ")
      ->group(estimate_group);
  command
      .add_option("--lines", arguments.lines,
                  "Frequencies that the force excites, where they are known:\n"
                  "1,2.5,7 or FIRST:LAST:COUNT, in Hz or with a unit")
      ->type_name("LIST")
      ->delimiter(',')
      ->group(estimate_group);
  command.add_flag("--no-detrend", arguments.no_detrend, "Leave mean and drift in")->group(estimate_group);
}

void add_table_options(CLI::App& command, ResponseArguments& arguments) {
  CLI::Option* table = command.add_flag("--table", arguments.is_table,
                                        "FILE is a response: of a plant sampled at --rate, or else continuous");
  table->group(table_group);
  const auto add = [&](const char* name, auto& value, const char* what, const char* type) {
    return command.add_option(name, value, what)->type_name(type)->needs(table)->group(table_group);
  };
  add("--frequency", arguments.table.frequency, "Column of frequencies; else found by its name", "COLUMN");
  add("--frequency-unit", arguments.frequency_unit, "hz or rad_s; else as the column's name says, or Hz", "UNIT")
      ->check(CLI::IsMember({"hz", "rad_s"}));
  add("--frequency-step", arguments.frequency_step_hz, "For values without frequencies, from 0 Hz on", "HZ");
  add("--magnitude", arguments.table.magnitude, "Column of magnitudes, position per force", "COLUMN");
  command.add_flag("--db", arguments.table.magnitude_in_db, "Magnitudes are 20 log10")
      ->needs(table)
      ->group(table_group);
  add("--phase", arguments.table.phase, "Column of phases", "COLUMN");
  add("--phase-unit", arguments.phase_unit, "deg or rad; else as the column's name says, or degrees", "UNIT")
      ->check(CLI::IsMember({"deg", "rad"}));
  add("--real", arguments.table.real, "Column of real parts, or of complex numbers; a UFF record's name", "COLUMN");
  add("--imaginary", arguments.table.imaginary, "Column of imaginary parts", "COLUMN");
  add("--coherence", arguments.table.coherence, "Column of coherence, where there is one", "COLUMN");
  add("--value-scale", arguments.table.scale, "What the values are multiplied by, to get SI units", "X")
      ->capture_default_str();
}

Window window_of(const std::string& name) {
  if (name == "rectangular") return Window::rectangular;
  if (name == "hamming") return Window::hamming;
  if (name == "blackman") return Window::blackman;
  return Window::hann;  // CLI11 has checked the word
}

std::optional<double> angular(std::optional<double> cycles) {
  return cycles ? std::optional(radians_per_second(*cycles)) : std::nullopt;
}

double line_in_hertz(const std::string& text) {
  double hertz = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hertz);
  if (error == std::errc{} && end == text.data() + text.size()) return hertz;
  const auto value = number_with_unit(text, Measure::frequency_hz, Motion::linear);
  if (!value) throw BadInput(problem_of_value("--lines", value.error()));
  return *value;
}

/// F or FIRST:LAST:COUNT, evenly spaced; rad/s.
void add_lines(const std::string& text, std::vector<double>& lines) {
  const std::vector<std::string> parts = parts_of(text, ':');
  std::size_t count = 1;
  if (parts.size() != 1) {
    const std::string& last = parts.back();
    const auto [end, error] = std::from_chars(last.data(), last.data() + last.size(), count);
    const bool is_count = error == std::errc{} && end == last.data() + last.size() && count >= 2 && count <= 4096;
    if (parts.size() != 3 || !is_count) {
      throw BadInput("--lines", in_quotes(text),
                     "a frequency, or FIRST:LAST:COUNT with a COUNT of 2 to 4096, such as \"1 Hz:40 Hz:40\"");
    }
  }
  const double first = line_in_hertz(parts[0]);
  const double step = count > 1 ? (line_in_hertz(parts[1]) - first) / static_cast<double>(count - 1) : 0.0;
  for (std::size_t i = 0; i < count; ++i) lines.push_back(radians_per_second(first + step * static_cast<double>(i)));
}

FrequencyResponseOptions estimate_options(const ResponseArguments& arguments) {
  FrequencyResponseOptions options = arguments.options;
  options.period = arguments.period;
  if (arguments.aperiodic) options.excitation = FrequencyResponseOptions::Excitation::aperiodic;
  options.window = window_of(arguments.window);
  options.estimator = arguments.estimator == "h2" ? ResponseEstimator::h2 : ResponseEstimator::h1;
  options.detrend = !arguments.no_detrend;
  options.lowest = angular(arguments.lowest_hz);
  options.highest = angular(arguments.highest_hz);
  for (const std::string& each : arguments.lines) add_lines(each, options.lines);
  if (const auto problem = find_problem(options)) refuse(*problem, response_options);
  return options;
}

/// Options of a recording, which say nothing about a table.
void check_table_options(const CLI::App& command) {
  for (const char* option :
       {"--force", "--position", "--velocity", "--acceleration", "--time", "--timer-bits", "--period", "--skip-periods",
        "--aperiodic", "--segment", "--overlap", "--window", "--estimator", "--no-detrend", "--lines", "MORE"}) {
    if (command.count(option) > 0) {
      throw BadInput(std::string_view(option) == "MORE" ? "more than one file" : option,
                     "is for a recording, not for a table of a response", "leave it out, or --table");
    }
  }
}

ResponseSource from_table(const ResponseArguments& arguments) {
  check_table_options(*arguments.command);
  ResponseTableOptions options = arguments.table;
  options.file = recording_options(arguments.recording);
  if (arguments.frequency_unit) {
    options.frequency_scale = *arguments.frequency_unit == "hz" ? radians_per_second(1.0) : 1.0;
  }
  if (arguments.phase_unit) options.phase_in_degrees = *arguments.phase_unit == "deg";
  options.frequency_step = angular(arguments.frequency_step_hz).value_or(0.0);
  options.lowest = angular(arguments.lowest_hz);
  options.highest = angular(arguments.highest_hz);
  if (const auto problem = find_problem(options)) refuse(*problem, response_options);
  ProgressLine line(*arguments.command, "reading " + arguments.recording.file);
  auto response = read_named_table(*arguments.command, arguments.recording.file, options, line.progress());
  if (!response) refuse_input(response.error());
  ResponseSource source;
  source.name = arguments.recording.file;
  source.table = judged_response(source.name, *std::move(response));
  return source;
}

ResponseSource from_recording(const ResponseArguments& arguments) {
  ResponseSource source;
  source.name = arguments.recording.file;
  source.options = estimate_options(arguments);
  RecordedMotions motions = read_motions(arguments.recording);
  source.options.output = motions.output;
  source.recordings = std::move(motions.recordings);
  return source;
}

}  // namespace

void add_response_arguments(CLI::App& command, ResponseArguments& arguments) {
  add_recording_arguments(command, arguments.recording);
  add_estimate_options(command, arguments);
  add_table_options(command, arguments);
  arguments.command = &command;
}

std::optional<double> ResponseSource::sampling_period() const {
  return recordings.empty() ? table.response.sampling_period : std::optional(recordings.front().sampling_period);
}

ResponseSource response_source(const ResponseArguments& arguments) {
  ResponseSource source = arguments.is_table ? from_table(arguments) : from_recording(arguments);
  source.command = arguments.command;
  return source;
}

MeasuredResponse measured_response(const ResponseSource& source) {
  if (source.recordings.empty()) return source.table;
  const auto estimated = [&] {
    ProgressLine line(*source.command, "estimating the response");
    return frequency_response(source.recordings, source.options, line.progress());
  };
  return worked(source.recordings.size() == 1 ? source.name : "", estimated, response_options);
}

OptionsByMember options_of_response() { return response_options; }

}  // namespace zwidth::cli

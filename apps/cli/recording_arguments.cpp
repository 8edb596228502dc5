#include "cli/recording_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "cli/input_problem.hpp"
#include "cli/number_text.hpp"
#include "cli/option_refusal.hpp"
#include "cli/option_units.hpp"
#include "cli/outputs.hpp"
#include "cli/progress_line.hpp"
#include "cli/request_context.hpp"
#include "cli/subcommand.hpp"
#include "report/text/text_table.hpp"
#include "results/recording_json.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::cli {
namespace {

/// `unit`: "M" or "F", of which the scale may be given with a unit; "X": none is known for it.
void add_column(CLI::App& command, const std::string& name, ColumnRequest& column, const std::string& what,
                const char* unit = "X") {
  command.add_option("--" + name, column.name, what)->type_name("COLUMN")->group(recording_group);
  command
      .add_option("--" + name + "-scale", column.scale,
                  "Factor to SI units; 1 and -1: beside the unit in the column's name")
      ->type_name(unit)
      ->group(recording_group);
}

constexpr std::pair<std::string_view, std::string_view> options_of_recording[] = {
    {"rate", "--rate"}, {"time_scale", "--time-scale"}, {"decimal_mark", "--decimal"}};

char delimiter_of(const std::string& text) {
  if (text == "tab" || text == "\\t" || text == "\t") return '\t';
  if (text == "space" || text == "blank" || text == " ") return ' ';
  if (text == "comma" || text == ",") return ',';
  if (text == "semicolon" || text == ";") return ';';
  throw BadInput("--delimiter", fmt::format("is '{}'", text), "comma, semicolon, tab or space");
}

char decimal_mark_of(const std::string& text) {
  if (text == "." || text == "point") return '.';
  if (text == "," || text == "comma") return ',';
  throw BadInput("--decimal", fmt::format("is '{}'", text), "point or comma");
}

RecordingFormat format_of(const std::string& text) {
  if (text == "text") return RecordingFormat::text;
  if (text == "mat") return RecordingFormat::mat;
  if (text == "uff") return RecordingFormat::uff;
  return RecordingFormat::detect;  // CLI11 has checked the word
}

/// Whether a column is called so, alone or with a unit that the reader scales by: "force", "torque_N_m", "torque_mNm",
/// "position [mm]". "position_in" may be anything.
bool is_called(const RecordingColumn& column, std::string_view name, Measure measure) {
  if (!column.name.starts_with(name)) return false;
  std::string unit = column.name.substr(name.size());
  if (unit.empty()) return true;
  const bool is_bare = unit.front() == '_';
  if (!is_bare && unit.front() != '[' && unit.front() != '(' && unit.front() != ' ') return false;
  std::ranges::replace_if(
      unit, [](char c) { return std::string_view("_[]()").find(c) != std::string_view::npos; }, ' ');
  return std::ranges::any_of(std::array{Motion::linear, Motion::rotary}, [&](Motion motion) {
    const auto size = measured_number("1 " + unit, measure, motion);
    return size && (!is_bare || *size == 1.0 || column.name.substr(name.size() + 1) == column.unit);
  });
}

/// The column of the file that no option need name: the one called as the first name and nothing else, else the one called as
/// any of them; empty: none, or several. Standard input is read once.
std::string column_called(const RecordingArguments& arguments, std::initializer_list<std::string_view> names,
                          Measure measure) {
  if (arguments.file == "-") return "";
  const auto contents = list_named_recording(*arguments.command, arguments.file, recording_options(arguments));
  std::string found;
  if (!contents) return found;
  const std::string first(*names.begin());
  if (std::ranges::count(contents->columns, first, &RecordingColumn::name) == 1) return first;
  for (const RecordingColumn& column : contents->columns) {
    const bool is_one = std::ranges::any_of(names, [&](auto name) { return is_called(column, name, measure); });
    if (is_one && !found.empty()) return "";
    if (is_one) found = column.name;
  }
  return found;
}

/// "; FILE has: a, b, c", or nothing where the file cannot be listed (its own error is then better).
std::string columns_of(const RecordingArguments& arguments) {
  if (arguments.file == "-") return "";
  const auto contents = list_named_recording(*arguments.command, arguments.file, recording_options(arguments));
  if (!contents) refuse_input(contents.error());
  constexpr std::size_t most = 30;
  std::string names;
  for (std::size_t i = 0; i < std::min(most, contents->columns.size()); ++i) {
    names += (names.empty() ? "" : ", ") + contents->columns[i].name;
  }
  if (contents->columns.size() > most) names += ", ...";
  return names.empty() ? "" : fmt::format("; {} has: {}", arguments.file, names);
}

struct RequestedMotion {
  ColumnRequest column;
  OutputQuantity output = OutputQuantity::position;
  std::string_view option;
  std::string_view scale_option;
};

/// The option that names the column which the file lacks; none where something stands in the file.
std::string_view option_of_column(const InputError& error, const RecordingArguments& arguments,
                                  const RequestedMotion& motion) {
  const std::string& key = error.place.key;
  if (key.empty() || error.place.line > 0) return {};
  if (arguments.options.time_column == key) return "--time";
  if (arguments.force.name == key) return "--force";
  return motion.column.name == key ? motion.option : std::string_view();
}

RequestedMotion requested_motion(const RecordingArguments& arguments) {
  const std::array<RequestedMotion, 3> candidates{
      RequestedMotion{arguments.position, OutputQuantity::position, "--position", "--position-scale"},
      RequestedMotion{arguments.velocity, OutputQuantity::velocity, "--velocity", "--velocity-scale"},
      RequestedMotion{arguments.acceleration, OutputQuantity::acceleration, "--acceleration", "--acceleration-scale"}};
  const RequestedMotion* found = nullptr;
  for (const RequestedMotion& candidate : candidates) {
    if (candidate.column.name.empty()) continue;
    if (found) throw BadInput(candidate.option, "is given beside another column of the motion", "give one");
    found = &candidate;
  }
  if (!found) {
    throw BadInput("--position", "missing",
                   CommandText("name the column of the motion with --position, --velocity or --acceleration") +
                       columns_of(arguments));
  }
  return *found;
}

/// A recording's names are compared: a request may be a number. Columns of one name are told apart by number alone.
void check_that_columns_differ(const Recording& recording, const ColumnRequest& force, const RequestedMotion& motion) {
  const std::string& name = recording.channels[0].name;
  const auto force_number = number_in(force.name);
  const auto motion_number = number_in(motion.column.name);
  const bool numbers_differ = force_number && motion_number && *force_number != *motion_number;
  if (name != recording.channels[1].name || numbers_differ) return;
  refuse_key(recording.source, "", fmt::format("column '{}' is named as the force and as the motion", name),
             "name two columns", motion.option);
}

}  // namespace

void add_recording_arguments(CLI::App& command, RecordingArguments& arguments) {
  command.add_option("FILE", arguments.file, "Recording: text (CSV, ...), MAT or UFF 58; - reads standard input")
      ->type_name("")
      ->required();
  command.add_option("MORE", arguments.more, "More recordings of the same device")->type_name("");
  add_recording_options(command, arguments);
}

void add_recording_options(CLI::App& command, RecordingArguments& arguments) {
  arguments.command = &command;
  command.add_flag("--list", arguments.list, "Print what the file holds, and do nothing else")->group(recording_group);
  add_column(
      command, "force", arguments.force,
      "Commanded force: a column's name, or its number from 1; one\nnamed force, torque or force_N needs no option",
      "F");
  add_column(command, "position", arguments.position,
             "Sensed position; a column named position, angle or position_m\nneeds no option", "M");
  add_column(command, "velocity", arguments.velocity, "Sensed velocity, where no position is recorded");
  add_column(command, "acceleration", arguments.acceleration, "Sensed acceleration, where no position is recorded");
  command.add_option("--rate", arguments.options.rate, "Samples per second, where no column holds the time")
      ->type_name("HZ")
      ->group(recording_group);
  command.add_option("--time", arguments.options.time_column, "Column of times")
      ->type_name("COLUMN")
      ->group(recording_group);
  command
      .add_option("--time-scale", arguments.options.time_scale,
                  "Seconds per unit of that column; else by the unit in its name, or 1")
      ->type_name("S")
      ->group(recording_group);
  command.add_option("--timer-bits", arguments.options.timer_bits, "The time column counts up and wraps at 2^BITS")
      ->type_name("BITS")
      ->check(CLI::Range(1, 64))
      ->group(recording_group);
  command.add_option("--format", arguments.format, "auto, text, mat or uff")
      ->type_name("FORMAT")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "text", "mat", "uff"}))
      ->group(recording_group);
  command
      .add_option("--skip-rows", arguments.options.skip_rows,
                  "Lines of a text above the table; what follows is read as a table")
      ->type_name("N")
      ->check(CLI::NonNegativeNumber)
      ->group(recording_group);
  command.add_option("--delimiter", arguments.delimiter, "Of a text: comma, semicolon, tab or space; else detected")
      ->type_name("NAME")
      ->group(recording_group);
  command.add_option("--decimal", arguments.decimal_mark, "Of a text: point or comma; else detected")
      ->type_name("NAME")
      ->group(recording_group);
  CLI::Option* header =
      command.add_flag("--header", arguments.header, "The first line of a text names the columns; else detected");
  header->group(recording_group);
  command.add_flag("--no-header", arguments.no_header, "A text has no such line: columns are numbers from 1")
      ->excludes(header)
      ->group(recording_group);
  command
      .add_option("--comment", arguments.options.comment, "Lines of a text that begin with one of these are skipped")
      ->type_name("CHARACTERS")
      ->capture_default_str()
      ->group(recording_group);
}

RecordingOptions recording_options(const RecordingArguments& arguments) {
  RecordingOptions options = arguments.options;
  options.format = format_of(arguments.format);
  if (!arguments.delimiter.empty()) options.delimiter = delimiter_of(arguments.delimiter);
  if (!arguments.decimal_mark.empty()) options.decimal_mark = decimal_mark_of(arguments.decimal_mark);
  if (arguments.header) options.header = RecordingOptions::Header::present;
  if (arguments.no_header) options.header = RecordingOptions::Header::absent;
  if (const auto problem = find_problem(options)) refuse(*problem, options_of_recording);
  return options;
}

std::string position_column(const RecordingArguments& arguments) {
  if (!arguments.position.name.empty()) return arguments.position.name;
  return column_called(arguments, {"position", "angle"}, Measure::position);
}

RecordedMotion read_motion(const RecordingArguments& given) {
  RecordingOptions options = recording_options(given);
  RecordingArguments arguments = given;
  const bool names_motion =
      !given.position.name.empty() || !given.velocity.name.empty() || !given.acceleration.name.empty();
  if (given.force.name.empty()) arguments.force.name = column_called(given, {"force", "torque"}, Measure::force);
  if (!names_motion) arguments.position.name = position_column(given);
  if (arguments.force.name.empty()) {
    throw BadInput("--force", "missing", "name the column of the commanded force" + columns_of(arguments));
  }
  const RequestedMotion motion = requested_motion(arguments);
  options.columns = {arguments.force, motion.column};
  const std::pair<std::string_view, std::string_view> scales[] = {{"columns.0.scale", "--force-scale"},
                                                                  {"columns.1.scale", motion.scale_option}};
  if (const auto problem = find_problem(options)) refuse(*problem, scales);
  ProgressLine line(*arguments.command, "reading " + arguments.file);
  auto recording = read_named_recording(*arguments.command, arguments.file, options, line.progress());
  if (!recording) refuse_input(recording.error(), option_of_column(recording.error(), arguments, motion));
  check_that_columns_differ(*recording, arguments.force, motion);
  recording->source = arguments.file;
  return {*std::move(recording), motion.output};
}

RecordedMotions read_motions(const RecordingArguments& arguments) {
  RecordedMotion first = read_motion(arguments);
  RecordedMotions all{{std::move(first.recording)}, first.output};
  RecordingArguments other = arguments;
  for (const std::string& file : arguments.more) {
    other.file = file;
    all.recordings.push_back(read_motion(other).recording);
  }
  return all;
}

void write_contents(const RecordingArguments& arguments, bool as_json) {
  const auto contents = list_named_recording(*arguments.command, arguments.file, recording_options(arguments));
  if (!contents) refuse_input(contents.error());
  const Outputs outputs(*arguments.command);
  if (as_json) return outputs.print(results::line(results::recording_json(*contents)));
  using report::Align;
  report::TextTable table{{Align::right, Align::left, Align::right, Align::left}, {{"", "column", "samples", ""}}};
  for (std::size_t i = 0; i < contents->columns.size(); ++i) {
    const RecordingColumn& column = contents->columns[i];
    table.rows.push_back({std::to_string(i + 1), column.name, std::to_string(column.size), column.detail});
  }
  std::string text = report::layout(table);
  for (const Remark& remark : contents->remarks) {
    text += remark_line(remark) + "\n";
  }
  outputs.print_text(text);
}

}  // namespace zwidth::cli

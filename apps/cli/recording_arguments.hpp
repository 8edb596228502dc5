#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/io/recording_file.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::cli {

/// What the commands about recordings share on their command line: the file, its columns, its time axis, its format.
struct RecordingArguments {
  std::string file;               ///< "-": standard input
  std::vector<std::string> more;  ///< further recordings of the same device
  ColumnRequest force;
  ColumnRequest position;  ///< one of these three
  ColumnRequest velocity;
  ColumnRequest acceleration;
  RecordingOptions options;  ///< all but the columns
  bool list = false;         ///< print what the file holds and do nothing else

  // As typed; recording_options() translates them.
  std::string format = "auto";
  std::string delimiter;
  std::string decimal_mark;
  bool header = false;
  bool no_header = false;
  const CLI::App* command = nullptr;  ///< whose options these are
};

/// Declares FILE and the options; `arguments` must outlive the parsing.
void add_recording_arguments(CLI::App& command, RecordingArguments& arguments);

inline constexpr const char* recording_group = "Recording";

/// The options alone, in the group recording_group; the file is named otherwise.
void add_recording_options(CLI::App& command, RecordingArguments& arguments);

/// The reader's options as the command line asks for them, without columns. Throws BadInput.
[[nodiscard]] RecordingOptions recording_options(const RecordingArguments& arguments);

/// Force and motion as recorded together.
struct RecordedMotion {
  Recording recording;  ///< channels: force, motion
  OutputQuantity output = OutputQuantity::position;
};

/// The column of the sensed position that was named, or that needs no name; empty: neither.
[[nodiscard]] std::string position_column(const RecordingArguments& arguments);

/// Reads force and motion, and shows progress.
/// Throws BadInput: a column that is not named (the message lists the file's), or a file that is refused.
[[nodiscard]] RecordedMotion read_motion(const RecordingArguments& arguments);

/// The file and those beside it, all read alike.
struct RecordedMotions {
  std::vector<Recording> recordings;
  OutputQuantity output = OutputQuantity::position;
};
[[nodiscard]] RecordedMotions read_motions(const RecordingArguments& arguments);

/// Prints what the file holds, for --list: a table, or with --json a document. Throws BadInput.
void write_contents(const RecordingArguments& arguments, bool as_json);

}  // namespace zwidth::cli

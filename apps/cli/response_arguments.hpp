#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/recording_arguments.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::cli {

/// How a command that needs a frequency response gets one: from a recording, or from a table of a response.
struct ResponseArguments {
  RecordingArguments recording;
  FrequencyResponseOptions options;  ///< what needs no translation is parsed straight into it
  ResponseTableOptions table;
  bool is_table = false;

  // As typed; response_source() translates them.
  std::optional<std::size_t> period;
  bool aperiodic = false;
  bool no_detrend = false;
  std::optional<double> lowest_hz;
  std::optional<double> highest_hz;
  std::optional<double> frequency_step_hz;
  std::string window = "hann";
  std::string estimator = "h1";
  std::vector<std::string> lines;
  std::optional<std::string> frequency_unit;
  std::optional<std::string> phase_unit;
  const CLI::App* command = nullptr;  ///< whose options these are
};

/// Declares the recording's options, those of the estimate and those of a table; `arguments` must outlive the parsing.
void add_response_arguments(CLI::App& command, ResponseArguments& arguments);

/// What the command line names: a recording and how its response is estimated, or a table of a response.
struct ResponseSource {
  std::string name;                   ///< the file's name
  std::vector<Recording> recordings;  ///< none for a table
  FrequencyResponseOptions options;   ///< of the recordings' estimate
  MeasuredResponse table;             ///< where there is no recording
  const CLI::App* command = nullptr;  ///< whose options named it
  [[nodiscard]] std::optional<double> sampling_period() const;
};

/// Reads the file, with progress. Throws BadInput for a file or an option that is refused.
[[nodiscard]] ResponseSource response_source(const ResponseArguments& arguments);

/// The response, judged. Throws BadInput where the recording has none.
[[nodiscard]] MeasuredResponse measured_response(const ResponseSource& source);

/// Those that say how it is measured.
[[nodiscard]] OptionsByMember options_of_response();

}  // namespace zwidth::cli

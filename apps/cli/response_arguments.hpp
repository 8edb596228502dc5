#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/recording_arguments.hpp"
#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/io/recording_file.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::cli {

/// How a command that needs a frequency response gets one: from a recording, or from a table of a response.
struct ResponseArguments {
  RecordingArguments recording;
  FrequencyResponseOptions options;  ///< what needs no translation is parsed straight into it
  ResponseTableOptions table;
  bool is_table = false;

  // As typed; measured_response() translates them.
  std::optional<std::size_t> period;
  bool aperiodic = false;
  bool no_detrend = false;
  std::optional<double> lowest_hz;
  std::optional<double> highest_hz;
  std::optional<double> frequency_step_hz;
  std::string window = "hann";
  std::string estimator = "h1";
  std::optional<std::string> frequency_unit;
  std::optional<std::string> phase_unit;
  const CLI::App* command = nullptr;  ///< whose options these are
};

/// Declares the recording's options, those of the estimate and those of a table; `arguments` must outlive the parsing.
void add_response_arguments(CLI::App& command, ResponseArguments& arguments);

/// The measured response with every remark on the way to it: reading, signals, estimate.
struct MeasuredResponse {
  std::string source;          ///< the file's name
  FrequencyResponse response;  ///< its remarks moved to the ones below
  std::vector<Remark> remarks;
  std::optional<RecordedMotion> motion;  ///< absent for a table
  FrequencyResponseOptions options;      ///< of the estimate, where there is a motion
};

/// Reads the file and estimates the response, with progress. Throws BadInput for a file or an option that is refused.
[[nodiscard]] MeasuredResponse measured_response(const ResponseArguments& arguments);

}  // namespace zwidth::cli

#pragma once

#include <CLI/App.hpp>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "zwidth/io/device_file.hpp"
#include "zwidth/io/recorded_columns.hpp"
#include "zwidth/io/recording_file.hpp"
#include "zwidth/io/study_file.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::cli {

/// What one request may make. On the command line and in Python there are no such bounds.
struct RequestBounds {
  double samples = std::numeric_limits<double>::infinity();
  std::size_t threads = std::numeric_limits<std::size_t>::max();
  std::size_t answer = std::numeric_limits<std::size_t>::max();    ///< bytes
  std::size_t unpacked = std::numeric_limits<std::size_t>::max();  ///< bytes of a recording that came compressed
  FilesBeside files = FilesBeside::refused;  ///< that the text of a device names; Python reads them
};

/// What a command reads and writes where it does not run on the command line: the names that its arguments give stand
/// for what is here and for nothing else, no file is written, and the answer stays in memory.
struct RequestContext {
  std::map<std::string, std::string> devices;     ///< TOML text by name
  std::map<std::string, std::string> recordings;  ///< by name, where the system has the bytes open: /proc/self/fd/7
  std::map<std::string, std::shared_ptr<const RecordedColumns>> columns;  ///< recordings that are in no file, by name
  /// What varies, of a study: TOML text, or the path of a file.
  std::optional<std::variant<std::string, std::filesystem::path>> study;
  RequestBounds bounds;
  Progress progress;   ///< of long work; throwing from it ends the work
  std::string output;  ///< what the command wrote to standard output
  // What the document does not hold, for who takes it from here.
  std::optional<std::string> device;                  ///< the device that was found, as a file's text
  std::map<std::string, std::vector<double>> series;  ///< samples by name
};

/// That of the command's Program; null: the disk and the standard streams.
[[nodiscard]] RequestContext* request_of(const CLI::App& command);

/// Throws BadInput, naming the option, where a request asks for more samples than it may.
void check_samples(const CLI::App& command, const char* option, double samples);

/// The same of threads.
void check_threads(const CLI::App& command, const char* option, std::size_t threads);

/// Keeps what a document does not hold; nothing is done on the command line.
void hand_over_device(const CLI::App& command, const std::string& text);
void hand_over_series(const CLI::App& command, const std::string& name, const std::vector<double>& samples);

// The library's readers, of files by their name, or of what the command's request has by that name. The commands read
// nothing in another way.
[[nodiscard]] tl::expected<Device, InputError> read_named_device(const CLI::App& command, const std::string& name,
                                                                 std::span<const std::string> overrides);
/// A study of the device.
[[nodiscard]] tl::expected<StudyFile, InputError> read_named_study(const CLI::App& command, const std::string& name,
                                                                   const Device& device);
[[nodiscard]] tl::expected<Recording, InputError> read_named_recording(const CLI::App& command, const std::string& name,
                                                                       const RecordingOptions& options,
                                                                       const Progress& progress = {});
[[nodiscard]] tl::expected<RecordingContents, InputError> list_named_recording(const CLI::App& command,
                                                                               const std::string& name,
                                                                               const RecordingOptions& options);
[[nodiscard]] tl::expected<FrequencyResponse, InputError> read_named_table(const CLI::App& command,
                                                                           const std::string& name,
                                                                           const ResponseTableOptions& options,
                                                                           const Progress& progress = {});

}  // namespace zwidth::cli

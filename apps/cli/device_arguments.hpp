#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "report/analysed_device.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::cli {

/// What the commands about devices share on their command line.
struct DeviceArguments {
  std::vector<std::string> files;      ///< "-": standard input
  std::vector<std::string> overrides;  ///< KEY=VALUE of every --set, applied to every file
  const CLI::App* command = nullptr;   ///< whose options they are
};

enum class FileCount { one_or_none, one, several };

/// Declares FILE (or FILE...) and --set; `arguments` must outlive the parsing.
void add_device_arguments(CLI::App& command, DeviceArguments& arguments, FileCount count);

/// Reads all the devices, in order. Throws BadInput with one line per file that was refused, so that one run shows
/// every mistake and nothing is computed before all input is known to be good.
[[nodiscard]] std::vector<Device> read_devices(const DeviceArguments& arguments);

/// Analyses the devices of the files, in order. Throws WorkFailed with the file's name where an analysis fails.
[[nodiscard]] std::vector<report::AnalysedDevice> analyze_devices(const DeviceArguments& arguments,
                                                                  std::vector<Device> devices,
                                                                  const AnalysisOptions& options = {});

/// The same for read_devices().
[[nodiscard]] std::vector<report::AnalysedDevice> analyze_devices(const DeviceArguments& arguments,
                                                                  const AnalysisOptions& options = {});

}  // namespace zwidth::cli

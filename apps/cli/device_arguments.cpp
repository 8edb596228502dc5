#include "cli/device_arguments.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "cli/input_problem.hpp"
#include "cli/option_units.hpp"
#include "cli/request_context.hpp"
#include "cli/subcommand.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::cli {

void add_device_arguments(CLI::App& command, DeviceArguments& arguments, FileCount count) {
  arguments.command = &command;
  command.add_option("FILE", arguments.files, "Device file (TOML); - reads standard input")
      ->type_name("")
      ->required(count != FileCount::one_or_none)
      ->expected(1, count == FileCount::several ? CLI::detail::expected_max_vector_size : 1);
  command.add_option("--set", arguments.overrides, "Override a key of the device file; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

std::vector<Device> read_devices(const DeviceArguments& arguments) {
  if (std::count(arguments.files.begin(), arguments.files.end(), "-") > 1) {
    throw BadInput("", "standard input (-) is given more than once", "it can be read once");
  }
  std::vector<Device> devices;
  std::vector<InputProblem> problems;
  for (const std::string& file : arguments.files) {
    if (auto device = read_named_device(*arguments.command, file, arguments.overrides)) {
      devices.push_back(*std::move(device));
    } else {
      std::ranges::move(problems_in(device.error()), std::back_inserter(problems));
    }
  }
  if (!problems.empty()) throw BadInput(std::move(problems));
  for (const Device& device : devices) check_option_units(*arguments.command, device.parameters().motion);
  return devices;
}

std::vector<report::AnalysedDevice> analyze_devices(const DeviceArguments& arguments, std::vector<Device> devices,
                                                    const AnalysisOptions& options) {
  std::vector<report::AnalysedDevice> analysed;
  for (Device& device : devices) {
    analysed.push_back(
        worked(arguments.files[analysed.size()], [&] { return report::analysed_device(std::move(device), options); }));
  }
  return analysed;
}

std::vector<report::AnalysedDevice> analyze_devices(const DeviceArguments& arguments, const AnalysisOptions& options) {
  return analyze_devices(arguments, read_devices(arguments), options);
}

}  // namespace zwidth::cli

#include "cli/device_arguments.hpp"

#include <algorithm>

#include "cli/subcommand.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::cli {

void add_device_arguments(CLI::App& command, DeviceArguments& arguments, FileCount count) {
  command.add_option("FILE", arguments.files, "Device file (TOML); - reads standard input")
      ->type_name("")
      ->required()
      ->expected(1, count == FileCount::one ? 1 : CLI::detail::expected_max_vector_size);
  command
      .add_option("--set", arguments.overrides,
                  "Override a key of the device file, for instance --set loop.delay=0.25e-3; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

std::vector<Device> read_devices(const DeviceArguments& arguments) {
  if (std::count(arguments.files.begin(), arguments.files.end(), "-") > 1) {
    throw BadInput("standard input (-) is given more than once; it can be read once");
  }
  std::vector<Device> devices;
  std::string problems;
  for (const std::string& file : arguments.files) {
    if (auto device = read_device_file(file, arguments.overrides)) {
      devices.push_back(*std::move(device));
    } else {
      problems += (problems.empty() ? "" : "\n") + device.error().str();
    }
  }
  if (!problems.empty()) throw BadInput(problems);
  return devices;
}

}  // namespace zwidth::cli

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "cli/device_arguments.hpp"
#include "cli/request_commands.hpp"
#include "cli/standard_output.hpp"
#include "cli/subcommand.hpp"
#include "server/api/api.hpp"
#include "server/http/embedded_files.hpp"
#include "server/http/http_server.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/mechanism.hpp"

extern char** environ;

namespace zwidth::cli {
namespace {

struct ServeArguments {
  DeviceArguments devices;
  server::HttpOptions http;
  bool opens = false;
};

/// What the device file of a mechanism names stands in it: nobody but this program can read that file.
DeviceParameters with_mechanism_text(DeviceParameters device) {
  if (!device.mechanism) return device;
  MechanismFile& mechanism = device.mechanism->mechanism;
  if (mechanism.text.empty()) mechanism.text = MechanismModel(mechanism).text();
  mechanism.path.clear();
  return device;
}

/// The same of a device that comes with the program, comments and all.
std::string with_embedded_mechanism(const server::EmbeddedFile& device) {
  std::string toml(device.bytes);
  for (const server::EmbeddedFile& each : server::embedded_devices()) {
    if (!each.name.ends_with(".xml")) continue;
    const std::string named = fmt::format("file = \"{}\"\n", std::filesystem::path(each.name).filename().string());
    const std::size_t at = toml.find(named);
    if (at != std::string::npos) toml.replace(at, named.size(), fmt::format("text = '''\n{}'''\n", each.bytes));
  }
  return toml;
}

/// The devices of the command line first, then those that come with the program.
std::vector<server::OfferedDevice> offered_devices(const DeviceArguments& arguments) {
  std::vector<server::OfferedDevice> offered;
  const std::vector<Device> devices = read_devices(arguments);
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const std::string name = std::filesystem::path(arguments.files[i]).filename().string();
    offered.push_back({name, write_device(with_mechanism_text(devices[i].parameters())), true});
  }
  for (const server::EmbeddedFile& file : server::embedded_devices()) {
    if (!file.name.ends_with(".toml") || file.name.starts_with("studies/")) continue;
    offered.push_back({std::string(file.name), with_embedded_mechanism(file), false});
  }
  return offered;
}

/// Leaves a browser to itself; without one, the address is on standard output all the same.
void open_browser(std::string address) {
  std::string program = "xdg-open";
  std::array<char*, 3> arguments{program.data(), address.data(), nullptr};
  posix_spawn_file_actions_t quiet;
  ::posix_spawn_file_actions_init(&quiet);
  ::posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", 1 /* O_WRONLY */, 0);
  ::posix_spawn_file_actions_addopen(&quiet, 2, "/dev/null", 1 /* O_WRONLY */, 0);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, program.c_str(), &quiet, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&quiet);
  if (error != 0) return write_standard_error("zwidth: --open: there is no xdg-open; open the address yourself\n");
  std::thread([child] { ::waitpid(child, nullptr, 0); }).detach();
}

void run_serve(const ServeArguments& arguments) {
  if (!server::is_address(arguments.http.host)) {
    throw BadInput("--host", fmt::format("{}: is no address", arguments.http.host),
                   "an IP address of this machine, or localhost");
  }
  const server::RecordingLimits recordings;
  const RequestCommands commands({.samples = 2e6,
                                  .threads = std::max(1U, std::thread::hardware_concurrency()),
                                  .answer = std::size_t{64} << 20,
                                  .unpacked = recordings.unpacked});
  server::Api api(commands, offered_devices(arguments.devices), recordings);
  const auto started = [&](const server::Started& at) {
    write_standard_output(at.address + "\n");
    if (!at.hosts.empty()) {
      write_standard_error(
          fmt::format("zwidth: it listens at every address of this machine; callers may name it as {}\n",
                      fmt::join(at.hosts, ", ")));
    }
    if (arguments.opens) open_browser(at.address);
  };
  try {
    server::serve(api, arguments.http, started);
  } catch (const std::system_error& error) {
    throw WorkFailed(fmt::format("{}:{}: {}; name another with --host and --port, 0 for any free port",
                                 arguments.http.host, arguments.http.port, error.code().message()));
  }
}

}  // namespace

void add_serve(CLI::App& app) {
  auto arguments = std::make_shared<ServeArguments>();
  CLI::App* command = app.add_subcommand("serve", "The workbench in a browser, and the commands over HTTP");
  add_device_arguments(*command, arguments->devices, FileCount::several);
  command->get_option("FILE")->required(false);
  command->add_option("--port", arguments->http.port, "Port to listen at; 0: any free one")
      ->type_name("PORT")
      ->capture_default_str();
  command->add_option("--host", arguments->http.host, "Address to listen at; all but loopback need the printed token")
      ->type_name("ADDRESS")
      ->capture_default_str();
  command->add_flag("--open", arguments->opens, "Open the page in the browser");
  command->footer(
      "Prints the address, and runs until interrupted; what runs then is finished within\n"
      "10 s, a second interrupt ends it at once.\n"
      "\n"
      "Examples:\n"
      "  zwidth serve\n"
      "  zwidth serve devices/lhifam.toml --open");
  command->callback([arguments] { run_serve(*arguments); });
}

}  // namespace zwidth::cli

#include "cli/flight_file.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "cli/outputs.hpp"
#include "cli/standard_output.hpp"
#include "report/output_file.hpp"

namespace zwidth::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* flight_option = "--flight-record";

/// An absolute path that a variable holds: others are no place that anybody would find again.
fs::path directory_in(const char* variable) {
  const char* value = std::getenv(variable);
  const fs::path path = value != nullptr ? value : "";
  return path.is_absolute() ? path : fs::path();
}

std::vector<fs::path> directories() {
  std::vector<fs::path> found;
  if (const fs::path state = directory_in("XDG_STATE_HOME"); !state.empty()) {
    found.push_back(state / "zwidth");
  } else if (const fs::path home = directory_in("HOME"); !home.empty()) {
    found.push_back(home / ".local/state/zwidth");
  }
  std::error_code none;
  if (const fs::path temporary = fs::temp_directory_path(none); !none) found.push_back(temporary);
  return found;
}

void keep(const CLI::App& command, const rig::FlightRecorder& recorder) {
  const std::string name =
      fmt::format("flight-{:%Y%m%d-%H%M%S}-{}.csv", fmt::gmtime(std::time(nullptr)), static_cast<long>(getpid()));
  std::string failures;
  for (const fs::path& directory : directories()) {
    const std::string path = directory / name;
    std::error_code reported_by_the_write;
    fs::create_directories(directory, reported_by_the_write);
    try {
      Outputs file(command);
      file.add(flight_option, path);
      file.put(flight_option, [&](const report::Sink& sink) { recorder.write(sink); });
      file.commit();
      return write_standard_error(fmt::format("zwidth: flight record: {}\n", path));
    } catch (const report::OutputFailed& failure) {
      failures += fmt::format("zwidth: flight record: {}\n", failure.what());
    }
  }
  write_standard_error(failures + "zwidth: flight record: is lost; name a file with --flight-record\n");
}

}  // namespace

void keep_flight_record(const CLI::App& command, const rig::FlightRecorder& recorder) noexcept {
  try {
    keep(command, recorder);
  } catch (const std::exception& failure) {
    write_standard_error("zwidth: flight record: is lost: ");
    write_standard_error(failure.what());
    write_standard_error("\n");
  }
}

}  // namespace zwidth::cli

// What `simulate --json` and `relay --json` print is what one call of the library answers, byte for byte.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/workspace.hpp"
#include "property/random_devices.hpp"
#include "results/relay_json.hpp"
#include "results/simulation_json.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::cli {
namespace {

constexpr std::uint64_t seed = 20260901;
constexpr std::size_t random_devices = 200;
constexpr std::size_t random_relays = 40;  // their predictions take longer
constexpr const char* failed = "failed";

class OneCall : public Workspace {
 protected:
  /// Runs "zwidth COMMAND FILE --json" for every file; one line of output each, `failed` where it exits otherwise.
  [[nodiscard]] std::vector<std::string> lines_of(const std::vector<std::string>& commands) const {
    std::string script;
    for (const std::string& command : commands) {
      script += fmt::format("zwidth {} --json 2> .ignored || echo {}\n", command, failed);
    }
    std::istringstream output(run(script).output);
    std::vector<std::string> lines;
    for (std::string line; std::getline(output, line);) lines.push_back(line);
    return lines;
  }

  [[nodiscard]] std::vector<std::string> device_files() const {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(directory() / "devices")) {
      if (entry.path().extension() == ".toml") files.push_back("devices/" + entry.path().filename().string());
    }
    std::sort(files.begin(), files.end());
    return files;
  }

  [[nodiscard]] Device device_in(const std::string& file, const std::vector<std::string>& overrides = {}) const {
    return *read_device_file((directory() / file).string(), overrides);
  }
};

template <typename Answer>
std::string line_of(Answer&& answer) {
  try {
    std::string line = results::line(answer());
    line.pop_back();
    return line;
  } catch (const Error&) {
    return failed;
  }
}

/// A device with a wall, some of them with friction, encoder and force limit.
DeviceParameters loop_device(test::RandomDevices& random, std::size_t i) {
  DeviceParameters device = random.device(test::device_kinds[i % test::device_kinds.size()]);
  device.wall.stiffness = random.log_uniform(10.0, 2e4);
  if (random.chance(0.3)) device.sensor.resolution = random.log_uniform(1e-6, 1e-3);
  if (random.chance(0.3)) device.actuator.force_limit = random.log_uniform(1.0, 30.0);
  for (std::size_t k = 0; k < device.bodies.size() && k < 2; ++k) {
    if (random.chance(0.3)) device.bodies[k].coulomb = random.log_uniform(0.01, 10.0);
  }
  return device;
}

TEST_F(OneCall, SimulateIsTheLibrarysAnswer) {
  std::vector<std::string> commands;
  std::vector<std::string> wanted;
  for (const std::string& file : device_files()) {
    const Device device = device_in(file, {"wall.stiffness=500"});
    commands.push_back("simulate " + file + " --set wall.stiffness=500");
    wanted.push_back(line_of([&] { return results::simulation_json(device, simulate(device)); }));
    EXPECT_NE(wanted.back(), failed) << file;
  }
  test::RandomDevices random(seed);
  for (std::size_t i = 0; i < random_devices; ++i) {
    const std::string file = fmt::format("{}.toml", i);
    write(file, write_device(loop_device(random, i)));
    const Device device = device_in(file);
    SimulationOptions options;
    options.duration = std::max(400.0 * device.loop().sampling_period, 3.0 * device.loop().delay);
    options.wall_position = device.has_bodies() ? 0.0 : 1e-3;
    commands.push_back(
        fmt::format("simulate {} --duration {} --wall-position {}", file, *options.duration, *options.wall_position));
    wanted.push_back(line_of([&] { return results::simulation_json(device, simulate(device, options)); }));
  }
  const std::vector<std::string> found = lines_of(commands);
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], wanted[i]) << commands[i] << ", seed " << seed;
  EXPECT_LT(std::count(wanted.begin(), wanted.end(), failed), 5);
}

TEST_F(OneCall, RelayIsTheLibrarysAnswer) {
  std::vector<std::string> commands;
  std::vector<std::string> wanted;
  const auto add = [&](const std::string& file, RelayOptions options) {
    const Device device = device_in(file);
    const double samples = std::max(500.0, 2.0 * device.loop().delay / device.loop().sampling_period);
    options.relay.amplitude = 0.5;
    options.duration = samples * device.loop().sampling_period;
    options.trials = 2;
    options.start_offset = device.has_bodies() ? 0.01 : 0.0;
    commands.push_back(fmt::format("relay {} --amplitude 0.5 --duration {} --trials 2 --start {} --segment 256", file,
                                   options.duration, options.start_offset));
    options.analysis.segment_length = 256;
    wanted.push_back(line_of([&] { return results::relay_json(relay(device, options)); }));
  };
  for (const std::string& file : device_files()) add(file, {});
  test::RandomDevices random(seed);
  for (std::size_t i = 0; i < random_relays; ++i) {
    const std::string file = fmt::format("{}.toml", i);
    write(file, write_device(loop_device(random, i)));
    add(file, {});
  }
  const std::vector<std::string> found = lines_of(commands);
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], wanted[i]) << commands[i] << ", seed " << seed;
  EXPECT_LT(std::count(wanted.begin(), wanted.end(), failed), 5);
}

}  // namespace
}  // namespace zwidth::cli

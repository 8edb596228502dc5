// What each command prints about a device is what one call of the library answers, byte for byte: on every device file
// and on 200 random devices (100 where a relay is predicted, 40 in a second format).

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/same_answer.hpp"
#include "export/export.hpp"
#include "export/export_c.hpp"
#include "export/export_chai3d.hpp"
#include "property/random_devices.hpp"
#include "results/analysis_json.hpp"
#include "results/bode_json.hpp"
#include "results/design_json.hpp"
#include "results/diagnosis_json.hpp"
#include "results/excitation_json.hpp"
#include "results/export_json.hpp"
#include "results/region_json.hpp"
#include "results/relay_json.hpp"
#include "results/simulation_json.hpp"
#include "results/wall_recommendation_json.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::cli {
namespace {

constexpr std::uint64_t seed = 20260901;
constexpr std::size_t random_devices = 200;

constexpr std::size_t of_another_format = 40;  // of what is compared on all of them as JSON

/// Few bodies: what the limit for any user takes little time for.
constexpr std::array<std::string_view, 4> quick_kinds = {"rigid", "transfer_function", "two_mass", "transfer_function"};
/// Whose slopes, or the limit cycles of a relay, take little time too.
constexpr std::array<std::string_view, 4> two_body_kinds = {"two_mass", "light_damping", "operator", "grounded"};

/// A command with its options, and the library's answer; either may depend on the device.
struct Command {
  const char* name;
  std::string (*options)(const Device& device);
  Answer (*answer)(const Device& device);
  std::span<const std::string_view> kinds = test::device_kinds;
  std::size_t count = random_devices;
};

void PrintTo(const Command& command, std::ostream* stream) { *stream << command.name; }

Answer json_line(const results::Json& json) { return {results::line(json)}; }

SimulationOptions short_simulation(const Device& device) {
  SimulationOptions options;
  options.duration = std::max(400.0 * device.loop().sampling_period, 3.0 * device.loop().delay);
  options.wall_position = device.has_bodies() ? 0.0 : 1e-3;
  return options;
}

RelayOptions short_relay(const Device& device) {
  RelayOptions options;
  options.relay.amplitude = 0.5;
  options.duration =
      std::max(500.0, 2.0 * device.loop().delay / device.loop().sampling_period) * device.loop().sampling_period;
  options.trials = 1;
  options.start_offset = device.has_bodies() ? 0.01 : 0.0;
  options.analysis.segment_length = 256;
  return options;
}

/// In the device's own time, whatever that is.
ExcitationOptions short_excitation(const Device& device) {
  const double rate = 1.0 / device.loop().sampling_period;
  ExcitationOptions options;
  options.kind = ExcitationKind::multisine;
  options.amplitude = 0.25;
  options.duration = 1000.0 / rate;
  options.lowest_hz = 0.02 * rate;
  options.highest_hz = 0.2 * rate;
  options.stroke_limit = 0.5;
  return options;
}

std::string excitation_arguments(const Device& device) {
  const ExcitationOptions options = short_excitation(device);
  return fmt::format("--kind multisine --amplitude 0.25 --duration {} --lowest-hz {} --highest-hz {} --stroke 0.5",
                     options.duration, options.lowest_hz, options.highest_hz);
}

Answer coded_wall(const Device& device) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.stiffness = 300.0;
  const Device with_wall(parameters);
  return {report::export_c({{with_wall, analyze(with_wall, {.draws = 0})}, {}, "--stiffness"})};
}

Answer ceilings(const Device& device) {
  const SafeWall wall = safe_wall(device, {.safety_factor = 0.5, .damping = SafeWallOptions::Damping::ceiling});
  if (wall.status != SafeWall::Status::chosen) return {"", 1};
  return {report::export_chai3d(device, wall, 0.5)};
}

/// A third of the way to Nyquist.
double heard_hz(const Device& device) { return 1.0 / (6.0 * device.loop().sampling_period); }

Answer diagnosed(const Device& device) {
  const DiagnosisOptions options{.frequency = 2.0 * std::numbers::pi * heard_hz(device)};
  const Diagnosis diagnosis = diagnose(device, options);
  return {results::line(results::diagnosis_json(device, options, diagnosis)), diagnosis.trust.refused() ? 1 : 0};
}

Answer recommended(const Device& device) {
  const RecommendationOptions options{.ripple = 0.2};
  const WallRecommendation wall = recommend_wall(device, options);
  return {results::line(results::wall_recommendation_json(device, options, wall)),
          wall.status == WallRecommendation::Status::refused ? 1 : 0};
}

const std::array commands = {
    Command{"Analyze", [](const Device&) -> std::string { return "analyze FILE --json"; },
            [](const Device& device) { return json_line(results::analysis_json(device, analyze(device))); }},
    Command{"Bode", [](const Device&) -> std::string { return "bode FILE --json --points 20"; },
            [](const Device& device) { return json_line(results::bode_json(device, bode(device, {.points = 20}))); }},
    Command{"BodeCsv", [](const Device&) -> std::string { return "bode FILE --points 5 -o b.csv && cat b.csv"; },
            [](const Device& device) -> Answer { return {results::bode_csv(bode(device, {.points = 5}))}; },
            quick_kinds, of_another_format},
    Command{"Region", [](const Device&) -> std::string { return "region FILE --json"; },
            [](const Device& device) {
              const WallRegion walls = region(device);
              return Answer{results::line(results::region_json(device, walls)), walls.trust.refused() ? 1 : 0};
            },
            quick_kinds},
    Command{"Design", [](const Device&) -> std::string { return "design FILE --json"; },
            [](const Device& device) { return json_line(results::design_json(device, design(device))); },
            two_body_kinds},
    Command{"Recommend", [](const Device&) -> std::string { return "design FILE --recommend --ripple 0.2 --json"; },
            recommended, quick_kinds, of_another_format},
    Command{
        "Diagnose",
        [](const Device& device) { return fmt::format("diagnose FILE --oscillates-hz {} --json", heard_hz(device)); },
        diagnosed, quick_kinds},
    Command{"Simulate",
            [](const Device& device) {
              const SimulationOptions options = short_simulation(device);
              return fmt::format("simulate FILE --json --duration {} --wall-position {}", *options.duration,
                                 *options.wall_position);
            },
            [](const Device& device) {
              return json_line(results::simulation_json(device, simulate(device, short_simulation(device))));
            }},
    Command{"Relay",
            [](const Device& device) {
              const RelayOptions options = short_relay(device);
              return fmt::format("relay FILE --json --amplitude 0.5 --duration {} --trials 1 --start {} --segment 256",
                                 options.duration, options.start_offset);
            },
            [](const Device& device) { return json_line(results::relay_json(relay(device, short_relay(device)))); },
            two_body_kinds, random_devices / 2},
    Command{"ExportJson", [](const Device&) -> std::string { return "export FILE --format json"; },
            [](const Device& device) { return json_line(results::export_json(device_model(device))); }},
    Command{"ExportOctave", [](const Device&) -> std::string { return "export FILE --format octave"; },
            [](const Device& device) -> Answer { return {report::export_octave(device_model(device))}; },
            test::device_kinds, of_another_format},
    Command{"ExportPython", [](const Device&) -> std::string { return "export FILE --format python"; },
            [](const Device& device) -> Answer { return {report::export_python(device_model(device))}; },
            test::device_kinds, of_another_format},
    Command{"ExportC", [](const Device&) -> std::string { return "export FILE --format c --stiffness 300"; },
            coded_wall, quick_kinds, of_another_format},
    Command{"ExportChai3d", [](const Device&) -> std::string { return "export FILE --format chai3d"; }, ceilings,
            quick_kinds, of_another_format},
    Command{"Excite",
            [](const Device& device) {
              return "excite --device FILE --json --beyond-limits " + excitation_arguments(device);
            },
            [](const Device& device) {
              return json_line(results::excitation_json(excite(short_excitation(device), device)));
            }},
    Command{"ExciteCsv",
            [](const Device& device) { return "excite --device FILE --beyond-limits " + excitation_arguments(device); },
            [](const Device& device) {
              Answer answer;
              results::write_excitation_csv(excite(short_excitation(device), device),
                                            [&](std::string_view rows) { answer.output += rows; });
              return answer;
            },
            quick_kinds, of_another_format},
};

/// With a wall; some with friction, encoder and force limit.
DeviceParameters random_device(test::RandomDevices& random, std::string_view kind) {
  DeviceParameters device = random.device(kind);
  device.wall.stiffness = random.log_uniform(10.0, 2e4);
  if (random.chance(0.3)) device.sensor.resolution = random.log_uniform(1e-6, 1e-3);
  if (random.chance(0.3)) device.actuator.force_limit = random.log_uniform(1.0, 30.0);
  for (std::size_t k = 0; k < device.bodies.size() && k < 2; ++k) {
    if (random.chance(0.3)) device.bodies[k].coulomb = random.log_uniform(0.01, 10.0);
  }
  return device;
}

class SameAnswerOn : public SameAnswer, public ::testing::WithParamInterface<Command> {
 protected:
  [[nodiscard]] Question question(const std::string& file) const {
    const Device device = *read_device_file((directory() / file).string(), {});
    std::string command = GetParam().options(device);
    command.replace(command.find("FILE"), 4, file);
    return {command, [device, answer = GetParam().answer] { return answer(device); }};
  }
};

TEST_P(SameAnswerOn, EveryDeviceFile) {
  std::vector<Question> questions;
  for (const auto& entry : std::filesystem::directory_iterator(directory() / "devices")) {
    const std::string file = "devices/" + entry.path().filename().string();
    DeviceParameters parameters = read_device_file((directory() / file).string(), {})->parameters();
    if (!parameters.wall.stiffness) parameters.wall.stiffness = 300.0;
    write("with_wall_" + entry.path().filename().string(), write_device(parameters));
    questions.push_back(question("with_wall_" + entry.path().filename().string()));
  }
  EXPECT_GT(questions.size(), 5U);
  expect_same(questions);
}

TEST_P(SameAnswerOn, RandomDevices) {
  SCOPED_TRACE(fmt::format("seed {}", seed));
  test::RandomDevices random(seed);
  std::vector<Question> questions;
  for (std::size_t i = 0; i < GetParam().count; ++i) {
    const std::string file = fmt::format("{}.toml", i);
    write(file, write_device(random_device(random, GetParam().kinds[i % GetParam().kinds.size()])));
    questions.push_back(question(file));
  }
  expect_same(questions);
}

INSTANTIATE_TEST_SUITE_P(Commands, SameAnswerOn, ::testing::ValuesIn(commands),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace zwidth::cli

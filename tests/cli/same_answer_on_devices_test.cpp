// What each command prints about a device is what one call of the library answers, byte for byte: on every device file
// and on a random device of each kind, the rows of its CSV too where it has some.

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
#include "results/design_target_json.hpp"
#include "results/diagnosis_json.hpp"
#include "results/excitation_json.hpp"
#include "results/export_json.hpp"
#include "results/region_json.hpp"
#include "results/relay_json.hpp"
#include "results/simulation_json.hpp"
#include "results/study_json.hpp"
#include "results/wall_recommendation_json.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/study_file.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/study/study_run.hpp"

namespace zwidth::cli {
namespace {

constexpr std::uint64_t seed = 20260901;
/// Where there are fewer kinds: some have friction, an encoder, a force limit.
constexpr std::size_t fewest_devices = 6;

/// Few bodies: what the limit for any user takes little time for.
constexpr std::array<std::string_view, 3> quick_kinds = {"rigid", "transfer_function", "two_mass"};
/// Whose slopes take little time too.
constexpr std::array<std::string_view, 5> quick_body_kinds = {"two_mass", "rigid", "light_damping", "operator",
                                                              "grounded"};
/// Whose limit cycles of a relay take little time.
constexpr std::array<std::string_view, 4> two_body_kinds = {"two_mass", "light_damping", "operator", "grounded"};
constexpr std::array<std::string_view, 1> two_mass_kind = {"two_mass"};
/// Of which a thousand take little time.
constexpr std::array<std::string_view, 2> kernel_kinds = {"two_mass", "rigid"};

/// A command with its options, and the library's answer; either may depend on the device. What it writes to FILE.csv
/// is compared too.
struct Command {
  const char* name;
  std::string (*options)(const Device& device);
  Answer (*answer)(const Device& device);
  std::span<const std::string_view> kinds = test::device_kinds;
};

void PrintTo(const Command& command, std::ostream* stream) { *stream << command.name; }

Answer json_line(const results::Json& json, const std::string& csv = {}) { return {results::line(json) + csv}; }

SimulationOptions short_simulation(const Device& device) {
  SimulationOptions options;
  options.duration = std::max(400.0 * device.loop().sampling_period, 3.0 * device.loop().delay);
  options.wall_position = device.has_bodies() ? 0.0 : 1e-3;
  options.keep_every = 1;
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
  return {report::export_c({wall_to_run(device, {.stiffness = 300.0}), {}, "--stiffness"})};
}

Answer ceilings(const Device& device) {
  if (has_damper_loop(device.loop())) return {"", 2};  // CHAI3D runs the damper with the spring
  const SafeWall wall = safe_wall(device, {.safety_factor = 0.5, .damping = SafeWallOptions::Damping::ceiling});
  if (wall.status != SafeWall::Status::chosen) return {"", 1};
  return {report::export_chai3d(device, wall, 0.5)};
}

/// A third of the way to Nyquist.
double heard_hz(const Device& device) { return 1.0 / (6.0 * device.loop().sampling_period); }

Answer diagnosed(const Device& device) {
  const DiagnosisOptions options{.frequency = 2.0 * std::numbers::pi * heard_hz(device)};
  const Diagnosis diagnosis = diagnose(device, options);
  return {results::line(results::diagnosis_json(device, diagnosis))};
}

Answer recommended(const Device& device) {
  const RecommendationOptions options{.phase_margin = 0.0, .quantisation_force = 0.2, .drive_damper = true};
  const WallRecommendation wall = recommend_wall(device, options);
  return {results::line(results::wall_recommendation_json(device, options, wall))};
}

/// Three delays, from none to two periods.
Answer swept(const Device& device) {
  const SweepAxis axis{"loop.delay", 0.0, 2.0 * device.loop().sampling_period, 3};
  const ParameterSweep sweep = parameter_sweep(device, {axis}, {.any_user = device.has_bodies()});
  return json_line(results::sweep_json(device, sweep), results::sweep_csv(sweep));
}

std::string sweep_arguments(const Device& device) {
  return fmt::format("design FILE --sweep loop.delay=0:{}:3{} --json --output FILE.csv",
                     2.0 * device.loop().sampling_period, device.has_bodies() ? " --any-user" : "");
}

constexpr User compared_user{0.5, 6.0, 135.0};

Answer compared(const Device& device) {
  DeviceVariants delayed{"loop.delay", {}};
  for (const double delay : {0.0, device.loop().sampling_period}) {
    DeviceParameters parameters = device.parameters();
    parameters.loop.delay = delay;
    delayed.variants.push_back({fmt::format("{}", delay), Device(parameters)});
  }
  const auto user = device.has_bodies() ? std::optional(compared_user) : std::nullopt;
  return json_line(results::comparison_json(compare_designs(delayed, user)));
}

std::string comparison_arguments(const Device& device) {
  return fmt::format("design FILE --compare loop.delay=0,{}{} --json", device.loop().sampling_period,
                     device.has_bodies() ? " --operator 0.5,6,135" : "");
}

Answer targeted(const Device& device) {
  const DesignTargetOptions options{.stiffness = 3000.0};
  return json_line(results::design_target_json(device, options, design_targets(device, options)));
}

Answer notched(const Device& device) {
  const NotchOptions options{.phase_margin = 0.0};
  return json_line(results::notch_json(device, options, design_notch(device, options)));
}

/// Every kind of device has a sampling period.
constexpr const char* study_text =
    "samples = 50\nspecification.critical_stiffness = 300\n[[parameter]]\nkey = \"loop.sampling_period\"\n"
    "distribution = \"uniform\"\nrelative_tolerance = 0.2\n";

Answer studied(const Device& device) {
  auto file = parse_study(study_text, "study.toml", device);
  const StudyRun run(device, file->distributions,
                     {.samples = *file->samples, .specification = file->specification, .index_samples = 16});
  const Study answer = study(run.device(), run.distributions(), run.options());
  return {results::line(results::study_json(run, answer))};
}

const std::array commands = {
    Command{"Analyze", [](const Device&) -> std::string { return "analyze FILE --json"; },
            [](const Device& device) { return json_line(results::analysis_json(device, analyze(device))); }},
    Command{"Bode", [](const Device&) -> std::string { return "bode FILE --json --points 20 --output FILE.csv"; },
            [](const Device& device) {
              const Bode answer = bode(device, {.points = 20});
              return json_line(results::bode_json(device, answer), results::bode_csv(answer));
            }},
    Command{"Region", [](const Device&) -> std::string { return "region FILE --json --csv FILE.csv"; },
            [](const Device& device) {
              const WallRegion walls = region(device);
              if (walls.trust.refused())
                return Answer{results::line(results::region_json(device, walls)), 1};  // its file is not written
              return json_line(results::region_json(device, walls), results::region_csv(walls));
            },
            quick_kinds},
    Command{"Design", [](const Device&) -> std::string { return "design FILE --json"; },
            [](const Device& device) { return json_line(results::design_json(device, design(device))); },
            quick_body_kinds},
    Command{"Sweep", sweep_arguments, swept, quick_kinds},
    Command{"Compare", comparison_arguments, compared, quick_kinds},
    Command{"Target", [](const Device&) -> std::string { return "design FILE --target 3000 --json"; }, targeted,
            quick_kinds},
    Command{"Notch", [](const Device&) -> std::string { return "design FILE --notch --phase-margin-deg 0 --json"; },
            notched, two_mass_kind},
    Command{
        "Recommend",
        [](const Device&) -> std::string { return "design FILE --recommend --phase-margin-deg 0 --ripple 0.2 --json"; },
        recommended, quick_kinds},
    Command{
        "Diagnose",
        [](const Device& device) { return fmt::format("diagnose FILE --oscillates-hz {} --json", heard_hz(device)); },
        diagnosed, quick_kinds},
    Command{"Simulate",
            [](const Device& device) {
              const SimulationOptions options = short_simulation(device);
              return fmt::format("simulate FILE --json --duration {} --wall-position {} --csv FILE.csv",
                                 *options.duration, *options.wall_position);
            },
            [](const Device& device) {
              const Simulation answer = simulate(device, short_simulation(device));
              return json_line(results::simulation_json(device, answer), results::simulation_csv(device, answer));
            }},
    Command{"Relay",
            [](const Device& device) {
              const RelayOptions options = short_relay(device);
              return fmt::format(
                  "relay FILE --json --amplitude 0.5 --duration {} --trials 1 --start {} --segment 256 --csv FILE.csv",
                  options.duration, options.start_offset);
            },
            [](const Device& device) {
              const RelayResult answer = relay(device, short_relay(device));
              return json_line(results::relay_json(answer), results::relay_csv(answer));
            },
            two_body_kinds},
    Command{"Study",
            [](const Device&) -> std::string { return "study FILE --study study.toml --index-samples 16 --json"; },
            studied, kernel_kinds},
    Command{"ExportJson", [](const Device&) -> std::string { return "export FILE --format json"; },
            [](const Device& device) { return json_line(results::export_json(device_model(device))); }},
    Command{"ExportOctave", [](const Device&) -> std::string { return "export FILE --format octave"; },
            [](const Device& device) -> Answer { return {report::export_octave(device_model(device))}; }},
    Command{"ExportPython", [](const Device&) -> std::string { return "export FILE --format python"; },
            [](const Device& device) -> Answer { return {report::export_python(device_model(device))}; }},
    Command{"ExportC", [](const Device&) -> std::string { return "export FILE --format c --stiffness 300"; },
            coded_wall, quick_kinds},
    Command{"ExportChai3d", [](const Device&) -> std::string { return "export FILE --format chai3d"; }, ceilings,
            quick_kinds},
    Command{"Excite",
            [](const Device& device) {
              return "excite --device FILE --json --output FILE.csv --beyond-limits " + excitation_arguments(device);
            },
            [](const Device& device) {
              const Excitation answer = excite(short_excitation(device), device);
              std::string rows;
              results::write_excitation_csv(answer, [&](std::string_view piece) { rows += piece; });
              return json_line(results::excitation_json(answer), rows);
            }},
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
  SameAnswerOn() { write("study.toml", study_text); }

  [[nodiscard]] Question question(const std::string& file) const {
    const Device device = *read_device_file((directory() / file).string(), {});
    std::string command = GetParam().options(device);
    for (std::size_t at = command.find("FILE"); at != std::string::npos; at = command.find("FILE")) {
      command.replace(at, 4, file);
    }
    const std::string csv = file + ".csv";
    const bool has_csv = command.find(csv) != std::string::npos;
    return {command, [device, answer = GetParam().answer] { return answer(device); }, has_csv ? csv : ""};
  }
};

TEST_P(SameAnswerOn, EveryDeviceFile) {
  std::vector<Question> questions;
  for (const auto& entry : std::filesystem::directory_iterator(directory() / "devices")) {
    if (!entry.is_regular_file()) continue;
    const std::string file = "devices/" + entry.path().filename().string();
    DeviceParameters parameters = read_device_file((directory() / file).string(), {})->parameters();
    if (!parameters.wall.stiffness) parameters.wall.stiffness = 300.0;
    const bool asks_for_a_mode = GetParam().answer == notched;
    if (asks_for_a_mode && find_problem(NotchOptions{}, Device(parameters))) continue;
    write("with_wall_" + entry.path().filename().string(), write_device(parameters));
    questions.push_back(question("with_wall_" + entry.path().filename().string()));
  }
  EXPECT_GT(questions.size(), 3U);
  expect_same(questions);
}

TEST_P(SameAnswerOn, RandomDevices) {
  SCOPED_TRACE(fmt::format("seed {}", seed));
  test::RandomDevices random(seed);
  std::vector<Question> questions;
  const std::size_t devices = how_many(std::max(GetParam().kinds.size(), fewest_devices));
  for (std::size_t i = 0; i < devices; ++i) {
    const std::string file = fmt::format("{}.toml", i);
    write(file, write_device(random_device(random, GetParam().kinds[i % GetParam().kinds.size()])));
    questions.push_back(question(file));
  }
  expect_same(questions);
}

INSTANTIATE_TEST_SUITE_P(Commands, SameAnswerOn, ::testing::ValuesIn(commands),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace

std::vector<std::string> commands_compared_on_devices() {
  const Device device(test::RandomDevices(seed).device("rigid"));
  std::vector<std::string> all;
  for (const Command& command : commands) all.push_back(command.options(device));
  return all;
}

}  // namespace zwidth::cli

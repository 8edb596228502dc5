// What each command prints of a recording is what one call of the library answers, byte for byte: on the project's
// recordings and on simulated ones.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "cli/same_answer.hpp"
#include "property/random_devices.hpp"
#include "results/csv.hpp"
#include "results/diagnosis_json.hpp"
#include "results/frf_json.hpp"
#include "results/identification_json.hpp"
#include "results/relay_json.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/recording_file.hpp"
#include "zwidth/simulation/synthetic_record.hpp"

namespace zwidth::cli {
namespace {

constexpr std::uint64_t seed = 20261122;
constexpr std::size_t random_recordings = 2;  // a multisine and a chirp

/// A recording and the device that it was simulated with.
struct Recorded {
  Recording recording;  ///< force, position
  Device device;
};

/// A command on a recording, and the library's answer. What it writes to FILE.csv is compared too.
struct Command {
  const char* name;
  const char* command;  ///< FILE: the recording, DEVICE: the device
  Answer (*answer)(const Recorded& recorded);
  std::string_view kind = "rigid";  ///< of the devices
  double duration = 4.0;            ///< s
};

void PrintTo(const Command& command, std::ostream* stream) { *stream << command.name; }

Answer frf(const Recorded& recorded) {
  const MeasuredResponse answer = frequency_response(recorded.recording);
  return {results::line(results::frf_json(answer)) + results::frf_csv(answer)};
}

Answer inverse_dynamics(const Recorded& recorded) {
  return {results::line(results::identification_json(identify_rigid_body(recorded.recording)))};
}

NamedStructure named(const std::string& structure, const Recorded& recorded) {
  return named_structure(structure, {.record_period = recorded.recording.sampling_period}).value();
}

Answer fitted(const Recorded& recorded, const std::string& name, IdentifyOptions options = {}) {
  const NamedStructure structure = named(name, recorded);
  options.structure_values = structure.values;
  return {results::line(results::identification_json(
      identify(recorded.recording, Device(structure.parameters), options), results::PointsInJson::included))};
}

Answer rigid(const Recorded& recorded) { return fitted(recorded, "rigid"); }

Answer lines_of_rigid(const Recorded& recorded) {
  IdentifyOptions options;
  options.method = IdentifyOptions::Method::lines;
  return fitted(recorded, "rigid", options);
}

/// The whole two-body structure takes seconds for each.
Answer link_of_two_bodies(const Recorded& recorded) {
  IdentifyOptions options;
  options.fit.free = {"link.0.stiffness", "link.0.damping"};
  options.fit.start = ParameterFitOptions::Start::from_structure;
  return {results::line(results::identification_json(identify(recorded.recording, recorded.device, options)))};
}

/// Of the force as a relay's, whatever it was; predictions for a device are compared where one is simulated.
Answer relay_reading(const Recorded& recorded) {
  RelayRecordOptions options;
  options.analysis.segment_length = 256;
  return {results::line(results::relay_json(relay(recorded.recording, options)))};
}

Answer heard(const Recorded& recorded) {
  Recording position = recorded.recording;
  position.channels.erase(position.channels.begin());
  const Diagnosis answer = diagnose(recorded.device, position, {.stiffness = 300.0});
  return {results::line(results::diagnosis_json(recorded.device, answer))};
}

constexpr std::array commands = {
    Command{"Frf", "frf FILE --force force --position position --json --csv FILE.csv", frf, "two_mass"},
    Command{"InverseDynamics", "identify FILE --force force --position position --json --method inverse-dynamics",
            inverse_dynamics},
    Command{"Rigid", "identify FILE --force force --position position --json --points --structure rigid", rigid,
            "rigid", 2.0},
    Command{"LinkOfTwoBodies",
            "identify FILE --force force --position position --json --structure DEVICE "
            "--free link.stiffness,link.damping --from-structure",
            link_of_two_bodies, "two_mass", 1.0},
    Command{
        "Lines",
        "identify FILE --force force --position position --json --points --method frequency-response --structure rigid",
        lines_of_rigid},
    Command{"Relay", "relay --recording FILE --force force --position position --json --segment 256", relay_reading,
            "two_mass", 1.0},
    Command{"Diagnose", "diagnose DEVICE --recording FILE --position position --stiffness 300 --json", heard, "rigid",
            1.0},
};

Recording read(const std::filesystem::path& directory, const std::string& file) {
  RecordingOptions options;
  options.columns = {{"force"}, {"position"}};
  Recording recording = read_recording((directory / file).string(), options).value();
  recording.source = file;
  return recording;
}

class SameAnswerOfRecordings : public SameAnswer {
 protected:
  static std::string of(const char* command, const std::string& file) {
    return fmt::format("{} {} --json --force force --position position ", command, file);
  }
};

/// Those that few random recordings lead to: every method and structure at its full length.
TEST_F(SameAnswerOfRecordings, OfTheProject) {
  std::vector<Question> questions;
  const auto ask = [&](const std::string& command, const std::string& file, Answer (*answer)(const Recorded&)) {
    const Device lhifam = *read_device_file((directory() / "devices/lhifam.toml").string(), {});
    questions.push_back({command, [=, this] { return answer({read(directory(), file), lhifam}); }});
  };
  for (const char* file : {"recordings/locked_chirp.csv", "recordings/free_motion.csv"}) {
    ask(of("frf", file), file, [](const Recorded& recorded) -> Answer {
      return {results::line(results::frf_json(frequency_response(recorded.recording)))};
    });
    ask(of("identify", file) + "--points --structure rigid", file, rigid);
  }
  const std::string free_motion = "recordings/free_motion.csv";
  const std::string locked_chirp = "recordings/locked_chirp.csv";
  ask(of("identify", free_motion) + "--method inverse-dynamics", free_motion, inverse_dynamics);
  ask(of("identify", free_motion) + "--points --method frequency-response --structure rigid", free_motion,
      lines_of_rigid);
  ask(of("identify", locked_chirp) + "--points --structure two-body", locked_chirp,
      [](const Recorded& recorded) { return fitted(recorded, "two-body"); });
  ask(of("identify", locked_chirp) +
          "--structure devices/lhifam.toml --locked handle --free link.stiffness,link.damping",
      locked_chirp, [](const Recorded& recorded) -> Answer {
        IdentifyOptions options;
        options.fit.free = {"link.0.stiffness", "link.0.damping"};
        options.fit.locked = {"handle"};
        return {results::line(results::identification_json(identify(recorded.recording, recorded.device, options)))};
      });
  expect_same(questions);
}

class SameAnswerOnRecordings : public SameAnswer, public ::testing::WithParamInterface<Command> {
 protected:
  /// A device's motion as a recorder keeps it: there and back.
  void write_simulated(const std::string& file, test::RandomDevices& random, const Device& device,
                       ExcitationKind kind) const {
    ExcitationOptions options;
    options.kind = kind;
    options.lowest_hz = 4.0 / GetParam().duration;
    options.highest_hz = random.log_uniform(50.0, 200.0);
    options.duration = 0.5 * GetParam().duration;
    options.fade_in = 0.0;
    std::vector<double> force = excite(options, device).samples;
    const std::size_t size = force.size();
    for (std::size_t k = 0; k < size; ++k) force.push_back(-force[k]);
    const SyntheticRecord record = synthetic_record(device, force, {0.005, random.index(1000)});
    results::Csv csv({"time", "force", "position"});
    for (std::size_t k = 0; k < record.force.size(); ++k) {
      csv.row(results::Shortest{static_cast<double>(k) * record.sampling_period}, record.force[k], record.position[k]);
    }
    write(file, csv.text());
  }
};

TEST_P(SameAnswerOnRecordings, OfRandomDevices) {
  SCOPED_TRACE(fmt::format("seed {}", seed));
  test::RandomDevices random(seed);
  std::vector<Question> questions;
  for (std::size_t i = 0; i < how_many(random_recordings); ++i) {
    const std::string file = fmt::format("{}.run", i);
    const std::string device_file = fmt::format("{}.toml", i);
    DeviceParameters parameters = random.device(GetParam().kind);
    parameters.sensor.resolution = 1e-7;
    write(device_file, write_device(parameters));
    const Device device = *read_device_file((directory() / device_file).string(), {});
    write_simulated(file, random, device, i % 2 == 0 ? ExcitationKind::multisine : ExcitationKind::linear_chirp);
    std::string command = GetParam().command;
    const std::array<std::pair<std::string_view, std::string>, 2> names{{{"FILE", file}, {"DEVICE", device_file}}};
    for (const auto& [name, value] : names) {
      for (std::size_t at = command.find(name); at != std::string::npos; at = command.find(name)) {
        command.replace(at, name.size(), value);
      }
    }
    const std::string csv = file + ".csv";
    questions.push_back({command,
                         [this, file, device, answer = GetParam().answer] {
                           return answer({read(directory(), file), device});
                         },
                         command.find(csv) != std::string::npos ? csv : ""});
  }
  expect_same(questions);
}

INSTANTIATE_TEST_SUITE_P(Commands, SameAnswerOnRecordings, ::testing::ValuesIn(commands),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace

std::vector<std::string> commands_compared_on_recordings() {
  std::vector<std::string> all;
  for (const Command& command : commands) all.emplace_back(command.command);
  return all;
}

}  // namespace zwidth::cli

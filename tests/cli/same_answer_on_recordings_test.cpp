// What `frf` and `identify` print of a recording is what one call of the library answers, byte for byte: on the
// project's recordings and on 200 simulated ones.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "cli/same_answer.hpp"
#include "property/random_devices.hpp"
#include "results/csv.hpp"
#include "results/frf_json.hpp"
#include "results/identification_json.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/recording_file.hpp"
#include "zwidth/simulation/synthetic_record.hpp"

namespace zwidth::cli {
namespace {

constexpr std::uint64_t seed = 20261122;
constexpr std::size_t random_recordings = 200;
constexpr std::size_t random_fits = 10;  // of a structure to a response: a quarter of a second each

/// The structure that the program knows by this name: all its numbers are to be fitted.
Device named_structure(const std::string& name, double period) {
  DeviceParameters structure;
  structure.name = name;
  structure.bodies.push_back({name == "rigid" ? "body" : "motor", 1.0, 1.0, 0.0, 0.0});
  if (name == "two-body") {
    structure.bodies.push_back({"handle", 1.0, 1.0, 0.0, 0.0});
    structure.links.push_back({0, 1, 1.0, 1.0});
    structure.loop.held = 1;
  }
  structure.loop.sampling_period = period;
  return Device(structure);
}

class SameAnswerOnRecordings : public SameAnswer {
 protected:
  [[nodiscard]] Recording read(const std::string& file) const {
    RecordingOptions options;
    options.columns = {{"force"}, {"position"}};
    Recording recording = read_recording((directory() / file).string(), options).value();
    recording.source = file;
    return recording;
  }

  static std::string of(const char* command, const std::string& file) {
    return fmt::format("{} {} --json --force force --position position ", command, file);
  }

  [[nodiscard]] Question frf(const std::string& file) const {
    return {of("frf", file),
            [=, this]() -> Answer { return {results::line(results::frf_json(frequency_response(read(file))))}; }};
  }

  [[nodiscard]] Question inverse_dynamics(const std::string& file) const {
    return {of("identify", file) + "--method inverse-dynamics", [=, this]() -> Answer {
              return {results::line(results::identification_json(identify_rigid_body(read(file))))};
            }};
  }

  [[nodiscard]] Question identified(const std::string& file, const std::string& structure) const {
    return {of("identify", file) + "--points --structure " + structure, [=, this]() -> Answer {
              const Recording recording = read(file);
              const Device device = named_structure(structure, recording.sampling_period);
              IdentifyOptions options;
              options.structure_values = IdentifyOptions::StructureValues::placeholders;
              options.fit.free = fittable_parameters(device);
              return {results::line(
                  results::identification_json(identify(recording, device, options), results::PointsInJson::included))};
            }};
  }

  /// Four seconds of a device of this kind as a recorder keeps them: there and back.
  void write_simulated(const std::string& file, test::RandomDevices& random, const char* kind) const {
    DeviceParameters parameters = random.device(kind);
    parameters.sensor.resolution = 1e-7;
    const Device device(parameters);
    ExcitationOptions options;
    options.kind = random.chance(0.5) ? ExcitationKind::multisine : ExcitationKind::linear_chirp;
    options.lowest_hz = 2.0;
    options.highest_hz = random.log_uniform(50.0, 200.0);
    options.duration = 2.0;
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

TEST_F(SameAnswerOnRecordings, OfTheProject) {
  std::vector<Question> questions;
  for (const char* file : {"recordings/locked_chirp.csv", "recordings/free_motion.csv"}) {
    questions.push_back(frf(file));
    questions.push_back(identified(file, "rigid"));
  }
  questions.push_back(inverse_dynamics("recordings/free_motion.csv"));
  questions.push_back(identified("recordings/locked_chirp.csv", "two-body"));
  questions.push_back({of("identify", "recordings/locked_chirp.csv") +
                           "--structure devices/lhifam.toml --locked handle --free link.stiffness,link.damping",
                       [this]() -> Answer {
                         IdentifyOptions options;
                         options.fit.free = {"link.0.stiffness", "link.0.damping"};
                         options.fit.locked = {"handle"};
                         options.loop_delay = IdentifyOptions::LoopDelay::as_given;
                         const Device lhifam = *read_device_file((directory() / "devices/lhifam.toml").string(), {});
                         return {results::line(results::identification_json(
                             identify(read("recordings/locked_chirp.csv"), lhifam, options)))};
                       }});
  expect_same(questions);
}

TEST_F(SameAnswerOnRecordings, OfRandomDevices) {
  SCOPED_TRACE(fmt::format("seed {}", seed));
  test::RandomDevices random(seed);
  std::vector<Question> questions;
  for (std::size_t i = 0; i < random_recordings; ++i) {
    const std::string file = fmt::format("{}.csv", i);
    const bool rigid = i % 2 == 0;
    write_simulated(file, random, rigid ? "rigid" : "two_mass");
    questions.push_back(frf(file));
    if (rigid) questions.push_back(inverse_dynamics(file));
    if (i < random_fits) questions.push_back(identified(file, rigid ? "rigid" : "two-body"));
  }
  expect_same(questions);
}

}  // namespace
}  // namespace zwidth::cli

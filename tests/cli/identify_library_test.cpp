// What `identify --json` and `frf --json` print is what the library's one call answers.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/workspace.hpp"
#include "property/random_recordings.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::cli {
namespace {

using nlohmann::json;

const char* verdict_name(const Trust& trust) {
  return trust.sound() ? "sound" : trust.refused() ? "refused" : "doubtful";
}

class SameAsTheLibrary : public Workspace {
 protected:
  [[nodiscard]] json document(const std::string& command) const {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, 0) << command << "\n" << outcome.errors;
    return json::parse(outcome.output, nullptr, false);
  }

  static Recording read(const std::string& path, std::optional<double> rate = std::nullopt) {
    RecordingOptions options;
    options.rate = rate;
    options.columns = {{"force"}, {"position"}};
    return read_recording(path, options).value();
  }

  /// The recording as a file of the workspace, its numbers in full.
  std::string written(const Recording& recording) const {
    std::ofstream file(directory() / "record.csv");
    file << "force,position\n";
    for (std::size_t i = 0; i < recording.channels[0].samples.size(); ++i) {
      file << fmt::format("{:.17g},{:.17g}\n", recording.channels[0].samples[i], recording.channels[1].samples[i]);
    }
    return "record.csv";
  }
};

void expect_same(const json& printed, const Identification& found) {
  EXPECT_EQ(printed["trust"]["verdict"], verdict_name(found.trust));
  EXPECT_EQ(printed["trust"]["reasons"], json(found.trust.reasons));
  ASSERT_EQ(printed["parameters"].size(), found.fit.estimates.size());
  for (std::size_t i = 0; i < found.fit.estimates.size(); ++i) {
    EXPECT_EQ(printed["parameters"][i]["key"], found.fit.estimates[i].key);
    EXPECT_EQ(printed["parameters"][i]["value"], found.fit.estimates[i].value);
  }
  EXPECT_EQ(printed["remarks"].size(), found.remarks.size());
  EXPECT_EQ(printed["basis"]["virtual_damping"], found.basis.virtual_damping);
  if (found.trust.refused()) {
    EXPECT_TRUE(printed["critical_stiffness"].is_null());
    return;
  }
  EXPECT_EQ(printed["critical_stiffness"], found.analysis.critical.stiffness);
  ASSERT_TRUE(found.analysis.interval);
  EXPECT_EQ(printed["critical_stiffness_interval"][0], found.analysis.interval->lower);
  EXPECT_EQ(printed["critical_stiffness_interval"][1], found.analysis.interval->upper);
}

TEST_F(SameAsTheLibrary, ForTheLockedChirp) {
  const std::string folder = ZWIDTH_SOURCE_DIR;
  const Recording recording = read(folder + "/recordings/locked_chirp.csv");
  const json frf = document("zwidth frf recordings/locked_chirp.csv --force force --position position --json");
  const MeasuredResponse measured = frequency_response(recording);
  EXPECT_EQ(frf["trust"]["verdict"], verdict_name(measured.trust));
  EXPECT_EQ(frf["critical_stiffness"], measured.stiffness->limit->stiffness);
  EXPECT_EQ(frf["remarks"].size(), measured.remarks.size());

  IdentifyOptions options;
  options.fit.free = {"link.0.stiffness", "link.0.damping"};
  options.fit.locked = {"handle"};
  options.loop_delay = IdentifyOptions::LoopDelay::as_given;
  const Device lhifam = read_device_file(folder + "/devices/lhifam.toml").value();
  expect_same(document("zwidth identify recordings/locked_chirp.csv --force force --position position --structure "
                       "devices/lhifam.toml --locked handle --free link.stiffness,link.damping --json"),
              identify(recording, lhifam, options));
}

TEST_F(SameAsTheLibrary, ForInverseDynamics) {
  const Recording recording = read(std::string(ZWIDTH_SOURCE_DIR) + "/recordings/free_motion.csv");
  const json printed = document(
      "zwidth identify recordings/free_motion.csv --force force --position position --method inverse-dynamics --json");
  const RigidBodyIdentification found = identify_rigid_body(recording);
  EXPECT_EQ(printed["parameters"][0]["value"], found.fit.mass.value);
  EXPECT_EQ(printed["trust"]["verdict"], verdict_name(found.trust));
  EXPECT_EQ(printed["remarks"].size(), found.remarks.size());
}

TEST_F(SameAsTheLibrary, ForSimulatedRecordings) {
  int compared = 0;
  for (std::uint64_t seed = 1; compared < 4; ++seed) {
    const auto made = test::random_recording(seed, {0.0, 0.0});
    if (!made || made->truth.bodies.size() > 2 || made->truth.loop.sensed != 0) continue;
    SCOPED_TRACE("seed " + std::to_string(seed));
    ++compared;
    const std::string file = written(made->recording);
    const double rate = std::round(1.0 / made->recording.sampling_period);
    const std::string common = fmt::format("{} --force force --position position --rate {} --json", file, rate);
    const Recording recording = read((directory() / file).string(), rate);
    DeviceParameters structure = made->structure;
    const bool rigid = structure.bodies.size() == 1;
    structure.bodies[0].name = rigid ? "body" : "motor";
    if (!rigid) structure.bodies[1].name = "handle";
    IdentifyOptions options;
    options.structure_values = IdentifyOptions::StructureValues::placeholders;
    options.fit.free = fittable_parameters(Device(structure));
    expect_same(document("zwidth identify " + common + " --structure " + (rigid ? "rigid" : "two-body")),
                identify(recording, Device(structure), options));
  }
}

}  // namespace
}  // namespace zwidth::cli

// From a recording on disk to a device file with intervals: 20 s at 1 kHz, as the paper's locked experiment and as a
// free two-body device of which nothing is known.

#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "lhifam.hpp"
#include "zwidth/zwidth.hpp"

namespace {

using namespace zwidth;

constexpr double period = 1e-3;
constexpr double amplitude = 5.0;
constexpr double encoder_step = 3.14e-6;

/// The record of a 20 s chirp on a device, as a CSV file of some 600 kB.
class RecordFile {
 public:
  RecordFile(const Device& device, double lowest_hz)
      : path_(std::filesystem::temp_directory_path() / "zwidth_bench.csv") {
    ExcitationOptions options;
    options.amplitude = amplitude;
    options.lowest_hz = lowest_hz;
    const std::vector<double> command = excite(options).samples;
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(0.0, 0.005 * amplitude);
    std::vector<double> force = command;
    for (double& value : force) value += noise(random);
    const std::vector<double> position = forced_response(sample(state_space(device), {period, 0.0}), force);
    std::ofstream file(path_);
    file.precision(9);
    file << "time,force,position\n";
    for (std::size_t i = 0; i < command.size(); ++i) {
      file << static_cast<double>(i) * period << ',' << command[i] << ','
           << encoder_step * std::round(position[i] / encoder_step) << '\n';
    }
  }
  ~RecordFile() { std::filesystem::remove(path_); }
  RecordFile(const RecordFile&) = delete;
  RecordFile& operator=(const RecordFile&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string fitted_file(const std::string& path, const Device& structure, const IdentifyOptions& identify_options) {
  RecordingOptions options;
  options.columns = {{"force", 1.0}, {"position", 1.0}};
  const auto recording = read_recording(path, options);
  return write_device(identify(*recording, structure, identify_options).fit.device.parameters());
}

void locked_device_to_file(benchmark::State& state) {
  const Device device(test::lhifam_parameters());
  const RecordFile record(locked_device(device, {1}), 10.0);
  DeviceParameters structure = test::lhifam_parameters();
  structure.links[0] = {.first = 0, .second = 1, .stiffness = 1e4, .damping = 1.0};
  IdentifyOptions options;
  options.fit.locked = {"handle"};
  options.fit.free = {"link.stiffness", "link.damping"};
  for (auto _ : state) benchmark::DoNotOptimize(fitted_file(record.path(), Device(structure), options));
}

void free_device_to_file(benchmark::State& state) {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies[1].mass = 0.4;
  device.bodies[1].damping = 0.9;
  const RecordFile record(Device(device), 1.0);
  DeviceParameters structure = device;
  for (Body& body : structure.bodies) body.mass = body.damping = 1.0;
  for (Link& link : structure.links) link.stiffness = link.damping = 1.0;
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  for (auto _ : state) benchmark::DoNotOptimize(fitted_file(record.path(), Device(structure), options));
}

BENCHMARK(locked_device_to_file)->Unit(benchmark::kMillisecond);
BENCHMARK(free_device_to_file)->Unit(benchmark::kMillisecond);

}  // namespace

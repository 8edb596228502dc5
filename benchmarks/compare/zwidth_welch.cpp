// The library's side of compare_welch.py: reads doubles (all of force, then all of position) from a file, writes the
// response "frequency_hz real imaginary" by line to another, and prints the seconds of each repetition.

#include <fmt/core.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <span>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"

int main(int argc, char** argv) {
  if (argc != 6) {
    fmt::print(stderr, "usage: zwidth_welch SIGNALS SAMPLES SEGMENT REPETITIONS RESPONSE\n");
    return 2;
  }
  const auto samples = static_cast<std::size_t>(std::strtoull(argv[2], nullptr, 10));
  std::vector<double> signals(2 * samples);
  std::ifstream file(argv[1], std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(signals.data()),
                 static_cast<std::streamsize>(signals.size() * sizeof(double)))) {
    fmt::print(stderr, "{}: cannot be read\n", argv[1]);
    return 2;
  }
  const std::span<const double> all(signals);
  zwidth::FrequencyResponseOptions options;
  options.excitation = zwidth::FrequencyResponseOptions::Excitation::aperiodic;
  options.segment_length = static_cast<std::size_t>(std::strtoull(argv[3], nullptr, 10));
  options.overlap = 0.5;
  zwidth::FrequencyResponse response;
  for (int i = 0; i < std::atoi(argv[4]); ++i) {
    const auto start = std::chrono::steady_clock::now();
    response = zwidth::frequency_response(all.first(samples), all.last(samples), 1e-3, options);
    fmt::print("{}\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::ofstream lines(argv[5]);
  for (const zwidth::ResponsePoint& point : response.points) {
    lines << fmt::format("{:.17g} {:.17g} {:.17g}\n", point.frequency / (2.0 * std::numbers::pi), point.value.real(),
                         point.value.imag());
  }
  return lines ? 0 : 1;
}

// From a recorded force and position to the frequency response with its noise.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/identification/measured_stiffness.hpp"

namespace {

constexpr double sampling_period = 1e-3;

struct Record {
  std::vector<double> force;
  std::vector<double> position;
};

/// A damped free mass under a force of noise, the same one again every `period` samples.
Record record(std::size_t samples, std::size_t period) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Record made{std::vector<double>(samples), std::vector<double>(samples)};
  double velocity = 0.0;
  double position = 0.0;
  for (std::size_t i = 0; i < samples; ++i) {
    made.force[i] = i < period ? normal(generator) : made.force[i - period];
    made.position[i] = position + 1e-6 * normal(generator);
    position += sampling_period * velocity;
    velocity += sampling_period * (made.force[i] - 3.0 * velocity);
  }
  return made;
}

void estimate(benchmark::State& state, const Record& record, const zwidth::FrequencyResponseOptions& options) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(zwidth::frequency_response(record.force, record.position, sampling_period, options));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(record.force.size()));
}

constexpr std::size_t never = SIZE_MAX;
constexpr std::size_t six_million = 6000000;

void aperiodic_as_detected(benchmark::State& state) { estimate(state, record(six_million, never), {}); }
BENCHMARK(aperiodic_as_detected)->Unit(benchmark::kMillisecond);

void welch_4096(benchmark::State& state) {
  zwidth::FrequencyResponseOptions options;
  options.excitation = zwidth::FrequencyResponseOptions::Excitation::aperiodic;
  options.segment_length = 4096;
  options.overlap = 0.5;
  estimate(state, record(six_million, never), options);
}
BENCHMARK(welch_4096)->Unit(benchmark::kMillisecond);

void periodic_as_detected(benchmark::State& state) { estimate(state, record(six_million, 2500), {}); }
BENCHMARK(periodic_as_detected)->Unit(benchmark::kMillisecond);

void periodic_of_prime_length(benchmark::State& state) { estimate(state, record(six_million, 99991), {}); }
BENCHMARK(periodic_of_prime_length)->Unit(benchmark::kMillisecond);

void twenty_seconds_to_critical_stiffness(benchmark::State& state) {
  const Record made = record(20000, never);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        zwidth::measured_stiffness(zwidth::frequency_response(made.force, made.position, sampling_period)));
  }
}
BENCHMARK(twenty_seconds_to_critical_stiffness)->Unit(benchmark::kMillisecond);

}  // namespace

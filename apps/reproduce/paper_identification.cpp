#include "reproduce/paper_identification.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include "report/text/quantity.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/simulation/synthetic_record.hpp"

namespace zwidth::report {

std::string paper_chirp_text(const PaperChirp& chirp, const DeviceParameters& device) {
  return fmt::format("{:g} to {:g} Hz in {:g} s, {:g} N, white force noise of {:g} %, encoder step {}, seed {}",
                     chirp.lowest_hz, chirp.highest_hz, chirp.duration, chirp.amplitude, 100.0 * chirp.force_noise,
                     quantity(device.sensor.resolution, "m"), chirp.seed);
}

Identification identified_cable(const DeviceParameters& parameters, const PaperChirp& chirp) {
  const Device device(parameters);
  const std::size_t handle = device.loop().held;

  ExcitationOptions options;
  options.amplitude = chirp.amplitude;
  options.lowest_hz = chirp.lowest_hz;
  options.highest_hz = chirp.highest_hz;
  options.duration = chirp.duration;
  const Excitation excitation = excite(options, device);
  std::vector<double> force = excitation.samples;
  const auto rest = static_cast<std::size_t>(std::round(chirp.rest * excitation.rate));
  force.insert(force.begin(), rest, 0.0);
  force.insert(force.end(), rest, 0.0);
  const SyntheticRecord record =
      synthetic_record(locked_device(device, {handle}), force, {chirp.force_noise * chirp.amplitude, chirp.seed});

  ParameterFitOptions fit_options;
  fit_options.free = {"link.0.stiffness", "link.0.damping"};
  fit_options.lowest = 2.0 * std::numbers::pi * chirp.lowest_hz;
  fit_options.highest = 2.0 * std::numbers::pi * chirp.highest_hz;
  fit_options.locked = {device.bodies()[handle].name};
  FrequencyResponse response = frequency_response(record.force, record.position, record.sampling_period);
  ParameterFit fit = fit_parameters(device, response, fit_options);
  return {.source = "a synthetic chirp",
          .method = IdentifyOptions::Method::lines,
          .response = std::move(response),
          .fit = std::move(fit)};
}

}  // namespace zwidth::report

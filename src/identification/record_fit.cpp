#include "zwidth/identification/record_fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "identification/response/encoder_rounding.hpp"
#include "identification/fit_comparison.hpp"
#include "identification/misfit_doubt.hpp"
#include "identification/motion_residuals.hpp"
#include "identification/response/pooled_response.hpp"
#include "identification/response/response_choice.hpp"
#include "identification/response/welch.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Excitation = FrequencyResponseOptions::Excitation;

/// P_M + H1(force -> y - y_M). Nothing of a device whose motion overflows.
std::optional<FrequencyResponse> corrected_response(const FrequencyResponse& last, const Device& device,
                                                    std::span<const Recording> recordings,
                                                    FrequencyResponseOptions options) {
  std::vector<Recording> rests;
  for (const Recording& recording : recordings) {
    const double period = recording.sampling_period;
    const DiscreteStateSpace sampled = sample(state_space(device), {period, device.loop().delay});
    rests.push_back({recording.source, period, recording.channels, {}});
    const std::vector<double> motion = forced_response(sampled, recording.channels[0].samples);
    std::vector<double>& rest = rests.back().channels[1].samples;
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= motion[i];
    if (!std::ranges::all_of(rest, [](double each) { return std::isfinite(each); })) return std::nullopt;
  }
  options.excitation = Excitation::aperiodic;
  options.begins_at_rest = std::ranges::all_of(recordings, [](const Recording& each) {
    return begins_at_rest(each.channels[0].samples, each.channels[1].samples);
  });
  options.lines_at_ends = *options.begins_at_rest;
  std::vector<FrequencyResponse> each = responses(rests, options);
  const SampledPlant plant = sampled_plant(device);
  for (std::size_t i = 0; i < each.size(); ++i) {
    const SweepRounding rounding(recordings[i].channels[0].samples, recordings[i].channels[1].samples);
    for (ResponsePoint& point : each[i].points) {
      point.variance += rounding.variance(point.value + zwidth::response(plant, point.frequency));
    }
  }
  FrequencyResponse response = each.size() == 1 ? std::move(each[0]) : pooled_response(each).response;
  response.remarks = last.remarks;
  for (ResponsePoint& point : response.points) {
    point.value += zwidth::response(plant, point.frequency);
    // The coherence of an output with this noise: |P|^2 against n variance.
    const double noise = std::max(1.0, response.averages) * point.variance;
    point.coherence = std::norm(point.value) / (std::norm(point.value) + noise);
  }
  std::erase_if(response.points, [](const ResponsePoint& point) { return point.value == 0.0; });
  return response;
}

}  // namespace

namespace internal {

Device device_in_experiment(const Device& fitted, const std::vector<std::string>& locked, double sampling_period) {
  std::vector<std::size_t> bodies;
  bodies.reserve(locked.size());
  for (const std::string& name : locked) bodies.push_back(fitted.body_index(name));
  DeviceParameters parameters = locked_device(fitted, bodies).parameters();
  parameters.loop.sampling_period = sampling_period;
  parameters.wall.filters.clear();  // no wall acted; and at the record's rate they may be impossible
  return Device(std::move(parameters));
}

}  // namespace internal

RecordFit without_leakage(RecordFit first, std::span<const Recording> recordings,
                          const FrequencyResponseOptions& response_options, const ParameterFitOptions& fit_options) {
  if (is_of_lines(recordings, response_options) || response_options.output != OutputQuantity::position) return first;
  if (!first.response.sampling_period) return first;
  ParameterFitOptions options = fit_options;
  options.start = ParameterFitOptions::Start::from_structure;
  options.free.clear();  // as resolved by the first fit: a fitted 0 must stay free
  for (const ParameterEstimate& estimate : first.fit.estimates) options.free.push_back(estimate.key);
  ParameterFitOptions anew = options;
  anew.start = ParameterFitOptions::Start::from_data;
  bool may_search = fit_options.start == ParameterFitOptions::Start::from_data && fit_options.search_widely;
  RecordFit best = std::move(first);
  constexpr int most_rounds = 3;
  for (int round = 0; round < most_rounds; ++round) {
    const Device device = device_in_experiment(best.fit.device, options.locked, *best.response.sampling_period);
    std::optional<FrequencyResponse> corrected =
        corrected_response(best.response, device, recordings, response_options);
    if (!corrected || corrected->points.size() <= best.fit.estimates.size() ||
        median_noise(*corrected) > median_noise(best.response)) {
      break;
    }
    FrequencyResponse& response = *corrected;
    ParameterFit fit = fit_parameters(best.fit.device, response, options);
    if (may_search && leaves_too_much(fit, response)) {
      // The leakage may have hidden that this is a side minimum.
      may_search = false;
      ParameterFit other = fit_parameters(best.fit.device, response, anew);
      if (explains_more(other, fit)) fit = std::move(other);
    }
    const bool is_done = stands_still(best.fit, fit);
    best = {std::move(fit), std::move(response)};
    if (is_done) break;
  }
  return best;
}

RecordFit fit_record(const Device& structure, std::span<const double> force, std::span<const double> output,
                     double sampling_period, const FrequencyResponseOptions& response_options,
                     const ParameterFitOptions& fit_options, const Progress& progress) {
  const auto samples = [](std::span<const double> signal) { return std::vector<double>(signal.begin(), signal.end()); };
  const Recording recording{"", sampling_period, {{"force", samples(force)}, {"output", samples(output)}}, {}};
  FrequencyResponse response = frequency_response(force, output, sampling_period, response_options, progress);
  ParameterFit fit = fit_parameters(structure, response, fit_options);
  return without_leakage({std::move(fit), std::move(response)}, std::span(&recording, 1), response_options,
                         fit_options);
}

}  // namespace zwidth

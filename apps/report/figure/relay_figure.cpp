#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "report/figure/figures.hpp"
#include "report/figure/record_figure.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "zwidth/simulation/relay.hpp"
#include "zwidth/simulation/relay_trials.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::report {
namespace {

constexpr double cycles_shown = 10.0;

/// First sample shown.
std::size_t shown_from(const RelayTrial& trial, double sampling_period) {
  if (!trial.result) return 0;
  const double samples = cycles_shown / (hertz(trial.result->frequency) * sampling_period);
  const auto count = static_cast<std::size_t>(std::ceil(samples)) + 1;
  return trial.force.size() > count ? trial.force.size() - count : 0;
}

}  // namespace

std::string draw_relay_record(const std::string& title, const RelayTrial& trial, double sampling_period, Motion motion,
                              FigureFormat format) {
  const Units units = units_of(motion);
  const std::size_t from = shown_from(trial, sampling_period);
  const std::string subtitle =
      trial.result ? fmt::format("oscillates at {:.4f} Hz, which reads as K = {} ({:.2f} dB); the last {:.0f} cycles",
                                 hertz(trial.result->frequency), quantity(trial.result->stiffness, units.stiffness),
                                 decibels(trial.result->stiffness), cycles_shown)
                   : fmt::format("No oscillation: {}", text(trial.result.error().why));
  return draw_record(title, subtitle,
                     {.force = std::span(trial.force).subspan(from),
                      .position = std::span(trial.position).subspan(from),
                      .start = static_cast<double>(from) * sampling_period,
                      .sampling_period = sampling_period,
                      .motion = motion},
                     format);
}

std::string draw_relay(const RelayResult& result, FigureFormat format) {
  const auto oscillates = [](const RelayTrial& trial) { return trial.result.has_value(); };
  auto shown = std::find_if(result.trials.begin(), result.trials.end(), oscillates);
  if (shown == result.trials.end()) shown = result.trials.begin();
  const std::string name = result.device ? result.device->name() : result.recording;
  const std::string title = result.trials.size() == 1 ? fmt::format("Relay experiment: {}", name)
                                                      : fmt::format("Relay experiment, trial {}: {}",
                                                                    shown - result.trials.begin() + 1, name);
  return draw_relay_record(title + std::string(trust_mark(result.trust)), *shown, result.sampling_period, result.motion,
                           format);
}

}  // namespace zwidth::report

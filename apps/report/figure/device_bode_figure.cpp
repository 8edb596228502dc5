#include "report/figure/device_bode_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/trust_text.hpp"
#include "report/text/wall_filter_text.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth::report {
namespace {

double nyquist(const Device& device) { return std::numbers::pi / device.loop().sampling_period; }

std::string sampling_text(const Device& device) {
  const Loop& loop = device.loop();
  std::string text = fmt::format("T = {}", quantity(loop.sampling_period, "s"));
  if (loop.delay > 0.0) text += fmt::format(", delay {}", quantity(loop.delay, "s"));
  return text;
}

/// "Force on motor, position of handle. T = 1 ms. ...": what the curves are of.
std::vector<std::string> loop_notes(const Device& device) {
  std::string loop;
  if (device.has_bodies()) {
    loop = fmt::format("Force on {}, position of {}; ", device.bodies()[device.loop().actuated].name,
                       device.bodies()[device.loop().sensed].name);
  }
  std::vector<std::string> notes{loop + sampling_text(device)};
  const Wall& wall = device.parameters().wall;
  if (wall.damping > 0.0) {
    const double period = damper_timing(device.loop()).sampling_period;
    notes.push_back(fmt::format(
        "The virtual damper of {}{} is closed in the sampled response{}.",
        quantity(wall.damping, units_of(device.parameters().motion).damping),
        wall.velocity_filter_hz > 0.0 ? fmt::format(" behind its {} filter", quantity(wall.velocity_filter_hz, "Hz"))
                                      : "",
        has_damper_loop(device.loop()) ? fmt::format(", every {} in a loop of its own", quantity(period, "s")) : ""));
  }
  if (const auto filters = wall_filters_text(wall)) {
    notes.push_back("The sampled response is seen through the filters of the wall: " + *filters + ".");
  }
  return notes;
}

void add_marks(BodeFigure& figure, const AnalysedDevice& analysed, std::size_t curve, std::string_view suffix) {
  const CriticalStiffness& critical = analysed.analysis.critical;
  const std::string_view holder = words_of(holder_of(analysed.analysis.limits));
  for (const Crossover& crossover : critical.crossovers) {
    const bool is_on_axis = crossover.frequency >= figure.range.from && crossover.frequency <= figure.range.to;
    if (crossover.frequency > 0.0 && !is_on_axis) continue;
    const bool limits = critical.limit && critical.limit->frequency == crossover.frequency;
    const std::string belongs_to = crossover.limited_by.kind == Oscillator::Kind::rigid_body
                                       ? "rigid body"
                                       : fmt::format("vibration mode {}", crossover.limited_by.mode);
    figure.marks.push_back(
        {curve, crossover, limits ? BodeMark::Rank::critical : BodeMark::Rank::other,
         fmt::format(", {}{}{}", belongs_to, limits ? fmt::format(": critical, {}", holder) : "", suffix)});
  }
}

/// A filter with a zero at z = -1 (every low-pass) takes the curve down without end: the last of it is not drawn.
void cut_at_nyquist_zero(const Device& device, std::vector<BodePoint>& points) {
  const std::vector<FilterSection> filters =
      filtered_plant(sampled_plant(device), device.parameters().wall.filters).filters;
  if (std::ranges::all_of(filters, [](const FilterSection& each) { return each.nyquist_zeros == 0; })) return;
  constexpr double last_drawn = 0.99;
  if (points.empty() || points.front().frequency > last_drawn * nyquist(device)) return;
  std::erase_if(points, [&](const BodePoint& point) { return point.frequency > last_drawn * nyquist(device); });
}

/// That shows all of every device.
FrequencyRange shared_range(std::span<const AnalysedDevice> devices, const BodeOptions& options) {
  FrequencyRange shared{std::numeric_limits<double>::infinity(), 0.0};
  for (const AnalysedDevice& each : devices) {
    const FrequencyRange own = bode_range(each.device, each.analysis, options);
    shared = {std::min(shared.from, own.from), std::max(shared.to, own.to)};
  }
  return shared;
}

}  // namespace

BodeFigure device_bode_figure(std::span<const AnalysedDevice> devices, const BodeOptions& options) {
  BodeFigure figure;
  figure.range = shared_range(devices, options);
  const auto bode_of = [&](const AnalysedDevice& each) {
    Bode found = bode(each.device, each.analysis, {figure.range.from, figure.range.to, options.points});
    cut_at_nyquist_zero(each.device, found.sampled);
    return found;
  };
  const AnalysedDevice& first = devices.front();
  figure.motion = first.device.parameters().motion;
  if (devices.size() == 1) {
    Bode both = bode_of(first);
    figure.title = display_name(first.device);
    figure.notes = loop_notes(first.device);
    const bool is_filtered = !first.device.parameters().wall.filters.empty();
    figure.curves.push_back(
        {is_filtered ? "Through the filters, F Z[H G e^(-t_d s)]" : "What the sampled wall sees, Z[H G e^(-t_d s)]",
         std::move(both.sampled)});
    figure.curves.push_back({"The device, G(s), without sampling and delay", std::move(both.continuous)});
    if (auto note = trust_note(first.analysis.trust)) figure.notes.push_back(*std::move(note));
    add_marks(figure, first, 0, "");
  } else {
    figure.title = "What the sampled wall sees";
    for (std::size_t i = 0; i < devices.size(); ++i) {
      // Letters: names can be long and alike.
      const char letter = static_cast<char>('A' + i);
      figure.curves.push_back({fmt::format("{}: {}, sampled every {}", letter, display_name(devices[i].device),
                                           quantity(devices[i].device.loop().sampling_period, "s")),
                               bode_of(devices[i]).sampled});
      if (const auto note = trust_note(devices[i].analysis.trust)) {
        figure.notes.push_back(fmt::format("{}: {}", letter, *note));
      }
      add_marks(figure, devices[i], i, fmt::format(" ({})", letter));
    }
  }
  const auto same_nyquist = [&](const AnalysedDevice& each) { return nyquist(each.device) == nyquist(first.device); };
  if (std::all_of(devices.begin(), devices.end(), same_nyquist)) figure.nyquist = nyquist(first.device);
  // Room to see the Nyquist line apart from the frame.
  if (!options.to) figure.range.to *= 1.1;
  return figure;
}

BodeFigure diagnosis_figure(const Device& device, const Diagnosis& diagnosis) {
  Wall wall = device.parameters().wall;
  wall.damping = diagnosis.damping;
  AnalysedDevice analysed = analysed_device(device_with_wall(device, wall), limit_and_wall_only());
  analysed.analysis.trust.inherit(diagnosis.trust);
  BodeFigure figure = device_bode_figure({&analysed, 1});
  figure.observed = diagnosis.frequency;
  if (diagnosis.stiffness && *diagnosis.stiffness > 0.0) {
    figure.notes.push_back(fmt::format(
        "The wall of {} is a magnitude of {:.2f} dB: it is stiffer than the crossovers above that.",
        quantity(*diagnosis.stiffness, units_of(figure.motion).stiffness), -decibels(*diagnosis.stiffness)));
  }
  return figure;
}

}  // namespace zwidth::report

#include "report/device_bode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "report/text/explanation.hpp"
#include "report/text/quantity.hpp"
#include "report/text/wall_filter_text.hpp"
#include "results/analysis_json.hpp"
#include "results/json.hpp"

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
    notes.push_back(fmt::format("The virtual damper of {}{} is closed in the sampled response.",
                                quantity(wall.damping, units_of(device.parameters().motion).damping),
                                wall.velocity_filter_hz > 0.0
                                    ? fmt::format(" behind its {} filter", quantity(wall.velocity_filter_hz, "Hz"))
                                    : ""));
  }
  if (const auto filters = wall_filters_text(wall)) {
    notes.push_back("The sampled response is seen through the filters of the wall: " + *filters + ".");
  }
  return notes;
}

void add_marks(BodeFigure& figure, const AnalysedDevice& analysed, std::size_t curve, std::string_view suffix) {
  const CriticalStiffness& critical = analysed.analysis.critical;
  for (const Crossover& crossover : critical.crossovers) {
    const bool is_on_axis = crossover.frequency >= figure.range.from && crossover.frequency <= figure.range.to;
    if (crossover.frequency > 0.0 && !is_on_axis) continue;
    const bool limits = critical.limit && critical.limit->frequency == crossover.frequency;
    const std::string belongs_to = crossover.limited_by.kind == Mechanism::Kind::rigid_body
                                       ? "rigid body"
                                       : fmt::format("vibration mode {}", crossover.limited_by.mode);
    figure.marks.push_back({curve, crossover, limits ? BodeMark::Rank::critical : BodeMark::Rank::other,
                            fmt::format(", {}{}{}", belongs_to, limits ? ": critical" : "", suffix)});
  }
}

/// A filter with a zero at z = -1 (every low-pass) takes the curve down without end: the last of it is not drawn.
void cut_at_nyquist_zero(const Device& device, std::vector<BodePoint>& points) {
  const std::vector<FilterSection> filters = filtered_plant(device).filters;
  if (std::ranges::all_of(filters, [](const FilterSection& each) { return each.nyquist_zeros == 0; })) return;
  constexpr double last_drawn = 0.99;
  if (points.empty() || points.front().frequency > last_drawn * nyquist(device)) return;
  std::erase_if(points, [&](const BodePoint& point) { return point.frequency > last_drawn * nyquist(device); });
}

}  // namespace

FrequencyRange bode_range(std::span<const AnalysedDevice> devices, const BodeOptions& options) {
  FrequencyRange range{std::numeric_limits<double>::infinity(), 0.0};
  for (const AnalysedDevice& analysed : devices) {
    std::vector<double> events;
    for (const Crossover& crossover : analysed.analysis.critical.crossovers) {
      if (crossover.frequency > 0.0) events.push_back(crossover.frequency);
    }
    for (const Mode& mode : analysed.analysis.modes) events.push_back(mode.frequency);
    const FrequencyRange own = default_range(analysed.device.loop().sampling_period, events);
    range = {std::min(range.from, own.from), std::max(range.to, own.to)};
  }
  range.from = options.from.value_or(range.from);
  range.to = options.to.value_or(range.to);
  return range;
}

DeviceBode device_bode(const AnalysedDevice& analysed, FrequencyRange range, std::size_t points) {
  const Device& device = analysed.device;
  const double period = device.loop().sampling_period;
  ModalForm form = modal_form(device);
  std::vector<Mode> modes = form.modes;
  if (form.suspended_rigid_body) modes.push_back(*form.suspended_rigid_body);
  const Wall& wall = device.parameters().wall;
  const std::array responses{drawn_response(filtered_plant(device), {wall.damping, wall.velocity_filter_hz}),
                             drawn_response(std::move(form))};
  // The phase is unwrapped from well below everything, whatever part is asked for.
  const FrequencyRange whole{std::min(range.from, bode_range({&analysed, 1}, {}).from), range.to};
  std::vector<double> frequencies = bode_frequencies(responses, whole, modes, period, points);
  const auto start = std::lower_bound(frequencies.begin(), frequencies.end(), range.from);
  if (*start != range.from) frequencies.insert(start, range.from);
  const auto below_nyquist = std::upper_bound(frequencies.begin(), frequencies.end(), nyquist(device));
  DeviceBode bode{bode_points(responses[1], frequencies),
                  bode_points(responses[0], {frequencies.begin(), below_nyquist})};
  const auto outside = [&](const BodePoint& point) { return point.frequency < range.from; };
  std::erase_if(bode.continuous, outside);
  std::erase_if(bode.sampled, outside);
  return bode;
}

BodeFigure device_bode_figure(std::span<const AnalysedDevice> devices, const BodeOptions& options) {
  BodeFigure figure;
  figure.range = bode_range(devices, options);
  const AnalysedDevice& first = devices.front();
  figure.motion = first.device.parameters().motion;
  if (devices.size() == 1) {
    DeviceBode bode = device_bode(first, figure.range, options.points);
    cut_at_nyquist_zero(first.device, bode.sampled);
    figure.title = display_name(first.device);
    figure.notes = loop_notes(first.device);
    const bool is_filtered = !first.device.parameters().wall.filters.empty();
    figure.curves.push_back(
        {is_filtered ? "Through the filters, F Z[H G e^(-t_d s)]" : "What the sampled wall sees, Z[H G e^(-t_d s)]",
         std::move(bode.sampled)});
    figure.curves.push_back({"The device, G(s), without sampling and delay", std::move(bode.continuous)});
    add_marks(figure, first, 0, "");
  } else {
    figure.title = "What the sampled wall sees";
    for (std::size_t i = 0; i < devices.size(); ++i) {
      // Letters: names can be long and alike.
      const char letter = static_cast<char>('A' + i);
      figure.curves.push_back({fmt::format("{}: {}", letter, display_name(devices[i].device)),
                               device_bode(devices[i], figure.range, options.points).sampled});
      cut_at_nyquist_zero(devices[i].device, figure.curves.back().points);
      add_marks(figure, devices[i], i, fmt::format(" ({})", letter));
    }
  }
  const auto same_nyquist = [&](const AnalysedDevice& each) { return nyquist(each.device) == nyquist(first.device); };
  if (std::all_of(devices.begin(), devices.end(), same_nyquist)) figure.nyquist = nyquist(first.device);
  // Room to see the Nyquist line apart from the frame.
  if (!options.to) figure.range.to *= 1.1;
  return figure;
}

std::string bode_csv(const AnalysedDevice& analysed, const BodeOptions& options) {
  const DeviceBode bode = device_bode(analysed, bode_range({&analysed, 1}, options), options.points);
  std::string rows =
      "frequency_rad_s,frequency_hz,magnitude_db,phase_deg,continuous_magnitude_db,continuous_phase_deg\n";
  for (std::size_t i = 0; i < bode.continuous.size(); ++i) {
    const BodePoint& continuous = bode.continuous[i];
    const std::string sampled = i < bode.sampled.size() ? fmt::format("{:.17g},{:.17g}", bode.sampled[i].magnitude_db,
                                                                      bode.sampled[i].phase_deg)
                                                        : ",";
    rows += fmt::format("{:.17g},{:.17g},{},{:.17g},{:.17g}\n", continuous.frequency, hertz(continuous.frequency),
                        sampled, continuous.magnitude_db, continuous.phase_deg);
  }
  return rows;
}

results::Json bode_json(const AnalysedDevice& analysed, const BodeOptions& options) {
  const DeviceBode bode = device_bode(analysed, bode_range({&analysed, 1}, options), options.points);
  const auto column = [](const std::vector<BodePoint>& points, double BodePoint::*member) {
    std::vector<double> values;
    for (const BodePoint& point : points) values.push_back(point.*member);
    return values;
  };
  const auto response = [&](const std::vector<BodePoint>& points) {
    return results::Json{{"frequency_rad_s", column(points, &BodePoint::frequency)},
                         {"magnitude_db", column(points, &BodePoint::magnitude_db)},
                         {"phase_deg", column(points, &BodePoint::phase_deg)}};
  };
  return {{"schema", "zwidth.bode/1"},
          {"device", analysed.device.name()},
          {"sampling_period_s", analysed.device.loop().sampling_period},
          {"delay_s", analysed.device.loop().delay},
          {"nyquist_rad_s", nyquist(analysed.device)},
          {"sampled", response(bode.sampled)},
          {"continuous", response(bode.continuous)},
          {"crossovers", results::analysis_json(analysed.device, analysed.analysis).at("crossovers")}};
}

}  // namespace zwidth::report

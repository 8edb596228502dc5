#include "zwidth/stability/bode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <utility>

#include "counted.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/mechanism_key.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Complex = std::complex<double>;

constexpr std::size_t least_points = 2;
constexpr std::size_t most_points = 100000;

double nyquist_of(const Device& device) { return std::numbers::pi / device.loop().sampling_period; }

/// The same response; it tells now and then that the work goes on.
std::function<Complex(double)> telling(std::function<Complex(double)> value, const Progress& progress) {
  constexpr std::size_t values_per_report = 64;
  if (!progress) return value;
  return [value = std::move(value), &progress, asked = std::size_t{0}](double frequency) mutable {
    if (++asked % values_per_report == 0) tell(progress, 0.0);
    return value(frequency);
  };
}

/// What the spring sees, its damper closed. Throws where the damper runs slower than the spring: the loop that is then left open
/// has no frequency response.
DelayedResponse seen_by_spring(const Device& device) {
  const double damping = device.parameters().wall.damping;
  if (!has_damper_loop(device.loop())) return delayed_response(filtered_plant(device), virtual_damper(device));
  const TwoRateDevice loop(device, damping);
  if (!loop.is_damper_inside()) require_one_rate(device);
  return delayed_response(loop.seen_by_spring(), VirtualDamper{});
}

std::optional<OptionProblem> find_problem(const char* member, const std::optional<double>& frequency) {
  if (!frequency || (std::isfinite(*frequency) && *frequency > 0.0)) return std::nullopt;
  return option_problem(member, {.code = ProblemCode::not_finite_and_positive,
                                 .evidence = {{"value", *frequency}},
                                 .subjects = {{"in", "rad/s"}}});
}

}  // namespace

std::optional<OptionProblem> find_problem(const BodeOptions& options) {
  if (auto problem = find_problem("from", options.from)) return problem;
  if (auto problem = find_problem("to", options.to)) return problem;
  if (options.from && options.to && *options.from >= *options.to) {
    return option_problem("to", {.code = ProblemCode::not_above_lowest_frequency,
                                 .evidence = {{"value", *options.to}, {"lowest", *options.from}}});
  }
  if (options.points < least_points || options.points > most_points) {
    return option_problem("points", {.code = ProblemCode::count_out_of_range,
                                     .evidence = {counted("value", options.points), counted("least", least_points),
                                                  counted("most", most_points)}});
  }
  return std::nullopt;
}

std::optional<OptionProblem> find_problem(const BodeOptions& options, const Device& device) {
  if (auto problem = find_problem(options)) return problem;
  if (options.from && *options.from >= nyquist_of(device)) {
    return option_problem("from", {.code = ProblemCode::not_below_nyquist,
                                   .evidence = {{"value", *options.from}, {"nyquist", nyquist_of(device)}}});
  }
  return std::nullopt;
}

FrequencyRange bode_range(const Device& device, const Analysis& analysis, const BodeOptions& options) {
  const double nyquist = nyquist_of(device);
  double lowest = nyquist;
  for (const Crossover& crossover : analysis.critical.crossovers) {
    if (crossover.frequency > 0.0) lowest = std::min(lowest, crossover.frequency);
  }
  for (const Mode& mode : analysis.modes) lowest = std::min(lowest, mode.frequency);
  // Whole decades read best on a logarithmic axis.
  constexpr double decade = 10.0;
  const double from = std::pow(decade, std::floor(std::log10(std::min(lowest / 3.0, nyquist / 1000.0))));
  FrequencyRange range{options.from.value_or(from), options.to.value_or(nyquist)};
  if (range.from >= range.to) range.from = range.to / decade;
  return range;
}

Bode bode(const Device& device, const BodeOptions& options) {
  require_one_direction(device);
  StagedProgress stages(options.progress);
  stages.next(0.5);
  AnalysisOptions of_analysis = limit_and_wall_only();
  of_analysis.progress = stages.stage();
  Analysis analysis = analyze(device, of_analysis);
  stages.next(1.0);
  BodeOptions rest = options;
  rest.progress = stages.stage();
  return bode(device, std::move(analysis), rest);
}

Bode bode(const Device& device, Analysis analysis, const BodeOptions& options) {
  require_one_direction(device);
  if (const auto problem = find_problem(options, device)) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("`{}` {}; {}", problem->member, problem->what, problem->allowed));
  }
  const double lowest = bode_range(device, analysis).from;
  Bode bode{bode_range(device, analysis, options), {}, {}, std::move(analysis), nyquist_of(device)};
  ModalForm form = modal_form(device);
  std::vector<Mode> modes = form.modes;
  if (form.suspended_rigid_body) modes.push_back(*form.suspended_rigid_body);
  std::array responses{seen_by_spring(device), delayed_response(std::move(form))};
  if (has_damper_loop(device.loop()) && device.parameters().wall.damping > 0.0) {
    bode.analysis.remarks.push_back(damper_closed_at_own_rate(device));
  }
  StagedProgress stages(options.progress);
  stages.next(0.9);
  for (DelayedResponse& each : responses) each.value = telling(std::move(each.value), stages.stage());
  // The phase is unwrapped from well below everything, whatever part is asked for.
  std::vector<double> frequencies = bode_frequencies(responses, {std::min(bode.range.from, lowest), bode.range.to},
                                                     modes, device.loop().sampling_period, options.points);
  const auto start = std::ranges::lower_bound(frequencies, bode.range.from);
  const auto has_value = [&](const DelayedResponse& each) {
    const double magnitude = std::abs(each.value(bode.range.from));
    return magnitude > 0.0 && std::isfinite(magnitude);
  };
  if ((start == frequencies.end() || *start != bode.range.from) && std::ranges::all_of(responses, has_value)) {
    frequencies.insert(start, bode.range.from);
  }
  const auto above_nyquist = std::ranges::upper_bound(frequencies, nyquist_of(device));
  stages.next(1.0);
  bode.sampled = bode_points(responses[0], {frequencies.begin(), above_nyquist});
  bode.continuous = bode_points(responses[1], frequencies);
  const auto outside = [&](const BodePoint& point) { return point.frequency < bode.range.from; };
  std::erase_if(bode.continuous, outside);
  std::erase_if(bode.sampled, outside);
  stages.done();
  return bode;
}

}  // namespace zwidth

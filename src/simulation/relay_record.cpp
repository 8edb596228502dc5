#include "zwidth/simulation/relay_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "counted.hpp"
#include "require_argument.hpp"
#include "signal/averaged_spectra.hpp"
#include "signal/window_function.hpp"
#include "simulation/oscillation_cycles.hpp"
#include "simulation/straight_line.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::size_t least_samples = 64;
constexpr std::size_t least_stretch = 8;  // samples
constexpr double cycles_per_stretch = 4.0;
constexpr double least_cycles = 16.0;             // of the record: two per stretch then
constexpr double least_cycles_per_segment = 4.0;  // else its line stands in the main lobe of the window at 0 Hz
constexpr double overlap = 0.75;                  // weighs every instant alike
constexpr double threshold_of_cycles = 0.5;       // of the largest excursion
constexpr double least_share = 0.2;               // of the position's power in the peak, for an oscillation
constexpr double noticeable_drift = 0.2;          // of the amplitude, over the steady part
constexpr std::size_t least_encoder_steps = 10;
constexpr double scatters_allowed = 3.0;  // of the swing about its mean, in a steady part

[[noreturn]] void refuse(const Problem& problem) { throw Error(ErrorCode::invalid_argument, problem); }

void check(std::span<const double> force, std::span<const double> position, double sampling_period,
           const RelayAnalysisOptions& options) {
  if (force.size() != position.size()) {
    refuse({.code = ProblemCode::force_and_motion_of_two_lengths,
            .evidence = {counted("force", force.size()), counted("motion", position.size())}});
  }
  const auto is_finite = [](double value) { return std::isfinite(value); };
  for (const auto& [channel, samples] : {std::pair{"force", force}, std::pair{"position", position}}) {
    if (std::all_of(samples.begin(), samples.end(), is_finite)) continue;
    refuse({.code = ProblemCode::not_finite, .subjects = {{"name", std::string("a sample of ") + channel}}});
  }
  require_positive({"sampling period", sampling_period, "s"});
  if (const auto problem = find_problem(options)) {
    throw Error(ErrorCode::invalid_argument,
                fmt::format("{} {}; {}", problem->member, problem->what, problem->allowed));
  }
}

bool is_constant(std::span<const double> signal) {
  return std::all_of(signal.begin(), signal.end(), [&](double value) { return value == signal.front(); });
}

/// The strongest line of two signals.
struct Peak {
  std::size_t line = 0;
  std::size_t segment_length = 0;
  std::size_t segments = 0;
  double stiffness = 0.0;
  double share = 0.0;  ///< of the position's power, in the window's main lobe about the line
  [[nodiscard]] double per_sample() const { return static_cast<double>(line) / static_cast<double>(segment_length); }
};

Peak strongest_line(std::span<const double> force, std::span<const double> position, std::size_t segment_length) {
  const std::vector<double> f = without_line(force);
  const std::vector<double> x = without_line(position);
  const Segments segments = segments_of(f.size(), std::min(segment_length, f.size()), Window::hann, overlap);
  const AveragedSpectra spectra = averaged_spectra(f, x, segments, SignalForm::as_recorded);
  double force_power = 0.0;
  double position_power = 0.0;
  for (std::size_t k = 0; k < spectra.ff.size(); ++k) {
    force_power += spectra.ff[k];
    position_power += spectra.xx[k];
  }
  Peak peak{0, segments.length, segments.count, 0.0, 0.0};
  double highest = 0.0;
  const std::size_t lobe = main_lobe_half_width(Window::hann);
  for (std::size_t k = lobe; k < spectra.ff.size(); ++k) {
    const double height = spectra.ff[k] / force_power + spectra.xx[k] / position_power;
    if (height <= highest) continue;
    highest = height;
    peak.line = k;
  }
  if (peak.line == 0) return peak;
  peak.stiffness =
      spectra.ff[peak.line] * spectra.output_scale / std::hypot(spectra.fx_real[peak.line], spectra.fx_imag[peak.line]);
  const std::size_t last = std::min(peak.line + lobe, spectra.xx.size() - 1);
  for (std::size_t k = peak.line - lobe; k <= last; ++k) peak.share += spectra.xx[k] / position_power;
  return peak;
}

/// What makes a record hopeless before any spectrum; nothing where it is not.
std::optional<Finding> nothing_moves(std::span<const double> force, std::span<const double> position,
                                     double sampling_period) {
  if (force.size() < least_samples) {
    return Finding{.code = FindingCode::record_too_short,
                   .evidence = {counted("samples", force.size()), counted("threshold", least_samples)}};
  }
  if (is_constant(force)) return Finding{.code = FindingCode::force_never_changes};
  if (is_constant(position)) return Finding{.code = FindingCode::position_never_changes};
  const std::size_t half = force.size() / 2;
  const double since = static_cast<double>(half) * sampling_period;
  const std::vector<Evidence> evidence{{"since", since}};
  if (is_constant(force.subspan(half))) {
    return Finding{.code = FindingCode::force_stops_changing, .evidence = evidence};
  }
  if (is_constant(position.subspan(half))) {
    return Finding{.code = FindingCode::position_stops_changing, .evidence = evidence};
  }
  return std::nullopt;
}

/// The end of a record in which an oscillation no longer changes its swing.
struct SteadyPart {
  std::size_t from = 0;  ///< first sample
  /// Relative standard deviation of the swing over the stretches of the last half.
  double scatter = 0.0;
  /// Relative change of the swing over the last half, by a straight line through its stretches.
  double trend = 0.0;
};

double swing(std::span<const double> position) {
  double sum = 0.0;
  for (const double each : without_line(position)) sum += each * each;
  return std::sqrt(sum / static_cast<double>(position.size()));
}

/// Swing: rms about a straight line over each stretch, counted from the record's end. Steady from the first stretch
/// after which every swing is within max(tolerance, 3 scatter) of the last half's mean. At most the first half is left
/// out. Requires a stretch of at least 4 samples that fits four times into half the record.
SteadyPart steady_part(std::span<const double> position, std::size_t stretch, double tolerance) {
  const std::size_t count = position.size() / stretch;
  const std::size_t start = position.size() - count * stretch;
  std::vector<double> swings;
  for (std::size_t i = 0; i < count; ++i) swings.push_back(swing(position.subspan(start + i * stretch, stretch)));

  const std::size_t in_last_half = count / 2;
  const std::span<const double> last_half = std::span(swings).last(in_last_half);
  const StraightLine line = straight_line(last_half);
  const double mean = line.middle;
  double variance = 0.0;
  for (const double each : without_line(last_half)) variance += each * each / static_cast<double>(in_last_half - 1);
  SteadyPart part;
  part.scatter = std::sqrt(variance) / mean;
  part.trend = line.slope * static_cast<double>(in_last_half - 1) / mean;

  const double allowed = std::max(tolerance, scatters_allowed * part.scatter) * mean;
  std::size_t first = count - in_last_half;
  while (first > 0 && std::abs(swings[first - 1] - mean) <= allowed) --first;
  part.from = first == 0 ? 0 : start + first * stretch;
  return part;
}

void remark_steadiness(RelayReading& result, const SteadyPart& part, const RelayAnalysisOptions& options) {
  if (std::abs(part.trend) > std::max(options.steady_tolerance, 2.0 * part.scatter)) {
    result.remarks.push_back(warning({.code = FindingCode::swing_not_steady,
                                      .evidence = {{"trend", part.trend}, {"share", std::abs(part.trend)}},
                                      .subjects = {{"does", part.trend > 0.0 ? "grows" : "falls"}}}));
  } else if (part.scatter > options.steady_tolerance) {
    result.remarks.push_back(
        warning({.code = FindingCode::swing_varies,
                 .evidence = {{"scatter", part.scatter}, {"threshold", options.steady_tolerance}}}));
  }
}

void remark_signals(RelayReading& result, std::span<const double> position, const RelayAnalysisOptions& options) {
  if (result.steady_samples < options.segment_length) {
    result.remarks.push_back(
        warning({.code = FindingCode::steady_part_short,
                 .evidence = {{"samples", static_cast<double>(result.steady_samples)},
                              {"segment", static_cast<double>(options.segment_length)},
                              {"resolution_hz", result.line_spacing / (2.0 * std::numbers::pi)}}}));
  }
  const StraightLine line = straight_line(position);
  const double drift = std::abs(line.slope) * static_cast<double>(position.size());
  if (drift > noticeable_drift * result.amplitude) {
    result.remarks.push_back(
        warning({.code = FindingCode::position_drifts,
                 .evidence = {{"share", drift / result.amplitude}, {"threshold", noticeable_drift}}}));
  }
  if (std::set<double>(position.begin(), position.end()).size() < least_encoder_steps) {
    result.remarks.push_back(warning({.code = FindingCode::few_encoder_steps,
                                      .evidence = {{"threshold", static_cast<double>(least_encoder_steps)}}}));
  }
}

}  // namespace

std::optional<OptionProblem> find_problem(const RelayAnalysisOptions& options) {
  if (options.segment_length < least_samples) {
    return option_problem("segment_length",
                          {.code = ProblemCode::too_few,
                           .evidence = {counted("value", options.segment_length), counted("least", least_samples)},
                           .subjects = {{"unit", "samples"}}});
  }
  if (!(options.steady_tolerance > 0.0 && options.steady_tolerance < 1.0)) {
    return option_problem("steady_tolerance",
                          {.code = ProblemCode::no_fraction, .evidence = {{"value", options.steady_tolerance}}});
  }
  return std::nullopt;
}

tl::expected<RelayReading, NoOscillation> analyse_relay_record(std::span<const double> force,
                                                               std::span<const double> position, double sampling_period,
                                                               const RelayAnalysisOptions& options) {
  check(force, position, sampling_period, options);
  if (auto why = nothing_moves(force, position, sampling_period)) {
    return tl::unexpected(NoOscillation{*std::move(why)});
  }
  const std::size_t half = force.size() / 2;
  // As one segment: a period may be longer than one of the segments asked for.
  const Peak rough = strongest_line(force.subspan(half), position.subspan(half), force.size() - half);
  const double cycles_recorded = rough.per_sample() * static_cast<double>(force.size());
  if (!(cycles_recorded >= least_cycles)) {
    return tl::unexpected(NoOscillation{
        {.code = FindingCode::too_few_cycles, .evidence = {{"cycles", cycles_recorded}, {"threshold", least_cycles}}}});
  }
  const double cycles_per_segment = rough.per_sample() * static_cast<double>(options.segment_length);
  if (!(cycles_per_segment >= least_cycles_per_segment)) {
    return tl::unexpected(NoOscillation{{.code = FindingCode::too_few_cycles_in_segment,
                                         .evidence = {counted("segment", options.segment_length),
                                                      {"cycles", cycles_per_segment},
                                                      {"frequency_hz", rough.per_sample() / sampling_period},
                                                      {"threshold", least_cycles_per_segment}}}});
  }
  // Four stretches at least in the last half.
  const auto stretch = std::min(
      force.size() / 8, std::max(least_stretch, static_cast<std::size_t>(cycles_per_stretch / rough.per_sample())));
  const SteadyPart part = steady_part(position, stretch, options.steady_tolerance);
  const auto steady_force = force.subspan(part.from);
  const auto steady_position = position.subspan(part.from);
  const Peak peak = strongest_line(steady_force, steady_position, options.segment_length);
  if (peak.line == 0 || peak.share < least_share) {
    return tl::unexpected(NoOscillation{{.code = FindingCode::no_frequency_stands_out,
                                         .evidence = {{"share", peak.share}, {"threshold", least_share}}}});
  }

  RelayReading result;
  const double angle = 2.0 * std::numbers::pi / sampling_period;  // rad/s of one cycle per sample
  result.frequency = angle * peak.per_sample();
  result.stiffness = peak.stiffness;
  result.line_spacing = angle / static_cast<double>(peak.segment_length);
  result.segments = peak.segments;
  result.steady_from = part.from;
  result.steady_samples = steady_position.size();
  result.scatter = part.scatter;
  const std::vector<double> motion = without_line(steady_position);
  const auto [lowest, highest] = std::minmax_element(motion.begin(), motion.end());
  const OscillationCycles cycles = oscillation_cycles(motion, threshold_of_cycles * 0.5 * (*highest - *lowest));
  result.amplitude = cycles.count > 0 ? cycles.mean_swing : 0.5 * (*highest - *lowest);
  if (cycles.count > 0) {
    const double frequency = angle / cycles.mean_length;
    if (std::abs(frequency - result.frequency) <= result.line_spacing) result.cycle_frequency = frequency;
  }
  remark_steadiness(result, part, options);
  remark_signals(result, steady_position, options);
  return result;
}

}  // namespace zwidth

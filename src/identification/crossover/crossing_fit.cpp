#include "identification/crossover/crossing_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "identification/crossover/stiffness_curve.hpp"
#include "identification/crossover/student_t.hpp"

namespace zwidth::internal {
namespace {

/// A step nearer than this to half a turn may have gone either way round.
constexpr double ambiguity = std::numbers::pi / 6.0;

/// A fall of the phase between neighbouring lines that hides a resonance's peak; where |P| changes twofold too, less is
/// enough.
constexpr double sparse_step = std::numbers::pi / 4.0;
constexpr double sparse_step_on_flank = std::numbers::pi / 12.0;
const double flank = std::log(2.0);
constexpr double unsure_per_log_magnitude = 0.125;
/// What a straight line in 1/P may then be off, relative: as simulated on modes with damping ratios of 0.002 to 0.05.
constexpr double unsure_per_half_turn = 0.5;

double turned(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

/// Where between two lines, as a share of the way, a value passes 0.
double zero_between(double before, double after) { return std::clamp(before / (before - after), 0.0, 1.0); }

double between(double a, double b, double share) { return a + share * (b - a); }

/// How far a straight line between samples 1 and 2 may be off, by the curvature that samples 0 and 3 show.
double sag(double y0, double y1, double y2, double y3) { return std::abs(y0 - y1 - y2 + y3) / 16.0; }

/// By an independent error to either side.
void widen(Interval& interval, double value, double error) {
  interval.lower = value - std::hypot(value - interval.lower, error);
  interval.upper = value + std::hypot(interval.upper - value, error);
}

class Crossing {
 public:
  Crossing(std::span<const PhaseLine> lines, std::span<const PhaseVerdict> verdicts, const PhaseRun& below,
           const PhaseRun& above, MeetingLines meeting, double line_correlation)
      : lines_(lines), verdicts_(verdicts), below_(below), above_(above), meeting_(meeting) {
    first_open_ = meeting.after;
    while (first_open_ > below.first && verdicts[first_open_ - 1].sign != below.sign) --first_open_;
    end_open_ = meeting.after;
    while (end_open_ <= above.last && verdicts[end_open_].sign != above.sign) ++end_open_;
    fit_curve(line_correlation);
    find_sags();
  }

  [[nodiscard]] FittedCrossing fitted() const {
    FittedCrossing result;
    MeasuredCrossover& crossover = result.crossover;
    result.first_open = first_open_;
    result.end_open = end_open_;
    crossover.poles_leaving = below_.sign > 0 ? 2 : -2;
    const std::optional<Point> sparse = between_sparse_lines();
    if (const auto crossing = sparse ? std::nullopt : by_curve()) {
      crossover = *crossing;
      return result;
    }
    const auto [frequency, log_magnitude] = sparse ? *sparse : passes_once() ? interpolated() : smoothed();
    crossover.frequency = frequency;
    crossover.stiffness = std::exp(-log_magnitude);
    crossover.frequency_interval = {std::min(lower_end(), frequency), std::max(upper_end(), frequency)};
    if (sparse) {
      result.sparse_lines = {lines_[meeting_.before].frequency, lines_[meeting_.after].frequency};
      crossover.frequency_interval.lower = std::min(crossover.frequency_interval.lower, result.sparse_lines->lower);
      crossover.frequency_interval.upper = std::max(crossover.frequency_interval.upper, result.sparse_lines->upper);
    }
    crossover.stiffness_interval = stiffness_interval(crossover);
    if (sparse) {
      const double unsure = std::max(unsure_per_half_turn * std::abs(step()) / std::numbers::pi,
                                     std::min(unsure_per_half_turn, unsure_per_log_magnitude * std::abs(log_step())));
      Interval& interval = crossover.stiffness_interval;
      interval.lower = std::min(interval.lower, crossover.stiffness * (1.0 - unsure));
      interval.upper = std::max(interval.upper, crossover.stiffness * (1.0 + unsure));
    }
    return result;
  }

 private:
  struct Point {
    double frequency = 0.0;
    double log_magnitude = 0.0;
  };

  /// The line whose phase is the most standard deviations from -180 degrees.
  [[nodiscard]] std::size_t surest_line(std::size_t first, std::size_t last) const {
    std::size_t surest = first;
    double most = 0.0;
    for (std::size_t i = first; i <= last; ++i) {
      const Estimate& deviation = verdicts_[i].deviation;
      if (!lines_[i].measured || std::abs(deviation.value) <= most * deviation.sigma) continue;
      most = std::abs(deviation.value) / deviation.sigma;
      surest = i;
    }
    return surest;
  }

  /// By one curve through the lines around; what bends between two of them may be off besides.
  [[nodiscard]] std::optional<MeasuredCrossover> by_curve() const {
    const PhaseLine& before = lines_[meeting_.before];
    const PhaseLine& after = lines_[meeting_.after];
    if (!curve_) return std::nullopt;
    auto crossing = crossing_of(*curve_, 0.5 * (before.frequency + after.frequency), below_.sign);
    if (!crossing || step() == 0.0) return crossing;
    const double lines_off = phase_sag_ / std::abs(step());
    widen(crossing->frequency_interval, crossing->frequency, lines_off * (after.frequency - before.frequency));
    widen(crossing->stiffness_interval, crossing->stiffness,
          crossing->stiffness * std::hypot(magnitude_sag_, lines_off * log_step()));
    return crossing;
  }

  void fit_curve(double line_correlation) {
    const bool is_before = std::abs(lines_[meeting_.before].deviation) < std::abs(lines_[meeting_.after].deviation);
    const std::size_t centre = is_before ? meeting_.before : meeting_.after;
    curve_ = stiffness_curve(lines_, centre, below_.first, above_.last, line_correlation);
  }

  /// Curvature of phase and ln |P| over the four lines around the meeting, where there are four.
  void find_sags() {
    const std::size_t before = meeting_.before;
    const std::size_t after = meeting_.after;
    if (after != before + 1 || before == 0 || after + 1 >= lines_.size()) return;
    for (std::size_t i = before - 1; i <= after + 1; ++i) {
      if (!lines_[i].measured) return;
    }
    const auto magnitude = [&](std::size_t i) { return std::log(std::abs(lines_[i].value)); };
    const double middle = lines_[before].deviation;
    const auto phase = [&](std::size_t i) { return turned(lines_[i].deviation - middle); };
    phase_sag_ = sag(phase(before - 1), phase(before), phase(after), phase(after + 1));
    magnitude_sag_ = sag(magnitude(before - 1), magnitude(before), magnitude(after), magnitude(after + 1));
  }

  /// The signs of single lines change once in all that may hold the crossing.
  [[nodiscard]] bool passes_once() const {
    std::size_t changes = 0;
    double last = below_.sign;
    for (std::size_t i = first_open_; i < end_open_; ++i) {
      if (!lines_[i].measured) continue;
      if ((lines_[i].deviation > 0.0) != (last > 0.0)) ++changes;
      last = lines_[i].deviation;
    }
    if ((last > 0.0) != (above_.sign > 0)) ++changes;
    return changes <= 1;
  }

  /// Of the phase, between the two lines that meet.
  [[nodiscard]] double step() const {
    return turned(lines_[meeting_.after].deviation - lines_[meeting_.before].deviation);
  }

  /// Of ln |P|.
  [[nodiscard]] double log_step() const {
    return std::log(std::abs(lines_[meeting_.after].value) / std::abs(lines_[meeting_.before].value));
  }

  /// Across a resonance between two lines, by a straight line in 1/P; absent where they are not that far apart.
  [[nodiscard]] std::optional<Point> between_sparse_lines() const {
    const PhaseLine& before = lines_[meeting_.before];
    const PhaseLine& after = lines_[meeting_.after];
    if (step() > (std::abs(log_step()) > flank ? -sparse_step_on_flank : -sparse_step)) return std::nullopt;
    if (!before.measured || !after.measured) return std::nullopt;
    const std::complex<double> one = 1.0 / before.value;
    const std::complex<double> other = 1.0 / after.value;
    const double share = zero_between(one.imag(), other.imag());
    const double stiffness = -between(one.real(), other.real(), share);
    if (!(stiffness > 0.0)) return std::nullopt;
    return Point{between(before.frequency, after.frequency, share), -std::log(stiffness)};
  }

  [[nodiscard]] Point interpolated() const {
    const PhaseLine& before = lines_[meeting_.before];
    const PhaseLine& after = lines_[meeting_.after];
    const double end = before.deviation + step();
    const double share = zero_between(before.deviation, end);
    return {between(before.frequency, after.frequency, share),
            between(std::log(std::abs(before.value)), std::log(std::abs(after.value)), share)};
  }

  /// Where the smoothed phase passes, nearest to where the runs meet.
  [[nodiscard]] Point smoothed() const {
    Point best{lines_[meeting_.before].frequency, verdicts_[meeting_.before].log_magnitude.value};
    double nearest = std::numeric_limits<double>::infinity();
    const double middle = 0.5 * (lines_[meeting_.before].frequency + lines_[meeting_.after].frequency);
    const std::size_t first = first_open_ > 0 ? first_open_ - 1 : 0;
    for (std::size_t i = first, next = first; i < end_open_; i = next) {
      next = i + 1;
      while (next < lines_.size() && !lines_[next].measured) ++next;
      if (next >= lines_.size() || !lines_[i].measured) continue;
      const double one = verdicts_[i].deviation.value;
      const double other = verdicts_[next].deviation.value;
      if ((one > 0.0) != (below_.sign > 0) || (other > 0.0) != (above_.sign > 0)) continue;
      const double share = zero_between(one, other);
      const double at = between(lines_[i].frequency, lines_[next].frequency, share);
      if (std::abs(at - middle) >= nearest) continue;
      nearest = std::abs(at - middle);
      best = {at, between(verdicts_[i].log_magnitude.value, verdicts_[next].log_magnitude.value, share)};
    }
    return best;
  }

  /// The bound of a phase towards -180 degrees and beyond, with the sign of its run: positive where proven.
  [[nodiscard]] double bound(const Estimate& deviation, int sign) const {
    return sign * deviation.value - two_sided_95 * deviation.sigma - phase_sag_;
  }

  /// Where no single curve tells: the outermost open line between the crossing and the surest line ends the interval.
  [[nodiscard]] double lower_end() const {
    std::size_t open = first_open_;
    for (std::size_t i = surest_line(below_.first, meeting_.before); i < open; ++i) {
      if (is_open(i, below_)) open = i;
    }
    while (open > below_.first && verdicts_[open - 1].sign != below_.sign) --open;
    if (open == below_.first) return lines_[open].frequency;
    const std::size_t proven = open - 1;
    if (!lines_[open].measured) return lines_[proven].frequency;
    return between(
        lines_[proven].frequency, lines_[open].frequency,
        zero_between(bound(verdicts_[proven].deviation, below_.sign), bound(verdicts_[open].deviation, below_.sign)));
  }

  [[nodiscard]] double upper_end() const {
    std::size_t end_open = end_open_;
    for (std::size_t i = surest_line(meeting_.after, above_.last); i >= end_open; --i) {
      if (is_open(i, above_)) end_open = i + 1;
    }
    while (end_open <= above_.last && verdicts_[end_open].sign != above_.sign) ++end_open;
    if (end_open > above_.last) return lines_[above_.last].frequency;
    const std::size_t last = end_open - 1;
    if (!lines_[last].measured) return lines_[end_open].frequency;
    return between(
        lines_[end_open].frequency, lines_[last].frequency,
        zero_between(bound(verdicts_[end_open].deviation, above_.sign), bound(verdicts_[last].deviation, above_.sign)));
  }

  [[nodiscard]] bool is_open(std::size_t line, const PhaseRun& run) const {
    return lines_[line].measured && verdicts_[line].sign != run.sign;
  }

  /// ln |P|, smoothed, between the lines.
  [[nodiscard]] Estimate log_magnitude_at(double frequency) const {
    const auto usable = [&](std::size_t i) { return lines_[i].measured; };
    std::size_t above = meeting_.after;
    while (above > 0 && lines_[above - 1].frequency >= frequency) --above;
    while (above < lines_.size() && (lines_[above].frequency < frequency || !usable(above))) ++above;
    if (above == lines_.size()) return verdicts_[meeting_.after].log_magnitude;
    if (above == 0) return verdicts_[0].log_magnitude;
    std::size_t below = above - 1;
    while (below > 0 && !usable(below)) --below;
    const double share = (frequency - lines_[below].frequency) / (lines_[above].frequency - lines_[below].frequency);
    const Estimate& one = verdicts_[below].log_magnitude;
    const Estimate& other = verdicts_[above].log_magnitude;
    return {between(one.value, other.value, share), std::max(one.sigma, other.sigma)};
  }

  /// The magnitude's own error, and what the crossing's place makes of its slope, are independent.
  [[nodiscard]] Interval stiffness_interval(const MeasuredCrossover& crossover) const {
    const Estimate here = log_magnitude_at(crossover.frequency);
    double largest = here.value;
    double least = here.value;
    const auto include = [&](double log_magnitude) {
      largest = std::max(largest, log_magnitude);
      least = std::min(least, log_magnitude);
    };
    include(log_magnitude_at(crossover.frequency_interval.lower).value);
    include(log_magnitude_at(crossover.frequency_interval.upper).value);
    for (std::size_t i = below_.first; i <= above_.last; ++i) {
      const bool is_within = lines_[i].frequency >= crossover.frequency_interval.lower &&
                             lines_[i].frequency <= crossover.frequency_interval.upper;
      if (is_within && lines_[i].measured) include(verdicts_[i].log_magnitude.value);
    }
    const double own = two_sided_95 * here.sigma + magnitude_sag_;
    return {std::min(crossover.stiffness, std::exp(-here.value - std::hypot(own, largest - here.value))),
            std::max(crossover.stiffness, std::exp(-here.value + std::hypot(own, here.value - least)))};
  }

  std::span<const PhaseLine> lines_;
  std::span<const PhaseVerdict> verdicts_;
  PhaseRun below_;
  PhaseRun above_;
  MeetingLines meeting_;
  std::size_t first_open_ = 0;
  std::size_t end_open_ = 0;
  std::optional<StiffnessCurve> curve_;
  double phase_sag_ = 0.0;
  double magnitude_sag_ = 0.0;
};

}  // namespace

MeetingLines meeting_lines(std::span<const PhaseLine> lines, const PhaseRun& below, const PhaseRun& above) {
  MeetingLines meeting{below.last, above.first};
  while (meeting.before > below.first && !lines[meeting.before].measured) --meeting.before;
  while (meeting.after < above.last && !lines[meeting.after].measured) ++meeting.after;
  return meeting;
}

bool is_ambiguous_step(const PhaseLine& before, const PhaseLine& after) {
  return std::abs(turned(after.deviation - before.deviation)) > std::numbers::pi - ambiguity;
}

std::optional<FittedCrossing> fitted_crossing(std::span<const PhaseLine> lines, std::span<const PhaseVerdict> verdicts,
                                              const PhaseRun& below, const PhaseRun& above, double line_correlation) {
  const MeetingLines meeting = meeting_lines(lines, below, above);
  const PhaseLine& before = lines[meeting.before];
  const PhaseLine& after = lines[meeting.after];
  const double end = before.deviation + turned(after.deviation - before.deviation);
  if (is_ambiguous_step(before, after) || (end > 0.0) == (before.deviation > 0.0)) return std::nullopt;
  return Crossing(lines, verdicts, below, above, meeting, line_correlation).fitted();
}

}  // namespace zwidth::internal

#include "zwidth/identification/measured_stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "counted.hpp"
#include "identification/crossover/band_beginning.hpp"
#include "identification/crossover/crossing_fit.hpp"
#include "identification/crossover/phase_lines.hpp"
#include "identification/crossover/phase_runs.hpp"
#include "identification/crossover/phase_verdict.hpp"
#include "zwidth/error.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth {
using namespace internal;
namespace {

std::string band_text(const Interval& band) {
  return band.lower == band.upper ? fmt::format("at {:.4g} Hz", hertz(band.lower))
                                  : fmt::format("from {:.4g} to {:.4g} Hz", hertz(band.lower), hertz(band.upper));
}

/// Of one line: "at"; else "from" and "to". In Hz.
std::vector<Evidence> band_evidence(const Interval& band) {
  if (band.lower == band.upper) return {{"at", hertz(band.lower)}};
  return {{"from", hertz(band.lower)}, {"to", hertz(band.upper)}};
}

/// The first few bands in words, how many more there are and how far they reach.
void name_bands(const std::vector<Interval>& bands, Finding& finding) {
  constexpr std::size_t most = 3;
  std::string text;
  double highest = 0.0;
  for (std::size_t i = 0; i < bands.size(); ++i) {
    highest = std::max(highest, bands[i].upper);
    if (i < most) text += (i == 0 ? "" : ", ") + band_text(bands[i]);
  }
  finding.subjects.push_back({"where", std::move(text)});
  if (bands.size() <= most) return;
  finding.evidence.push_back(counted("more", bands.size() - most));
  finding.evidence.push_back({"up_to", hertz(highest), "Hz"});
}

/// A phase farther above 0 than this is no sensor's or noise's lead: it has come from below.
constexpr double most_lead = std::numbers::pi / 6.0;
/// Lines at an end of the band that count as outside it rather than as a doubt within.
constexpr std::size_t most_ragged_lines = 3;

/// How many lines to give up from an end on: those that are not measured, and few measured ones between them.
template <typename Iterator>
std::ptrdiff_t ragged_lines(Iterator begin, Iterator end) {
  std::ptrdiff_t given_up = 0;
  std::size_t measured_ones = 0;
  for (Iterator line = begin; line != end && measured_ones <= most_ragged_lines; ++line) {
    measured_ones = line->measured ? measured_ones + 1 : 0;
    if (!line->measured) given_up = line + 1 - begin;
  }
  return given_up;
}

std::size_t ragged_start(const std::vector<PhaseLine>& lines) {
  return static_cast<std::size_t>(ragged_lines(lines.begin(), lines.end()));
}

std::vector<PhaseLine> without_ragged_ends(const std::vector<PhaseLine>& lines) {
  const auto first = lines.begin() + static_cast<std::ptrdiff_t>(ragged_start(lines));
  const auto last = lines.end() - ragged_lines(lines.rbegin(), lines.rend());
  return first < last ? std::vector<PhaseLine>(first, last) : std::vector<PhaseLine>{};
}

/// The least stiffness that a crossing among these lines could have: they may be larger than measured, by 95 %.
double least_stiffness(std::span<const PhaseLine> lines) {
  const double radius_per_sigma = std::sqrt(-2.0 * std::log(0.05));
  double largest = 0.0;
  for (const PhaseLine& line : lines) {
    largest = std::max(largest, std::abs(line.value) + radius_per_sigma * line.sigma);
  }
  return 1.0 / largest;
}

/// A stretch of the band that may hide crossings.
struct Doubt {
  Interval band;
  double least_stiffness = 0.0;
};

Doubt doubt_over(std::span<const PhaseLine> lines, std::size_t first, std::size_t last) {
  return {{lines[first].frequency, lines[last].frequency}, least_stiffness(lines.subspan(first, last - first + 1))};
}

/// A crossing near which several lines are open may be near the positive real axis: nothing crosses there.
bool may_cross(std::span<const PhaseLine> stretch) {
  return std::any_of(stretch.begin(), stretch.end(),
                     [](const PhaseLine& line) { return !line.measured || line.value.real() < 0.0; });
}

/// What the lines prove about crossings below the Nyquist frequency.
struct Findings {
  std::vector<PhaseRun> runs;
  std::vector<MeasuredCrossover> crossovers;
  std::vector<Doubt> doubts;
  std::vector<Interval> sparse_lines;  ///< see FittedCrossing
  Interval band;                       ///< in which the phase is known up to crossovers and doubts
  /// Where the imaginary part is positive at first, the phase is past -180 degrees, and not a little above 0: a device
  /// on a spring starts from 0, on either side by the noise.
  bool starts_past_half_turn = false;
};

/// Lines that are open, or contradict their run, and that no crossing accounts for: each stretch is a doubt.
void add_open_stretches(Findings& findings, std::span<const PhaseLine> lines, std::span<const PhaseVerdict> verdicts,
                        const std::vector<bool>& accounted) {
  std::vector<bool> open(lines.size(), false);
  for (const PhaseRun& run : findings.runs) {
    for (std::size_t i = run.first; i <= run.last; ++i) open[i] = verdicts[i].sign != run.sign && !accounted[i];
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!open[i]) continue;
    const std::size_t first = i;
    while (i + 1 < lines.size() && open[i + 1]) ++i;
    const std::size_t count = i - first + 1;
    const bool is_at_start = first == 0 && i + 1 < lines.size();
    const bool is_at_end = i + 1 == lines.size() && first > 0;
    if (is_at_start && count <= most_ragged_lines) {
      findings.band.lower = lines[i + 1].frequency;
    } else if (is_at_end && count <= most_ragged_lines) {
      findings.band.upper = lines[first - 1].frequency;
    } else if (may_cross(lines.subspan(first, count))) {
      findings.doubts.push_back(doubt_over(lines, first, i));
    }
  }
}

Findings find_crossings(std::span<const PhaseLine> lines, std::span<const PhaseVerdict> verdicts,
                        std::vector<PhaseRun> runs, double line_correlation) {
  Findings findings;
  findings.runs = std::move(runs);
  findings.band = {lines.front().frequency, lines.back().frequency};
  const auto settled =
      std::find_if(verdicts.begin(), verdicts.end(), [](const PhaseVerdict& v) { return v.sign != 0; });
  if (settled != verdicts.end()) {
    const PhaseLine& line = lines[static_cast<std::size_t>(settled - verdicts.begin())];
    findings.starts_past_half_turn = std::arg(line.value) > most_lead;
  }
  std::vector<bool> accounted(lines.size(), false);
  for (std::size_t i = 1; i < findings.runs.size(); ++i) {
    const PhaseRun& below = findings.runs[i - 1];
    const PhaseRun& above = findings.runs[i];
    const MeetingLines meeting = meeting_lines(lines, below, above);
    if (const auto crossing = fitted_crossing(lines, verdicts, below, above, line_correlation)) {
      findings.crossovers.push_back(crossing->crossover);
      if (crossing->sparse_lines) findings.sparse_lines.push_back(*crossing->sparse_lines);
      for (std::size_t j = crossing->first_open; j < crossing->end_open; ++j) accounted[j] = true;
    } else if (is_ambiguous_step(lines[meeting.before], lines[meeting.after])) {
      findings.doubts.push_back(doubt_over(lines, meeting.before, meeting.after));
    }
  }
  add_open_stretches(findings, lines, verdicts, accounted);
  return findings;
}

/// The response is real at the Nyquist frequency: a negative value is a crossing, by a single pole.
std::optional<MeasuredCrossover> nyquist_crossing(const FrequencyResponse& response,
                                                  const std::vector<PhaseRun>& runs) {
  const auto point = nyquist_point(response);
  if (!point || runs.empty()) return std::nullopt;
  const double radius = confidence_radius(*point, response.averages);
  const double magnitude = -point->value.real();
  if (!(magnitude > radius)) return std::nullopt;
  return MeasuredCrossover{point->frequency,
                           1.0 / magnitude,
                           {point->frequency, point->frequency},
                           {1.0 / (magnitude + radius), 1.0 / (magnitude - radius)},
                           runs.back().sign > 0 ? 1 : -1};
}

const MeasuredCrossover* softest(const std::vector<MeasuredCrossover>& crossovers) {
  const auto least = std::min_element(crossovers.begin(), crossovers.end(),
                                      [](const auto& a, const auto& b) { return a.stiffness < b.stiffness; });
  return least == crossovers.end() ? nullptr : &*least;
}

void warn(MeasuredStiffness& result, Finding finding) { result.remarks.push_back(warning(std::move(finding))); }

/// The phase is below -180 degrees where the band begins, or the softest crossing is one by which poles return.
/// Not so where the lines at the beginning contradict their run, or leave it open: that is a doubt.
bool begins_unstable(const MeasuredStiffness& result, const Findings& findings) {
  const bool doubtful_start = std::any_of(findings.doubts.begin(), findings.doubts.end(),
                                          [&](const Doubt& doubt) { return doubt.band.lower <= findings.band.lower; });
  if (doubtful_start) return false;
  if (findings.runs.front().sign < 0 && findings.starts_past_half_turn) return true;
  const MeasuredCrossover* least = softest(result.crossovers);
  return least && least->poles_leaving < 0;
}

/// The lines from the first on whose phase cannot be told from -180 degrees each by itself. What lies where the band
/// begins is where a limiting crossing hides most easily: there no line is believed for its neighbours' sake.
std::optional<Doubt> doubtful_start(std::span<const PhaseLine> lines) {
  const double radius_per_sigma = std::sqrt(-2.0 * std::log(0.05));
  std::size_t open = 0;
  while (open < lines.size()) {
    const PhaseLine& line = lines[open];
    const double distance = std::abs(line.value) * std::sin(std::min(std::abs(line.deviation), std::numbers::pi / 2.0));
    if (line.measured && distance > radius_per_sigma * line.sigma) break;
    ++open;
  }
  if (open == 0) return std::nullopt;
  return doubt_over(lines, 0, std::min(open, lines.size() - 1));
}

/// Lines too noisy each by itself, together: the phase among them is nearer to 0 than to 180 degrees, with 95 %.
bool leads_towards_zero(std::span<const PhaseLine> lines) {
  constexpr double one_sided_95 = 1.645;
  double sum = 0.0;
  double count = 0.0;
  for (const PhaseLine& line : lines) {
    if (!(line.sigma > 0.0) || !std::isfinite(line.sigma)) continue;
    sum += line.value.real() / line.sigma;
    count += 1.0;
  }
  return count > 0.0 && sum > one_sided_95 * std::sqrt(count);
}

/// The excited lines that the noise drowns where the band begins. Past -180 degrees among them, the phase may have
/// crossed below them all: how soft that crossing is, no line tells.
std::optional<Doubt> drowned_start(const std::vector<PhaseLine>& lines) {
  const std::size_t given_up = ragged_start(lines);
  if (given_up == 0 || given_up >= lines.size()) return std::nullopt;
  constexpr std::size_t lowest_lines = 16;  // above them there may be an antiresonance, and the phase be near 0 again
  const auto drowned = std::span(lines).first(std::min(given_up, lowest_lines));
  if (leads_towards_zero(drowned)) return std::nullopt;
  return Doubt{{lines.front().frequency, lines[given_up].frequency}, 0.0};
}

void judge(MeasuredStiffness& result, const Findings& findings, std::span<const PhaseLine> lines) {
  if (const auto phase = turned_phase(lines)) {
    result.status = MeasuredStiffnessStatus::not_in_band;
    warn(result, {.code = FindingCode::phase_half_turn_off, .evidence = {{"phase", *phase}}});
    return;
  }
  if (findings.runs.empty()) {
    result.status = MeasuredStiffnessStatus::undetermined;
    result.doubtful_bands.push_back(findings.band);
    warn(result, {.code = FindingCode::phase_not_told});
    return;
  }
  if (begins_unstable(result, findings)) {
    result.status = MeasuredStiffnessStatus::not_in_band;
    warn(result,
         {.code = FindingCode::phase_past_at_beginning, .evidence = {{"frequency", hertz(findings.band.lower)}}});
    return;
  }
  if (const MeasuredCrossover* least = softest(result.crossovers)) {
    result.limit = *least;
  } else {
    result.status = MeasuredStiffnessStatus::not_in_band;
    warn(result, {.code = FindingCode::no_crossover_in_band, .evidence = band_evidence(findings.band)});
  }
  for (const Doubt& doubt : findings.doubts) {
    if (result.limit && doubt.least_stiffness >= result.limit->stiffness_interval.lower) continue;
    result.doubtful_bands.push_back(doubt.band);
  }
  if (result.doubtful_bands.empty()) return;
  result.status = MeasuredStiffnessStatus::undetermined;
  Finding hidden{
      .code = result.limit ? FindingCode::noise_may_hide_softer_crossover : FindingCode::noise_hides_crossover,
      .evidence = {counted("bands", result.doubtful_bands.size())}};
  name_bands(result.doubtful_bands, hidden);
  warn(result, std::move(hidden));
}

/// Resonances that stand between lines too far apart to show them.
void remark_sparse_lines(MeasuredStiffness& result, const Findings& findings) {
  for (const Interval& lines : findings.sparse_lines) {
    warn(result, {.code = FindingCode::lines_too_far_apart, .evidence = band_evidence(lines)});
  }
}

/// Where the band begins the response is that of a spring: of one to ground, or of the link between two free bodies,
/// which acts so from their antiresonance to their resonance. A decade below the crossover the former is sure: the
/// latter would need bodies of a hundredfold mass. The phase tells where no delay turns it, else that the response does
/// not fall. One that falls more steeply than a rigid body's, or turns by more than half a turn per decade's logarithm,
/// as a delay of several samples makes it, may have come round once already.
void remark_beginning(MeasuredStiffness& result, std::span<const PhaseLine> lines) {
  constexpr double springlike = std::numbers::pi / 3.0;
  constexpr double surely_below = 0.1;
  constexpr double falling = -0.7;
  constexpr double steepest = -3.0;
  constexpr double most_turning = -2.4;
  if (!result.limit) return;
  const PhaseLine& first = lines.front();
  const std::optional<Beginning> beginning = beginning_of(lines);
  const bool is_springlike =
      std::abs(std::arg(first.value)) <= springlike || (beginning && beginning->steepness > falling);
  if (is_springlike && first.frequency > surely_below * result.limit->frequency) {
    warn(result, {.code = FindingCode::springlike_at_beginning, .evidence = {{"frequency", hertz(first.frequency)}}});
  } else if (!is_springlike && beginning && (beginning->steepness < steepest || beginning->turning < most_turning)) {
    warn(result, {.code = FindingCode::not_rigid_at_beginning, .evidence = {{"frequency", hertz(first.frequency)}}});
  }
}

/// Wide holes between excited lines, in which nothing is known either.
void remark_gaps(MeasuredStiffness& result, std::span<const PhaseLine> lines) {
  constexpr double wide = 4.0;
  for (std::size_t i = 2; i + 1 < lines.size(); ++i) {
    const double gap = lines[i].frequency - lines[i - 1].frequency;
    const double usual =
        std::max(lines[i - 1].frequency - lines[i - 2].frequency, lines[i + 1].frequency - lines[i].frequency);
    if (gap > wide * usual) {
      warn(result, {.code = FindingCode::gap_between_lines,
                    .evidence = band_evidence({lines[i - 1].frequency, lines[i].frequency})});
    }
  }
}

}  // namespace

MeasuredStiffness measured_stiffness(const FrequencyResponse& response) {
  if (!response.sampling_period) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::response_is_continuous});
  }
  if (response.points.size() < 2) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::response_of_few_lines,
                                              .evidence = {counted("lines", response.points.size()), {"least", 2.0}}});
  }
  MeasuredStiffness result;
  const std::vector<PhaseLine> all_lines = phase_lines(response);
  const std::vector<PhaseLine> lines = without_ragged_ends(all_lines);
  if (lines.size() < 2) {
    result.status = MeasuredStiffnessStatus::undetermined;
    result.measured_band = {response.points.front().frequency, response.points.back().frequency};
    result.doubtful_bands.push_back(result.measured_band);
    warn(result, {.code = FindingCode::phase_left_open, .evidence = band_evidence(result.measured_band)});
    return result;
  }
  Findings findings = find_crossings(lines, phase_verdicts(lines, response.line_correlation),
                                     phase_runs(lines, response.line_correlation), response.line_correlation);
  result.measured_band = findings.band;
  result.crossovers = findings.crossovers;
  if (const auto crossing = nyquist_crossing(response, findings.runs)) result.crossovers.push_back(*crossing);
  // Last, so that a beginning past -180 degrees is judged by the lines that are known.
  const std::optional<Doubt> start = doubtful_start(all_lines);
  if (start && may_cross(std::span(all_lines).first(1))) findings.doubts.push_back(*start);
  if (const auto drowned = drowned_start(all_lines)) findings.doubts.push_back(*drowned);
  judge(result, findings, lines);
  remark_beginning(result, lines);
  remark_gaps(result, lines);
  remark_sparse_lines(result, findings);
  const bool noise_known =
      response.averages > 0.0 || std::any_of(response.points.begin(), response.points.end(),
                                             [](const ResponsePoint& point) { return point.variance > 0.0; });
  if (!noise_known) {
    warn(result, {.code = FindingCode::response_without_noise});
  }
  result.remarks.push_back(
      note({.code = FindingCode::phase_measured, .evidence = band_evidence(result.measured_band)}));
  return result;
}

std::optional<Interval> stiffness_interval(const MeasuredStiffness& measured) {
  if (measured.status != MeasuredStiffnessStatus::found || !measured.limit) return std::nullopt;
  Interval interval = measured.limit->stiffness_interval;
  for (const MeasuredCrossover& crossover : measured.crossovers) {
    if (crossover.poles_leaving < 0) continue;
    interval.lower = std::min(interval.lower, crossover.stiffness_interval.lower);
    interval.upper = std::min(interval.upper, crossover.stiffness_interval.upper);
  }
  // The least of several estimates is no larger than any of them.
  interval.upper = std::max(interval.upper, measured.limit->stiffness);
  return interval;
}

}  // namespace zwidth

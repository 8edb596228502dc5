#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "counted.hpp"
#include "require_argument.hpp"
#include "signal/clipping.hpp"
#include "signal/median.hpp"
#include "zwidth/error.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth {
namespace {

constexpr std::size_t fewest_samples = 512;
constexpr std::size_t fewest_levels = 64;      // of a signal that is not coarse
constexpr std::size_t most_switch_levels = 8;  // of a force that is switched on purpose: relay, square wave, PRBS

// Clipping: a plateau at an extreme value that holds many more samples than the next levels do, with corners.
constexpr double levels_of_range = 400.0;     // a level is one of these, or an encoder step where that is coarser
constexpr int next_levels = 5;                // with which the extreme level is compared; a sine has 0.7 times these
constexpr double clipped_to_next = 3.0;       // ratio from which the extreme level is a plateau
constexpr double least_clipped_share = 1e-3;  // of the samples
constexpr std::size_t shortest_plateau = 3;   // samples; fewer happen at the peak of any smooth signal
constexpr std::size_t fewest_plateaus = 2;
constexpr double steps_of_speed = 10.0;    // encoder steps that a speed is measured over
constexpr std::size_t longest_lag = 1000;  // samples
constexpr double least_corner = 0.2;       // speed before a plateau, of the rms speed; a smooth stop has less
constexpr double switched_corner = 0.75;   // of the range: a square wave jumps onto its plateaus

// Dropout: a constant run far longer than the others, left with a jump.
constexpr std::size_t shortest_dropout = 20;   // samples
constexpr double dropout_to_usual_run = 20.0;  // ratio to the run length that 90 % of the runs do not exceed
constexpr double usual_share_of_runs = 0.9;
constexpr double least_jump_steps = 3.0;  // encoder steps
constexpr double least_jump = 0.1;        // rms steps

/// Consecutive equal samples.
struct Run {
  std::size_t begin = 0;
  std::size_t end = 0;  ///< one past the last
  [[nodiscard]] std::size_t length() const { return end - begin; }
};

template <typename Visit>
void each_run(std::span<const double> x, const Visit& visit) {
  for (std::size_t begin = 0; begin < x.size();) {
    std::size_t end = begin + 1;
    while (end < x.size() && x[end] == x[begin]) ++end;
    visit(Run{begin, end});
    begin = end;
  }
}

struct Extent {
  double least = 0.0;
  double most = 0.0;
  double smallest_step = 0.0;  ///< between neighbouring samples that differ: the encoder step of a quantised signal
  double rms_step = 0.0;       ///< of those
  double mean_step = 0.0;      ///< of all
  [[nodiscard]] double range() const { return most - least; }
};

Extent extent_of(std::span<const double> x) {
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  Extent extent{*least, *most, *most - *least, 0.0, 0.0};
  double sum = 0.0;
  double squares = 0.0;
  std::size_t steps = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    const double step = std::abs(x[i] - x[i - 1]);
    if (step == 0.0) continue;
    extent.smallest_step = std::min(extent.smallest_step, step);
    const double relative = step / extent.range();
    sum += relative;
    squares += relative * relative;
    ++steps;
  }
  extent.mean_step = extent.range() * sum / static_cast<double>(x.size());
  if (steps > 0) extent.rms_step = extent.range() * std::sqrt(squares / static_cast<double>(steps));
  return extent;
}

/// Distinct values, counted up to fewest_levels.
std::size_t levels_of(std::span<const double> x) {
  std::set<double> levels;
  for (std::size_t i = 0; i < x.size() && levels.size() < fewest_levels; ++i) {
    if (i == 0 || x[i] != x[i - 1]) levels.insert(x[i]);
  }
  return levels.size();
}

/// What a remark is made from.
struct Signal {
  const Channel& channel;
  double sampling_period;
  SignalRole role;

  [[nodiscard]] std::span<const double> samples() const { return channel.samples; }
  [[nodiscard]] bool is_force() const { return role == SignalRole::force; }
  [[nodiscard]] double time(std::size_t sample) const { return static_cast<double>(sample) * sampling_period; }
  [[nodiscard]] Finding finding(FindingCode code, std::vector<Evidence> evidence) const {
    return {.code = code,
            .evidence = std::move(evidence),
            .subjects = {{"channel", channel.name}, {"role", is_force() ? "force" : "motion"}}};
  }
};

void check_length(const Signal& signal, std::vector<Remark>& remarks) {
  const std::size_t size = signal.samples().size();
  if (size >= fewest_samples) return;
  Finding found = signal.finding(FindingCode::signal_short, {internal::counted("samples", size),
                                                             {"duration", signal.time(size)},
                                                             internal::counted("threshold", fewest_samples)});
  if (size > 0) found.evidence.push_back({"spacing", 1.0 / signal.time(size)});
  remarks.push_back(warning(std::move(found)));
}

void remark_constant(const Signal& signal, std::vector<Remark>& remarks) {
  remarks.push_back(warning(signal.finding(FindingCode::signal_constant, {{"value", signal.samples().front()}})));
}

void check_levels(const Signal& signal, std::size_t levels, std::vector<Remark>& remarks) {
  const bool switched = signal.is_force() && levels <= most_switch_levels;
  if (levels >= fewest_levels || switched) return;
  remarks.push_back(
      warning(signal.finding(FindingCode::signal_quantised, {internal::counted("levels", levels),
                                                             internal::counted("threshold", fewest_levels),
                                                             {"error", 0.5 / static_cast<double>(levels - 1)}})));
}

/// Plateaus at one extreme value.
struct Plateaus {
  std::size_t samples = 0;
  std::size_t count = 0;            ///< of those of shortest_plateau samples or more
  std::size_t first = 0;            ///< sample
  std::size_t samples_in_next = 0;  ///< in the next levels
  std::vector<double> entry_moves;  ///< how far the signal moved onto a plateau within the lag
  std::vector<double> entry_jumps;  ///< the step onto a plateau
};

/// Samples over which an encoder's signal moves by so many steps that its speed shows.
std::size_t lag_of_speed(const Extent& extent) {
  const double lag = std::ceil(steps_of_speed * extent.smallest_step / extent.mean_step);
  return static_cast<std::size_t>(std::clamp(lag, 1.0, static_cast<double>(longest_lag)));
}

double rms_move(std::span<const double> x, std::size_t lag, double range) {
  double squares = 0.0;
  for (std::size_t i = lag; i < x.size(); ++i) {
    const double relative = (x[i] - x[i - lag]) / range;
    squares += relative * relative;
  }
  return range * std::sqrt(squares / static_cast<double>(x.size()));
}

Plateaus plateaus_at(std::span<const double> x, const Extent& extent, double extreme, std::size_t lag) {
  Plateaus found;
  const double level = std::max(extent.smallest_step, extent.range() / levels_of_range);
  each_run(x, [&](const Run& run) {
    const double depth = std::abs(x[run.begin] - extreme);
    if (depth < 0.5 * level) {
      found.samples += run.length();
    } else if (depth < (0.5 + next_levels) * level) {
      found.samples_in_next += run.length();
    }
    if (x[run.begin] != extreme || run.length() < shortest_plateau || run.begin <= lag) return;
    if (found.count++ == 0) found.first = run.begin;
    const auto move_to = [&](std::size_t i) { return std::abs(x[i] - x[i - lag]); };
    found.entry_jumps.push_back(std::abs(x[run.begin] - x[run.begin - 1]));
    // The step onto the plateau is cut short by it, the one before is not.
    found.entry_moves.push_back(std::max(move_to(run.begin), move_to(run.begin - 1)) - extent.smallest_step);
  });
  return found;
}

/// `usual_move`: the signal's rms change over the lag of the plateaus.
bool is_clipped(const Plateaus& plateaus, const Extent& extent, double usual_move, std::size_t size) {
  if (plateaus.count < fewest_plateaus) return false;
  const auto samples = static_cast<double>(plateaus.samples);
  return samples >= least_clipped_share * static_cast<double>(size) &&
         samples >= clipped_to_next * static_cast<double>(plateaus.samples_in_next) &&
         internal::median(plateaus.entry_moves) >= least_corner * usual_move &&
         internal::median(plateaus.entry_jumps) < switched_corner * extent.range();
}

/// The extreme values at which the signal is clipped.
std::vector<double> check_clipping(const Signal& signal, const Extent& extent, std::vector<Remark>& remarks) {
  const auto x = signal.samples();
  const std::size_t lag = lag_of_speed(extent);
  const double usual_move = rms_move(x, lag, extent.range());
  std::vector<double> clipped;
  for (const double extreme : {extent.most, extent.least}) {
    const Plateaus plateaus = plateaus_at(x, extent, extreme, lag);
    if (!is_clipped(plateaus, extent, usual_move, x.size())) continue;
    clipped.push_back(extreme);
    remarks.push_back(warning(signal.finding(
        FindingCode::signal_clipped, {{"level", extreme},
                                      {"share", static_cast<double>(plateaus.samples) / static_cast<double>(x.size())},
                                      {"first", signal.time(plateaus.first)}})));
  }
  return clipped;
}

/// The length that most runs do not exceed.
std::size_t usual_run(std::span<const double> x) {
  constexpr std::size_t longest_counted = 4096;
  std::array<std::size_t, longest_counted + 1> runs_of{};
  std::size_t runs = 0;
  each_run(x, [&](const Run& run) {
    ++runs_of[std::min(run.length(), longest_counted)];
    ++runs;
  });
  const double enough = usual_share_of_runs * static_cast<double>(runs);
  std::size_t length = 0;
  for (double counted = 0.0; counted < enough;) counted += static_cast<double>(runs_of[++length]);
  return length;
}

struct Dropouts {
  std::size_t count = 0;
  Run longest;
};

/// Long runs that end in a jump: slow motion of a coarse encoder changes by one step, a lost signal comes back
/// elsewhere. Rest before the excitation, and a force that rests at 0 before or after it, are none.
Dropouts find_dropouts(const Signal& signal, const Extent& extent, std::span<const double> clipped) {
  const auto x = signal.samples();
  const std::size_t threshold =
      std::max(shortest_dropout, static_cast<std::size_t>(dropout_to_usual_run * static_cast<double>(usual_run(x))));
  const double least = std::max(least_jump_steps * extent.smallest_step, least_jump * extent.rms_step);
  Dropouts found;
  each_run(x, [&](const Run& run) {
    const bool last = run.end == x.size();
    if (run.length() < threshold || run.begin == 0 || (last && signal.is_force())) return;
    const double value = x[run.begin];
    const bool switched = signal.is_force() && (value == extent.most || value == extent.least);
    if (switched || std::find(clipped.begin(), clipped.end(), value) != clipped.end()) return;
    const double before = std::abs(value - x[run.begin - 1]);
    const double after = last ? 0.0 : std::abs(x[run.end] - value);
    if (std::max(before, after) < least) return;
    ++found.count;
    if (run.length() > found.longest.length()) found.longest = run;
  });
  return found;
}

void check_dropouts(const Signal& signal, const Extent& extent, std::span<const double> clipped,
                    std::vector<Remark>& remarks) {
  const Dropouts found = find_dropouts(signal, extent, clipped);
  if (found.count == 0) return;
  const double value = signal.samples()[found.longest.begin];
  const bool idle = signal.is_force() && value == 0.0;
  Finding lost = signal.finding(
      idle ? FindingCode::signal_idle : FindingCode::signal_lost,
      {{"value", value}, {"begin", signal.time(found.longest.begin)}, {"end", signal.time(found.longest.end - 1)}});
  lost.evidence.push_back(internal::counted("samples", found.longest.length()));
  lost.evidence.push_back(internal::counted("dropouts", found.count));
  remarks.push_back(idle ? note(std::move(lost)) : warning(std::move(lost)));
}

}  // namespace

std::vector<Remark> check_signal(const Channel& channel, double sampling_period, SignalRole role) {
  internal::require_positive({"sampling period", sampling_period, "s"});
  const auto& samples = channel.samples;
  if (!std::all_of(samples.begin(), samples.end(), [](double value) { return std::isfinite(value); })) {
    throw Error(ErrorCode::invalid_argument,
                {.code = ProblemCode::not_finite, .subjects = {{"name", "a sample of " + channel.name}}});
  }
  const Signal signal{channel, sampling_period, role};
  std::vector<Remark> remarks;
  check_length(signal, remarks);
  if (samples.empty()) return remarks;
  const Extent extent = extent_of(samples);
  if (extent.range() == 0.0) {
    remark_constant(signal, remarks);
    return remarks;
  }
  const std::size_t levels = levels_of(samples);
  check_levels(signal, levels, remarks);
  const bool switched = levels <= most_switch_levels;  // plateaus and runs are its nature
  if (switched || !std::isfinite(extent.range())) return remarks;
  const auto clipped = check_clipping(signal, extent, remarks);
  check_dropouts(signal, extent, clipped, remarks);
  return remarks;
}

namespace internal {

bool is_clipped(const Channel& channel, double sampling_period, SignalRole role) {
  const Extent extent = extent_of(channel.samples);
  if (extent.range() == 0.0 || !std::isfinite(extent.range())) return false;
  if (levels_of(channel.samples) <= most_switch_levels) return false;
  std::vector<Remark> remarks;
  return !check_clipping({channel, sampling_period, role}, extent, remarks).empty();
}

}  // namespace internal

}  // namespace zwidth

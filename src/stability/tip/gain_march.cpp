#include "stability/tip/gain_march.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "eigenvalues.hpp"

namespace zwidth::internal {
namespace {

constexpr double first_gain = 1e-9;       // of the loop's unit: below, poles leave z = 1 in proportion to the gain
constexpr double last_first_gain = 1e-3;  // of the unit, where poles leave the circle so slowly that rounding hides it
constexpr double to_next_gain = 10.0;
constexpr double in_proportion = 0.1;   // relative
constexpr double rounded_steps = 10.0;  // of eps |A|: what an eigenvalue decomposition leaves
constexpr double greatest_gain = 1e12;  // of the unit
constexpr double lowest_gain = 1e-9;    // of the one that a march downwards begins at
constexpr int most_gain_steps = 200000;
constexpr int most_steps_down = 2000;
constexpr int most_newton_steps = 40;
constexpr double of_certain_step = 0.999;
constexpr double followed_until = 1e-7;  // relative, below the crossing
constexpr double close_to_crossing = 0.05;
constexpr double nearer = 0.1;
constexpr double of_rounding = 1e-14;  // |z|
constexpr double free_pole_below = 1e-11;

// At z = 1, of a position that no wall holds.
bool is_free(std::complex<double> delta) { return std::abs(delta) < free_pole_below; }

struct LoopPole {
  double excess = 0.0;  // |z| - 1
  double growth = 0.0;  // of it with the gain
  double angle = 0.0;
  double residue = 0.0;  // |C r| |l B|
  double rounding = 0.0;
  Eigen::VectorXcd motion;
};

// Of delta = z - 1.
std::vector<LoopPole> poles_at(const GainLoop& loop, double gain) {
  const Eigen::MatrixXd closed = loop.state - gain * loop.input * loop.output;
  const EigenDecomposition of = eigen_decomposition(closed);
  const double rounded = rounded_steps * std::numeric_limits<double>::epsilon() * closed.norm();
  const Eigen::MatrixXcd motions = loop.output * of.right;
  const Eigen::MatrixXcd drives = of.left * loop.input;
  std::vector<LoopPole> poles;
  for (Eigen::Index i = 0; i < of.values.size(); ++i) {
    const std::complex<double> delta = of.values(i);
    const std::complex<double> z = 1.0 + delta;
    LoopPole pole;
    pole.excess = (2.0 * delta.real() + std::norm(delta)) / (std::abs(z) + 1.0);
    const std::complex<double> moves = -(drives.row(i) * motions.col(i)).value();
    pole.growth = std::abs(z) > 0.0 ? (std::conj(z) * moves).real() / std::abs(z) : 0.0;
    pole.angle = std::abs(std::arg(z));
    pole.residue = motions.col(i).norm() * drives.row(i).norm();
    pole.rounding = rounded * of.right.col(i).norm() * of.left.row(i).norm();
    pole.motion = motions.col(i);
    if (!(is_free(delta) && pole.residue * std::max(gain, 1.0) < free_pole_below)) poles.push_back(std::move(pole));
  }
  return poles;
}

// How far the gain may move; nothing where the loop is not surely stable.
std::optional<double> certain_step(const std::vector<LoopPole>& poles) {
  double sum = 0.0;
  for (const LoopPole& pole : poles) {
    if (!(pole.excess < -of_rounding)) return std::nullopt;
    sum += pole.residue / -pole.excess;
  }
  return std::isfinite(sum) && sum > 0.0 ? std::optional(1.0 / sum) : std::nullopt;
}

// The pole that reaches the circle first where each goes on as it goes.
const LoopPole* first_to_leave(const std::vector<LoopPole>& poles) {
  const LoopPole* first = nullptr;
  for (const LoopPole& each : poles) {
    if (!(each.growth > 0.0)) continue;
    if (first == nullptr || -each.excess * first->growth < -first->excess * each.growth) first = &each;
  }
  return first;
}

// What is beyond rounding, which moves a pole by eps |A| |l| |r|.
double sure_from(const LoopPole& pole) { return std::max(of_rounding, pole.rounding); }

bool is_surely_unstable(const LoopPole& pole) { return pole.excess > sure_from(pole); }

bool is_surely_stable(const LoopPole& pole) { return pole.excess < -sure_from(pole); }

// From where the march begins, `crossing`; or what is known instead.
struct FirstGain {
  GainLimit::Kind kind = GainLimit::Kind::not_determined;
  double gain = 0.0;
};

// Of a pole that lies on the circle without a wall: it moves in proportion to the gain.
bool leaves_at_once(const LoopPole& pole, double gain) {
  const double expected = pole.growth * gain;
  return std::abs(pole.excess - expected) <= in_proportion * std::abs(expected);
}

// A pole that the wall hardly moves is at first as near to the circle as rounding: on which side, larger gains tell. From the
// first that tells all, intervals go down to the least gain, or to where rounding hides the pole again.
FirstGain first_known_gain(const GainLoop& loop) {
  for (double known = first_gain; known <= last_first_gain; known *= to_next_gain) {
    std::vector<LoopPole> poles = poles_at(loop, known);
    const auto unstable = std::ranges::find_if(poles, is_surely_unstable);
    if (unstable != poles.end()) {
      if (known > first_gain && !leaves_at_once(*unstable, known)) return {};
      return {.kind = GainLimit::Kind::none_stable};
    }
    if (!std::ranges::all_of(poles, is_surely_stable)) continue;
    double gain = known;
    std::optional<double> certain = certain_step(poles);
    for (int step = 0; certain && gain > first_gain; ++step) {
      if (step == most_steps_down) return {};
      gain -= of_certain_step * *certain;
      if (!(gain > 0.0)) break;
      poles = poles_at(loop, gain);
      certain = certain_step(poles);
    }
    if (std::ranges::any_of(poles, is_surely_unstable)) return {};
    return {GainLimit::Kind::crossing, known};
  }
  return {};
}

}  // namespace

std::optional<GainLimit> polished_crossing(const GainLoop& loop, double gain, double angle) {
  double moved = std::numeric_limits<double>::infinity();
  for (int step = 0; step < most_newton_steps; ++step) {
    const std::vector<LoopPole> poles = poles_at(loop, gain);
    const auto distance = [angle](const LoopPole& a) { return std::hypot(a.excess, a.angle - angle); };
    const auto nearest = std::ranges::min_element(
        poles, [&](const LoopPole& a, const LoopPole& b) { return distance(a) < distance(b); });
    if (nearest == poles.end() || nearest->growth == 0.0) return std::nullopt;
    const double change = -nearest->excess / nearest->growth;
    angle = nearest->angle;
    const bool is_settled = std::abs(change) <= 4.0 * std::numeric_limits<double>::epsilon() * gain ||
                            (step > 3 && std::abs(change) >= moved && std::abs(change) < followed_until * gain);
    if (is_settled) return GainLimit{GainLimit::Kind::crossing, gain, angle, nearest->motion};
    moved = std::abs(change);
    gain = std::clamp(gain + change, 0.5 * gain, 2.0 * gain);
  }
  return std::nullopt;
}

namespace {

// `way` is 1 upwards, -1 downwards.
GainLimit next_crossing(const GainLoop& loop, double from, double way) {
  double gain = from;
  std::vector<LoopPole> poles = poles_at(loop, gain);
  std::optional<GainLimit> ahead;
  double near = close_to_crossing;
  for (int step = 0; step < most_gain_steps; ++step) {
    const std::optional<double> certain = certain_step(poles);
    if (!certain) {
      // Down to 0 poles go to z = 1, at last nearer than rounding.
      const bool is_hidden =
          way < 0.0 && gain < last_first_gain * from && std::ranges::none_of(poles, is_surely_unstable);
      return {.kind = is_hidden ? GainLimit::Kind::unbounded : GainLimit::Kind::not_determined};
    }
    if (gain > greatest_gain || gain < lowest_gain * from) return {.kind = GainLimit::Kind::unbounded};
    for (LoopPole& each : poles) each.growth *= way;
    const LoopPole* next = first_to_leave(poles);
    const double gap = next != nullptr ? -next->excess / next->growth : std::numeric_limits<double>::infinity();
    if (gap < near * gain) {
      // Again as the march comes closer, for another pole may have been meant.
      near = nearer * gap / gain;
      ahead = polished_crossing(loop, gain + way * gap, next->angle);
    }
    const bool is_ahead = ahead && way * (ahead->gain - gain) > 0.0;
    if (is_ahead && way * (gain - (1.0 - way * followed_until) * ahead->gain) >= 0.0) return *ahead;
    if (way < 0.0 && !(*certain < gain)) return {.kind = GainLimit::Kind::unbounded};  // certain down to 0
    gain += way * of_certain_step * *certain;
    poles = poles_at(loop, gain);
  }
  return {};
}

}  // namespace

GainLimit first_crossing(const GainLoop& loop) {
  const FirstGain first = first_known_gain(loop);
  if (first.kind != GainLimit::Kind::crossing) return {.kind = first.kind};
  return crossing_above(loop, first.gain);
}

GainLimit crossing_above(const GainLoop& loop, double gain) { return next_crossing(loop, gain, 1.0); }

GainLimit crossing_below(const GainLoop& loop, double gain) { return next_crossing(loop, gain, -1.0); }

bool is_stable(const GainLoop& loop, double gain) {
  for (const std::complex<double>& delta : eigenvalues(loop.state - gain * loop.input * loop.output)) {
    if (2.0 * delta.real() + std::norm(delta) > 0.0 && !is_free(delta)) return false;
  }
  return true;
}

double stability_excess_at(const GainLoop& loop, std::complex<double> gain) {
  double largest = -1.0;
  const Eigen::MatrixXcd closed = loop.state.cast<std::complex<double>>() - gain * (loop.input * loop.output);
  for (const std::complex<double>& delta : complex_eigenvalues(closed)) {
    if (!is_free(delta)) largest = std::max(largest, std::abs(1.0 + delta) - 1.0);
  }
  return largest;
}

double stability_excess(const GainLoop& loop, double gain) {
  double largest = -1.0;
  for (const LoopPole& pole : poles_at(loop, gain)) largest = std::max(largest, pole.excess);
  return largest;
}

}  // namespace zwidth::internal

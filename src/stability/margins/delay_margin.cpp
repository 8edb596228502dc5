#include "stability/margins/delay_margin.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "stability/margins/unit_gain.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal {
namespace {

using std::numbers::pi;

constexpr int first_segments = 16;         // of one period of delay, and of one period of the fastest mode
constexpr int most_segments = 256;         // modes that many times faster than the sampling hardly answer
constexpr double shortest_segment = 1e-9;  // of a period
constexpr double greatest_turn = 0.5;      // of a crossover's lag within a segment, beyond that of its angle; rad
constexpr double greatest_move = 0.2;      // of a crossover's angle within a segment, relative

// The loop with `share` of a sample added to its delay.
struct Instant {
  double share = 0.0;
  std::vector<UnitGainPoint> points;
};

class DelayedDevice final : public DelayedLoop {
 public:
  explicit DelayedDevice(const Device& device) : device_(device), form_(modal_form(device)) {}

  [[nodiscard]] std::vector<UnitGainPoint> points_at(double share) const override {
    return unit_gain_points(plant_with(share), device_.parameters().wall);
  }
  [[nodiscard]] double level_at_nyquist(double share) const override {
    return std::log(std::abs(loop_gain(plant_with(share), device_.parameters().wall, pi)));
  }
  [[nodiscard]] bool has_one_locus() const override { return true; }
  [[nodiscard]] double period() const override { return device_.loop().sampling_period; }
  [[nodiscard]] double fastest_mode() const override {
    double fastest = form_.suspended_rigid_body ? form_.suspended_rigid_body->frequency : 0.0;
    for (const Mode& mode : form_.modes) fastest = std::max(fastest, mode.frequency);
    return fastest;
  }

 private:
  [[nodiscard]] FilteredPlant plant_with(double share) const {
    return filtered_plant(sample(form_, {period(), device_.loop().delay + share * period()}),
                          device_.parameters().wall.filters);
  }

  const Device& device_;
  ModalForm form_;
};

// Change of the lag to -1 from one instant to the next along a crossover, beyond the share's own -angle * share.
double turn_between(const UnitGainPoint& a, const UnitGainPoint& b, double share) {
  const double own = -0.5 * (a.angle + b.angle) * share;
  return std::remainder(b.phase - a.phase - own, 2.0 * pi);
}

// How far one crossover is from being another's successor: up to 1 it is taken for it.
double distance_to_successor(const UnitGainPoint& a, const UnitGainPoint& b, double share) {
  return std::max(std::abs(b.angle - a.angle) / (greatest_move * a.angle),
                  std::abs(turn_between(a, b, share)) / greatest_turn);
}

// The successor of each crossover; nothing where one has none, or two might be.
std::optional<std::vector<std::size_t>> successors(const Instant& a, const Instant& b, bool has_one_locus) {
  if (a.points.size() != b.points.size()) return std::nullopt;
  const double share = b.share - a.share;
  std::vector<std::size_t> result(a.points.size());
  std::vector<bool> is_taken(a.points.size(), false);
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    result[i] = i;
    for (std::size_t k = 0; !has_one_locus && k < b.points.size(); ++k) {
      if (distance_to_successor(a.points[i], b.points[k], share) <
          distance_to_successor(a.points[i], b.points[result[i]], share))
        result[i] = k;
    }
    if (distance_to_successor(a.points[i], b.points[result[i]], share) > 1.0 || is_taken[result[i]])
      return std::nullopt;
    is_taken[result[i]] = true;
  }
  return result;
}

// A crossover that reaches -1 between two instants, with `whole` further samples.
struct Candidate {
  double whole = 0.0;
  double begin = 0.0;
  double end = 0.0;
  std::size_t index = 0;     // among the crossovers
  UnitGainPoint first = {};  // the crossover at the ends
  UnitGainPoint last = {};
  double at_begin = 0.0;  // lag left at the ends
  double at_end = 0.0;

  [[nodiscard]] double from() const { return whole + begin; }
};

class Search {
 public:
  explicit Search(const DelayedLoop& loop) : loop_(loop) {}

  [[nodiscard]] std::optional<double> least_delay() {
    Instant previous = at(0.0);
    const double periods = loop_.fastest_mode() * loop_.period() / (2.0 * pi);
    const int segments = static_cast<int>(std::min(first_segments * (1.0 + periods), double{most_segments}));
    for (int i = 1; i <= segments; ++i) {
      Instant next = at(static_cast<double>(i) / segments);
      look_between(previous, next);
      previous = std::move(next);
    }
    if (candidates_.empty()) return std::nullopt;
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& a, const Candidate& b) { return a.from() < b.from(); });
    double least = std::numeric_limits<double>::infinity();
    for (const Candidate& each : candidates_) {
      if (each.from() >= least) break;
      least = std::min(least, solved(each));
    }
    return least * loop_.period();
  }

 private:
  [[nodiscard]] Instant at(double share) const { return {share, loop_.points_at(share)}; }

  void look_between(const Instant& a, const Instant& b) {
    if (const auto next = successors(a, b, loop_.has_one_locus())) {
      for (std::size_t i = 0; i < a.points.size(); ++i) follow(a, b, i, (*next)[i]);
      return;
    }
    if (b.share - a.share <= shortest_segment) {
      const Instant& more = a.points.size() > b.points.size() ? a : b;
      look_at_pairs(more, a.share, b.share);
      if ((a.points.size() + b.points.size()) % 2 != 0) look_at_nyquist(more, a.share, b.share);
      return;
    }
    const Instant middle = at(0.5 * (a.share + b.share));
    look_between(a, middle);
    look_between(middle, b);
  }

  void follow(const Instant& a, const Instant& b, std::size_t index, std::size_t next) {
    const UnitGainPoint& first = a.points[index];
    const UnitGainPoint& second = b.points[next];
    const double share = b.share - a.share;
    const double lag = lag_to_instability(first);
    const double later = lag + turn_between(first, second, share) - 0.5 * (first.angle + second.angle) * share;
    // Whole samples m with lag - m angle of either sign at the ends; a lag that rises past a turn is -1 as well.
    for (const double turn : {0.0, 2.0 * pi}) {
      const double most = std::max((lag - turn) / first.angle, (later - turn) / second.angle);
      const double least = std::min((lag - turn) / first.angle, (later - turn) / second.angle);
      const double whole = std::max(std::ceil(least), 0.0);
      if (whole > most) continue;
      candidates_.push_back({whole, a.share, b.share, index, first, second, lag - turn - whole * first.angle,
                             later - turn - whole * second.angle});
    }
  }

  // Two crossovers that meet here: where -1 lies between them, the loop reaches it as they meet.
  void look_at_pairs(const Instant& more, double begin, double end) {
    for (std::size_t i = 1; i < more.points.size(); ++i) {
      for (std::size_t k = loop_.has_one_locus() ? i - 1 : 0; k < i; ++k) {
        const UnitGainPoint& a = more.points[k];
        const UnitGainPoint& b = more.points[i];
        if (b.angle - a.angle > greatest_move * a.angle) continue;
        const bool are_of_two = std::abs(std::remainder(a.phase - b.phase, 2.0 * pi)) > greatest_turn;
        if (!loop_.has_one_locus() && are_of_two) continue;
        const double first = lag_to_instability(a) / a.angle;
        const double second = lag_to_instability(b) / b.angle;
        const double whole = std::ceil(std::min(first, second));
        if (whole > std::max(first, second) || std::abs(first - second) * a.angle > pi) continue;
        candidates_.push_back({.whole = whole, .begin = begin, .end = end, .index = i});
      }
    }
  }

  // A crossover that is born or dies alone is so at Nyquist, where the loop gain is real: -1 there, or one sample later.
  void look_at_nyquist(const Instant& more, double begin, double end) {
    const double at_begin = loop_.level_at_nyquist(begin);
    const double at_end = loop_.level_at_nyquist(end);
    double share = begin;
    if (at_begin != 0.0 && (at_begin > 0.0) != (at_end > 0.0)) {
      std::uintmax_t most_steps = 100;
      const auto level = [&](double at) { return loop_.level_at_nyquist(at); };
      share = boost::math::tools::toms748_solve(level, begin, end, at_begin, at_end,
                                                boost::math::tools::eps_tolerance<double>(50), most_steps)
                  .first;
    }
    const double whole = std::abs(more.points.back().phase) < 0.5 * pi ? 0.0 : 1.0;
    candidates_.push_back({.whole = whole, .begin = share, .end = share, .index = more.points.size() - 1});
  }

  // The crossover that is on the way from the first to the last.
  static const UnitGainPoint& between_ends(const Candidate& candidate, const Instant& instant) {
    const double part = (instant.share - candidate.begin) / (candidate.end - candidate.begin);
    const double turn = turn_between(candidate.first, candidate.last, candidate.end - candidate.begin);
    UnitGainPoint guess{std::lerp(candidate.first.angle, candidate.last.angle, part), 0.0};
    const double own = -0.5 * (candidate.first.angle + guess.angle) * (instant.share - candidate.begin);
    guess.phase = candidate.first.phase + own + part * turn;
    return *std::ranges::min_element(
        instant.points, {}, [&](const UnitGainPoint& each) { return distance_to_successor(guess, each, 0.0); });
  }

  // The share at which the lag left passes zero, and the whole samples.
  [[nodiscard]] double solved(const Candidate& candidate) const {
    const auto lag_left = [&](double share) {
      const Instant instant = at(share);
      if (candidate.index >= instant.points.size()) return 0.0;
      const UnitGainPoint& point =
          loop_.has_one_locus() ? instant.points[candidate.index] : between_ends(candidate, instant);
      return std::remainder(point.phase - candidate.whole * point.angle, 2.0 * pi);
    };
    if (candidate.at_begin == 0.0 || (candidate.at_begin > 0.0) == (candidate.at_end > 0.0)) return candidate.from();
    std::uintmax_t most_steps = 100;
    const auto [low, high] =
        boost::math::tools::toms748_solve(lag_left, candidate.begin, candidate.end, candidate.at_begin,
                                          candidate.at_end, boost::math::tools::eps_tolerance<double>(50), most_steps);
    return candidate.whole + 0.5 * (low + high);
  }

  const DelayedLoop& loop_;
  std::vector<Candidate> candidates_;
};

}  // namespace

std::optional<double> least_delay(const DelayedLoop& loop) { return Search(loop).least_delay(); }

std::optional<double> exact_delay_margin(const Device& device) { return least_delay(DelayedDevice(device)); }

}  // namespace zwidth::internal

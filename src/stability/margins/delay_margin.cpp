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

class DelayedLoop {
 public:
  explicit DelayedLoop(const Device& device) : device_(device), form_(modal_form(device)) {}

  [[nodiscard]] Instant at(double share) const {
    return {share, unit_gain_points(plant_with(share), device_.parameters().wall)};
  }

  // log |C P| at Nyquist with `share` of a sample added; the loop gain is real there.
  [[nodiscard]] double level_at_nyquist(double share) const {
    return std::log(std::abs(loop_gain(plant_with(share), device_.parameters().wall, pi)));
  }

  // As many as follow the quickest motion of the crossovers: that of the fastest mode between two samples.
  [[nodiscard]] int segments() const {
    double fastest = form_.suspended_rigid_body ? form_.suspended_rigid_body->frequency : 0.0;
    for (const Mode& mode : form_.modes) fastest = std::max(fastest, mode.frequency);
    const double periods = fastest * period() / (2.0 * pi);
    return static_cast<int>(std::min(first_segments * (1.0 + periods), static_cast<double>(most_segments)));
  }

  [[nodiscard]] double period() const { return device_.loop().sampling_period; }

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

bool follow_each_other(const Instant& a, const Instant& b) {
  if (a.points.size() != b.points.size()) return false;
  const double share = b.share - a.share;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    if (std::abs(b.points[i].angle - a.points[i].angle) > greatest_move * a.points[i].angle) return false;
    if (std::abs(turn_between(a.points[i], b.points[i], share)) > greatest_turn) return false;
  }
  return true;
}

// A crossover that reaches -1 between two instants, with `whole` further samples.
struct Candidate {
  double whole = 0.0;
  double begin = 0.0;
  double end = 0.0;
  std::size_t index = 0;  // among the crossovers
  double at_begin = 0.0;  // lag left at the ends
  double at_end = 0.0;

  [[nodiscard]] double from() const { return whole + begin; }
};

class Search {
 public:
  explicit Search(const DelayedLoop& loop) : loop_(loop) {}

  [[nodiscard]] std::optional<double> least_delay() {
    Instant previous = loop_.at(0.0);
    const int segments = loop_.segments();
    for (int i = 1; i <= segments; ++i) {
      Instant next = loop_.at(static_cast<double>(i) / segments);
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
  void look_between(const Instant& a, const Instant& b) {
    if (follow_each_other(a, b)) {
      for (std::size_t i = 0; i < a.points.size(); ++i) follow(a, b, i);
      return;
    }
    if (b.share - a.share <= shortest_segment) {
      const Instant& more = a.points.size() > b.points.size() ? a : b;
      look_at_pairs(more, a.share, b.share);
      if ((a.points.size() + b.points.size()) % 2 != 0) look_at_nyquist(more, a.share, b.share);
      return;
    }
    const Instant middle = loop_.at(0.5 * (a.share + b.share));
    look_between(a, middle);
    look_between(middle, b);
  }

  void follow(const Instant& a, const Instant& b, std::size_t index) {
    const UnitGainPoint& first = a.points[index];
    const UnitGainPoint& second = b.points[index];
    const double share = b.share - a.share;
    const double lag = lag_to_instability(first);
    const double later = lag + turn_between(first, second, share) - 0.5 * (first.angle + second.angle) * share;
    // Whole samples m with lag - m angle of either sign at the ends; a lag that rises past a turn is -1 as well.
    for (const double turn : {0.0, 2.0 * pi}) {
      const double most = std::max((lag - turn) / first.angle, (later - turn) / second.angle);
      const double least = std::min((lag - turn) / first.angle, (later - turn) / second.angle);
      const double whole = std::max(std::ceil(least), 0.0);
      if (whole > most) continue;
      candidates_.push_back(
          {whole, a.share, b.share, index, lag - turn - whole * first.angle, later - turn - whole * second.angle});
    }
  }

  // Two crossovers that meet here: where -1 lies between them, the loop reaches it as they meet.
  void look_at_pairs(const Instant& more, double begin, double end) {
    for (std::size_t i = 1; i < more.points.size(); ++i) {
      const UnitGainPoint& a = more.points[i - 1];
      const UnitGainPoint& b = more.points[i];
      if (b.angle - a.angle > greatest_move * a.angle) continue;
      const double first = lag_to_instability(a) / a.angle;
      const double second = lag_to_instability(b) / b.angle;
      const double whole = std::ceil(std::min(first, second));
      if (whole > std::max(first, second) || std::abs(first - second) * a.angle > pi) continue;
      candidates_.push_back({whole, begin, end, i, 0.0, 0.0});
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
    candidates_.push_back({whole, share, share, more.points.size() - 1, 0.0, 0.0});
  }

  // The share at which the lag left passes zero, and the whole samples.
  [[nodiscard]] double solved(const Candidate& candidate) const {
    const auto lag_left = [&](double share) {
      const Instant instant = loop_.at(share);
      if (candidate.index >= instant.points.size()) return 0.0;
      const UnitGainPoint& point = instant.points[candidate.index];
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

std::optional<double> exact_delay_margin(const Device& device) { return Search(DelayedLoop(device)).least_delay(); }

}  // namespace zwidth::internal

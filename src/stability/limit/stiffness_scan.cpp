#include "stability/limit/stiffness_scan.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "stability/second_route/pole_modulus.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using Pole = std::complex<double>;  // z - 1

constexpr double at_one = 1e-9;              // of |z - 1|: the pole of a position that nothing holds
constexpr double first_step_of_scan = 0.25;  // of log K
constexpr double longest_crossing = 0.1;     // of log K: within it a pole crosses once
constexpr double shortest_step = 1e-7;       // of log K
constexpr double far_inside = -1.0;          // of log |z|: a pole below it needs no finer step
constexpr double most_growth = 1e6;          // of |z - 1|: beyond, the other eigenvalues are rounded
constexpr std::size_t most_evaluations = 20000;

struct Sample {
  double log_stiffness = 0.0;
  std::vector<Pole> poles;
};

// The poles of `next` in the order of those of `from`: the two nearest of all are a pair, then the nearest of the rest.
std::vector<Pole> matched(const std::vector<Pole>& from, std::vector<Pole> next) {
  struct Pair {
    double distance;
    std::size_t from;
    std::size_t next;
  };
  std::vector<Pair> pairs;
  pairs.reserve(from.size() * next.size());
  for (std::size_t i = 0; i < from.size(); ++i)
    for (std::size_t j = 0; j < next.size(); ++j) pairs.push_back({std::norm(from[i] - next[j]), i, j});
  std::ranges::sort(pairs, {}, &Pair::distance);
  std::vector<Pole> result(from.size());
  std::vector<bool> placed(from.size(), false);
  std::vector<bool> taken(next.size(), false);
  for (const Pair& pair : pairs) {
    if (placed[pair.from] || taken[pair.next]) continue;
    placed[pair.from] = taken[pair.next] = true;
    result[pair.from] = next[pair.next];
  }
  return result;
}

class StiffnessScan {
 public:
  explicit StiffnessScan(const ScheduledLoop& loop) : loop_(loop) {}

  [[nodiscard]] ScannedCrossings between(double least, double most) {
    const double first = std::log(least);
    const double last = std::log(most);
    const auto steps = static_cast<int>(std::ceil((last - first) / first_step_of_scan));
    Sample begin = at(first);
    for (const Pole& pole : begin.poles) {
      if (log_modulus(pole) > 0.0 && std::abs(pole) > at_one) ++found_.initially_unstable;
    }
    for (int i = 1; i <= steps; ++i) {
      Sample end = at(first + (last - first) * i / steps);
      const auto is_lost = [](const Pole& pole) { return !(std::abs(pole) <= most_growth); };
      if (std::ranges::any_of(end.poles, is_lost)) break;
      look_between(begin, end);
      begin = std::move(end);
    }
    std::ranges::sort(found_.crossings, {}, &ScannedCrossing::stiffness);
    return std::move(found_);
  }

 private:
  [[nodiscard]] Sample at(double log_stiffness) {
    if (++evaluations_ > most_evaluations) {
      throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::poles_not_told_apart});
    }
    return {log_stiffness, loop_.poles_minus_one(std::exp(log_stiffness))};
  }

  void look_between(const Sample& begin, const Sample& end) {
    const double length = end.log_stiffness - begin.log_stiffness;
    Sample middle = at(begin.log_stiffness + 0.5 * length);
    middle.poles = matched(begin.poles, std::move(middle.poles));
    Sample last{end.log_stiffness, matched(middle.poles, end.poles)};
    bool settled = true;
    for (std::size_t i = 0; i < begin.poles.size() && settled; ++i) {
      settled = is_settled(begin.poles[i], middle.poles[i], last.poles[i], length);
    }
    if (!settled && length > shortest_step) {
      look_between(begin, middle);
      look_between(middle, last);
      return;
    }
    for (std::size_t i = 0; i < begin.poles.size(); ++i) {
      add_crossing(begin, middle, i);
      add_crossing(middle, last, i);
    }
  }

  // Whether a pole that these three show crosses the circle only where log |z| changes sign.
  [[nodiscard]] static bool is_settled(Pole begin, Pole middle, Pole end, double length) {
    const double first = log_modulus(begin);
    const double last = log_modulus(end);
    const double between = log_modulus(middle);
    if (first < far_inside && between < far_inside && last < far_inside) return true;
    const double bend = std::abs(middle - 0.5 * (begin + end));
    if ((first > 0.0) == (between > 0.0) && (between > 0.0) == (last > 0.0)) {
      return 2.0 * bend < std::min({std::abs(first), std::abs(between), std::abs(last)});
    }
    // It changes sign once, on what is nearly a straight line.
    return (first > 0.0) != (last > 0.0) && length <= longest_crossing && 4.0 * bend < std::abs(last - first);
  }

  void add_crossing(const Sample& begin, const Sample& end, std::size_t index) {
    const double first = log_modulus(begin.poles[index]);
    const double last = log_modulus(end.poles[index]);
    if ((first > 0.0) == (last > 0.0)) return;
    // Of a pair the one above stands for both.
    const Pole seen = std::abs(first) < std::abs(last) ? begin.poles[index] : end.poles[index];
    if (seen.imag() < 0.0) return;
    Pole on_circle = seen;
    const auto followed = [&](double log_stiffness) {
      const double share = (log_stiffness - begin.log_stiffness) / (end.log_stiffness - begin.log_stiffness);
      const Pole expected = begin.poles[index] + share * (end.poles[index] - begin.poles[index]);
      const std::vector<Pole> poles = at(log_stiffness).poles;
      on_circle = *std::ranges::min_element(poles, {}, [&](Pole pole) { return std::norm(pole - expected); });
      return log_modulus(on_circle);
    };
    std::uintmax_t most_steps = 60;
    const auto [low, high] =
        boost::math::tools::toms748_solve(followed, begin.log_stiffness, end.log_stiffness, first, last,
                                          boost::math::tools::eps_tolerance<double>(50), most_steps);
    const double log_stiffness = 0.5 * (low + high);
    static_cast<void>(followed(log_stiffness));
    const bool is_real = on_circle.imag() == 0.0;
    found_.crossings.push_back({std::exp(log_stiffness),
                                {on_circle.real(), std::abs(on_circle.imag())},
                                (last > first ? 1 : -1) * (is_real ? 1 : 2)});
  }

  const ScheduledLoop& loop_;
  ScannedCrossings found_;
  std::size_t evaluations_ = 0;
};

}  // namespace

double soft_stiffness(const ScheduledLoop& loop, double most) {
  constexpr double still = 1e-3;
  constexpr double softer = 1e-2;
  constexpr int most_steps = 12;
  const std::vector<Pole> alone = loop.poles_minus_one(0.0);
  for (int step = 0; step < most_steps; ++step, most *= softer) {
    const std::vector<Pole> held = matched(alone, loop.poles_minus_one(most));
    bool stands = true;
    for (std::size_t i = 0; i < alone.size(); ++i) {
      stands = stands && (std::abs(alone[i]) <= at_one || std::abs(held[i] - alone[i]) <= still * std::abs(alone[i]));
    }
    if (stands) break;
  }
  return most;
}

ScannedCrossings scan_stiffness(const ScheduledLoop& loop, double least, double most) {
  return StiffnessScan(loop).between(least, most);
}

}  // namespace zwidth::internal

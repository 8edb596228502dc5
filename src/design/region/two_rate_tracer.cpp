#include "design/region/two_rate_tracer.hpp"

#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>

#include "staged_progress.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

using Node = BoundaryBranch::Node;
using Eigen::Vector3d;

// In shares of the scales.
constexpr double first_step = 0.01;
constexpr double longest_step = 0.04;
constexpr double shortest_step = 1e-10;
constexpr double most_turn = 0.15;           // rad
constexpr double most_correction = 0.2;      // of the step
constexpr double most_end_correction = 0.3;  // of the way to z = -1
constexpr double same_crossing = 1e-4;       // a chain meets a slice there
constexpr double same_point = 1e-7;          // ends of two chains
constexpr double closing = 0.1;              // of a step: the chain passes its own beginning
constexpr std::size_t most_nodes = 20000;    // of a chain
// Beside z = 1 and z = -1 the curve is known by its limits, of which these are a square away.
constexpr double least_angle = 1e-6;
// Of the curve of z = -1.
constexpr int most_halvings = 40;
constexpr double straight = 1e-3;
constexpr double beyond_gains = 0.2;
constexpr int most_depth = 16;
constexpr std::uintmax_t most_steps_to_end = 60;

[[noreturn]] void lose() { throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::outline_not_closed}); }

class ChainTracer {
 public:
  ChainTracer(const TwoRateCurve& curve, const RegionSlices& slices, int fineness, const Progress& progress)
      : curve_(curve), slices_(slices), fineness_(fineness), progress_(progress) {
    const WallPoint most = curve.wall(slices.most_outside, slices.most_inside);
    lowest_ = {least_angle, 0.0, 0.0};
    highest_ = {std::numbers::pi - beside_nyquist, most.stiffness, most.damping};
    for (const RegionSlice& slice : slices.slices) covered_.emplace_back(slice.found.crossings.size(), false);
  }

  [[nodiscard]] std::vector<TwoRateChain> all() {
    std::vector<TwoRateChain> chains;
    // From the largest gain on: what is small in shares of it is known to fewer digits, and mostly on a chain by then.
    for (std::size_t i = slices_.slices.size(); i-- > 0;) {
      const RegionSlice& slice = slices_.slices[i];
      for (std::size_t j = 0; j < slice.found.crossings.size(); ++j) {
        const GainCrossing& seed = slice.found.crossings[j];
        const bool inside = seed.angle > lowest_(0) && seed.angle < highest_(0) && seed.gain < slices_.most_outside &&
                            slice.inside <= slices_.most_inside;
        if (!inside || covered_[i][j]) continue;
        covered_[i][j] = true;
        // A crossing that only touches the circle is passed by others.
        if (seed.poles_leaving == 0) continue;
        add(through({seed.angle, curve_.wall(seed.gain, slice.inside)}), chains);
        tell(progress_, 1.0 - static_cast<double>(i) / static_cast<double>(slices_.slices.size()));
      }
    }
    add_from(ends_with_nothing_outside(), chains);
    add_from(ends_at_nyquist(chains), chains);
    add_nyquist(chains);
    if (const auto drift = curve_.drift_stiffness(); drift && *drift < highest_(1)) {
      chains.push_back({BoundaryKind::drift, {{0.0, {*drift, 0.0}}, {0.0, {*drift, highest_(2)}}}, false});
    }
    if (const auto inside = curve_.unreached_gain(); inside && *inside < slices_.most_inside) {
      const double angle = curve_.unreached_angle();
      chains.push_back({BoundaryKind::nyquist,
                        {{angle, curve_.wall(0.0, *inside)}, {angle, curve_.wall(slices_.most_outside, *inside)}},
                        false});
    }
    return chains;
  }

 private:
  static Vector3d place(const Node& node) { return TwoRateCurve::place(node); }
  static Node node_at(const Vector3d& place) { return {place(0), {place(1), place(2)}}; }
  [[nodiscard]] Vector3d share(const Node& node) const { return place(node).cwiseQuotient(curve_.scales); }

  // Those of the seeds that no chain has.
  void add_from(const std::vector<Node>& seeds, std::vector<TwoRateChain>& chains) {
    for (const Node& seed : seeds) {
      const auto ends_here = [&](const TwoRateChain& chain) {
        return std::ranges::any_of(std::array{chain.nodes.front(), chain.nodes.back()},
                                   [&](const Node& end) { return (share(end) - share(seed)).norm() < same_crossing; });
      };
      if (std::ranges::any_of(chains, ends_here)) continue;
      add(through(seed), chains);
    }
  }

  // Where curves end between two slices, and there may be no more of them: with nothing outside, and at z = -1.
  [[nodiscard]] std::vector<Node> ends_with_nothing_outside() const {
    std::vector<Node> seeds;
    for (const GainCrossing& each : curve_.crossings_alone().crossings) {
      const double angle = curve_.seen_angle(each.angle);
      if (each.poles_leaving == 0 || each.gain >= slices_.most_inside) continue;
      if (angle > lowest_(0) && angle < highest_(0)) seeds.push_back({angle, curve_.wall(0.0, each.gain)});
    }
    return seeds;
  }

  [[nodiscard]] std::vector<Node> ends_at_nyquist(const std::vector<TwoRateChain>& chains) const {
    std::vector<Node> seeds;
    const double angle = highest_(0);
    const auto phase = [&](double inside) { return curve_.phase(angle, inside); };
    const std::vector<double> places = places_inside(chains);
    double before = 0.0;
    for (std::size_t i = 1; i < places.size(); ++i) {
      const double here = phase(places[i]);
      if (before * here < 0.0) {
        std::uintmax_t steps = most_steps_to_end;
        const auto [low, high] = boost::math::tools::toms748_solve(
            phase, places[i - 1], places[i], before, here, boost::math::tools::eps_tolerance<double>(45), steps);
        const double inside = 0.5 * (low + high);
        const double gain = curve_.gain(angle, inside);
        if (gain > 0.0 && gain < slices_.most_outside) seeds.push_back({angle, curve_.wall(gain, inside)});
      }
      before = here;
    }
    return seeds;
  }

  // Gains inside from 0, with those at which something happens.
  [[nodiscard]] std::vector<double> places_inside(const std::vector<TwoRateChain>& chains) const {
    std::vector<double> places{0.0, slices_.most_inside};
    const auto add = [&](double inside) {
      if (inside < slices_.most_inside) places.push_back(inside);
    };
    for (const RegionSlice& slice : slices_.slices) add(slice.inside);
    for (const GainCrossing& each : curve_.crossings_alone().crossings) add(each.gain);
    for (const TwoRateChain& chain : chains) {
      for (const Node& end : {chain.nodes.front(), chain.nodes.back()}) {
        if (end.angle == std::numbers::pi) add(curve_.inside(end.wall));
      }
    }
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return places;
  }

  [[nodiscard]] TwoRateChain through(const Node& seed) const {
    const Vector3d along = curve_.tangent(seed);
    std::vector<Node> nodes{seed};
    TwoRateChain chain;
    if (follow(nodes, along)) {
      chain.is_closed = true;
      chain.nodes = std::move(nodes);
      return chain;
    }
    std::vector<Node> back{seed};
    (void)follow(back, -along);
    chain.nodes.assign(back.rbegin(), back.rend());
    chain.nodes.insert(chain.nodes.end(), nodes.begin() + 1, nodes.end());
    return chain;
  }

  // Whether it comes back to where it began; else it goes on to where it leaves the gains looked at.
  [[nodiscard]] bool follow(std::vector<Node>& nodes, Vector3d along) const {
    const Vector3d first = along;
    const double longest = longest_step / (fineness_ * fineness_);
    double step = std::min(first_step, longest);
    while (nodes.size() < most_nodes) {
      if (step < shortest_step) lose();
      const Node& last = nodes.back();
      const Vector3d ahead = place(last) + step * along.cwiseProduct(curve_.scales);
      const std::optional<Node> next = curve_.solve(node_at(ahead), along);
      if (!next) {
        step *= 0.5;
        continue;
      }
      if (const auto [out, at] = first_exit(last, *next); out >= 0) {
        const std::optional<Node> end = end_at(last, *next, out, at);
        if (!end && step > 1e3 * shortest_step) {
          step *= 0.5;
          continue;
        }
        if (end && (share(*end) - share(last)).norm() > shortest_step) nodes.push_back(*end);
        return false;
      }
      Vector3d turned = curve_.tangent(*next);
      if (turned.dot(along) < 0.0) turned = -turned;
      const double off = (share(*next) - ahead.cwiseQuotient(curve_.scales)).norm();
      if (!(turned.dot(along) > std::cos(most_turn)) || off > most_correction * step) {
        step *= 0.5;
        continue;
      }
      if (nodes.size() > 3 && passes(share(last), share(*next), share(nodes.front()), first)) {
        nodes.push_back(nodes.front());
        return true;
      }
      const bool straighter = turned.dot(along) > std::cos(0.5 * most_turn);
      nodes.push_back(*next);
      along = turned;
      if (straighter) step = std::min(1.5 * step, longest);
    }
    lose();
  }

  static bool passes(const Vector3d& from, const Vector3d& to, const Vector3d& start, const Vector3d& along) {
    const Vector3d way = to - from;
    const double part = (start - from).dot(way) / way.squaredNorm();
    if (!(part >= 0.0 && part <= 1.0) || !(way.normalized().dot(along) > 0.9)) return false;
    return (start - from - part * way).norm() <= closing * way.norm();
  }

  struct Exit {
    int coordinate = -1;
    double at = 0.0;
  };
  // The bound that is passed first between the two.
  [[nodiscard]] Exit first_exit(const Node& last, const Node& next) const {
    const Vector3d from = place(last);
    const Vector3d to = place(next);
    Exit exit;
    double least = 2.0;
    for (int i = 0; i < 3; ++i) {
      const double bound = to(i) < lowest_(i) ? lowest_(i) : highest_(i);
      if (to(i) >= lowest_(i) && to(i) <= highest_(i)) continue;
      const double part = (bound - from(i)) / (to(i) - from(i));
      if (part < least) {
        least = part;
        exit = {i, bound};
      }
    }
    return exit;
  }

  [[nodiscard]] std::optional<Node> end_at(const Node& last, const Node& next, int coordinate, double bound) const {
    const Vector3d from = place(last);
    const Vector3d to = place(next);
    const double part = std::clamp((bound - from(coordinate)) / (to(coordinate) - from(coordinate)), 0.0, 1.0);
    Vector3d guess = from + part * (to - from);
    double reach = (share(next) - share(last)).norm();
    if (coordinate == 0 && bound > 1.0) {  // walls move with the square of the angle from z = -1
      const Vector3d along = curve_.tangent(last).cwiseProduct(curve_.scales);
      guess = from + 0.5 * (std::numbers::pi - from(0)) / along(0) * along;
      reach = most_end_correction * (guess - from).cwiseQuotient(curve_.scales).norm();
    }
    guess(coordinate) = bound;
    const std::optional<Node> end = curve_.solve(node_at(guess), Vector3d::Unit(coordinate));
    // On the way, and not on another stretch.
    if (!end || (share(*end) - guess.cwiseQuotient(curve_.scales)).norm() > reach) return std::nullopt;
    Vector3d exact = place(*end);
    exact(coordinate) = coordinate > 0 || bound < 1.0 ? bound : std::numbers::pi;
    return node_at(exact);
  }

  // Adds what is no second tracing of another one, and no point: what is small in shares is known to few digits.
  void add(TwoRateChain chain, std::vector<TwoRateChain>& chains) {
    cover(chain);
    const auto near = [&](const Node& a, const Node& b) { return (share(a) - share(b)).norm() < same_point; };
    const Node& first = chain.nodes.front();
    const Node& last = chain.nodes.back();
    const auto ends_there = [&](const TwoRateChain& other) {
      const Node& front = other.nodes.front();
      const Node& back = other.nodes.back();
      return !other.is_closed && ((near(front, first) && near(back, last)) || (near(front, last) && near(back, first)));
    };
    if (!chain.is_closed && (near(first, last) || std::ranges::any_of(chains, ends_there))) return;
    // With one end alone in common a chain left its curve for another one, which shorter steps tell apart.
    const auto shares_end = [&](const TwoRateChain& other) {
      const std::array ends{other.nodes.front(), other.nodes.back()};
      return !other.is_closed &&
             std::ranges::any_of(ends, [&](const Node& end) { return near(end, first) || near(end, last); });
    };
    if (fineness_ == 1 && !chain.is_closed && std::ranges::any_of(chains, shares_end)) lose();
    chains.push_back(std::move(chain));
  }

  // The crossings of slices that the chain passes.
  void cover(const TwoRateChain& chain) {
    const Vector3d normal = Vector3d::Unit(curve_.is_damper_inside() ? 2 : 1);
    for (std::size_t i = 1; i < chain.nodes.size(); ++i) {
      const Node& a = chain.nodes[i - 1];
      const Node& b = chain.nodes[i];
      const auto [low, high] = std::minmax({curve_.inside(a.wall), curve_.inside(b.wall)});
      auto slice = std::ranges::lower_bound(slices_.slices, low, {}, &RegionSlice::inside);
      for (; slice != slices_.slices.end() && slice->inside <= high; ++slice) {
        const double part =
            high > low ? (slice->inside - curve_.inside(a.wall)) / (curve_.inside(b.wall) - curve_.inside(a.wall))
                       : 0.0;
        Node guess = node_at(place(a) + part * (place(b) - place(a)));
        guess.wall = curve_.wall(curve_.outside(guess.wall), slice->inside);
        const Node met = curve_.solve(guess, normal).value_or(guess);
        cover(static_cast<std::size_t>(slice - slices_.slices.begin()), met);
      }
    }
  }

  void cover(std::size_t slice, const Node& met) {
    const auto& crossings = slices_.slices[slice].found.crossings;
    double least = same_crossing;
    std::size_t nearest = crossings.size();
    for (std::size_t j = 0; j < crossings.size(); ++j) {
      const double apart = std::hypot(crossings[j].angle - met.angle,
                                      (crossings[j].gain - curve_.outside(met.wall)) / slices_.most_outside);
      if (covered_[slice][j] || apart > least) continue;
      least = apart;
      nearest = j;
    }
    if (nearest < crossings.size()) covered_[slice][nearest] = true;
  }

  // The curve of z = -1, whose gain outside is a function of the one inside, with poles.
  void add_nyquist(std::vector<TwoRateChain>& chains) const {
    const std::vector<double> places = places_inside(chains);
    std::vector<Node> all{nyquist_at(places.front())};
    for (std::size_t i = 1; i < places.size(); ++i) refine_nyquist(all, nyquist_at(places[i]), 0);
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool within = is_within(all[i]);
      if (within && nodes.empty() && i > 0) nodes.push_back(last_within(all[i], all[i - 1]));
      if (within) nodes.push_back(all[i]);
      if (!within && !nodes.empty()) nodes.push_back(last_within(all[i - 1], all[i]));
      if (nodes.size() > 1 && (!within || i + 1 == all.size())) chains.push_back({BoundaryKind::nyquist, nodes, false});
      if (!within) nodes.clear();
    }
  }

  [[nodiscard]] Node nyquist_at(double inside) const {
    return {std::numbers::pi, curve_.wall(curve_.nyquist_gain(inside), inside)};
  }
  [[nodiscard]] bool is_within(const Node& node) const {
    const double gain = curve_.outside(node.wall);
    return gain > 0.0 && gain < slices_.most_outside;
  }

  [[nodiscard]] Node last_within(Node in, Node out) const {
    for (int i = 0; i < most_halvings; ++i) {
      const Node middle = nyquist_at(0.5 * (curve_.inside(in.wall) + curve_.inside(out.wall)));
      (is_within(middle) ? in : out) = middle;
    }
    return in;
  }

  void refine_nyquist(std::vector<Node>& nodes, const Node& to, int depth) const {
    const Node from = nodes.back();
    const Node middle = nyquist_at(0.5 * (curve_.inside(from.wall) + curve_.inside(to.wall)));
    const auto cut = [&](const Node& node) {
      return std::clamp(curve_.outside(node.wall) / slices_.most_outside, -beyond_gains, 1.0 + beyond_gains);
    };
    if (depth < most_depth && std::abs(cut(middle) - 0.5 * (cut(from) + cut(to))) > straight) {
      refine_nyquist(nodes, middle, depth + 1);
      refine_nyquist(nodes, to, depth + 1);
      return;
    }
    nodes.push_back(to);
  }

  const TwoRateCurve& curve_;
  const RegionSlices& slices_;
  int fineness_;
  const Progress& progress_;
  Vector3d lowest_;
  Vector3d highest_;
  std::vector<std::vector<bool>> covered_;
};

}  // namespace

std::vector<TwoRateChain> trace_chains(const TwoRateCurve& curve, const RegionSlices& slices, int fineness,
                                       const Progress& progress) {
  return ChainTracer(curve, slices, fineness, progress).all();
}

}  // namespace zwidth::internal

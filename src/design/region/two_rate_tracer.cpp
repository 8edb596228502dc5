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
constexpr double most_turn = 0.15;         // rad
constexpr double most_correction = 0.2;    // of the step
constexpr double same_crossing = 1e-4;     // a chain meets a slice there
constexpr double closing = 0.1;            // of a step: the chain passes its own beginning
constexpr std::size_t most_nodes = 20000;  // of a chain
// Beside z = 1 and z = -1 the curve is known by its limits, of which these are a square away.
constexpr double least_angle = 1e-6;
constexpr double beside_nyquist = 1e-5;
// Of the curve of z = -1.
constexpr int most_halvings = 40;
constexpr double straight = 1e-3;
constexpr int most_depth = 12;
constexpr std::uintmax_t most_steps_to_end = 60;

[[noreturn]] void lose() { throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::outline_not_closed}); }

class ChainTracer {
 public:
  ChainTracer(const TwoRateCurve& curve, const RegionSlices& slices, const Progress& progress)
      : curve_(curve), slices_(slices), progress_(progress) {
    const WallPoint most = curve.wall(slices.most_outside, slices.most_inside);
    lowest_ = {least_angle, 0.0, 0.0};
    highest_ = {std::numbers::pi - beside_nyquist, most.stiffness, most.damping};
    for (const RegionSlice& slice : slices.slices) covered_.emplace_back(slice.found.crossings.size(), false);
  }

  [[nodiscard]] std::vector<TwoRateChain> all() {
    std::vector<TwoRateChain> chains;
    for (std::size_t i = 0; i < slices_.slices.size(); ++i) {
      const RegionSlice& slice = slices_.slices[i];
      for (std::size_t j = 0; j < slice.found.crossings.size(); ++j) {
        const GainCrossing& seed = slice.found.crossings[j];
        const bool inside = seed.angle > lowest_(0) && seed.angle < highest_(0) && seed.gain < slices_.most_outside &&
                            slice.inside < slices_.most_inside;
        if (!inside || covered_[i][j]) continue;
        covered_[i][j] = true;
        // A crossing that only touches the circle is passed by others.
        if (seed.poles_leaving == 0) continue;
        chains.push_back(through({seed.angle, curve_.wall(seed.gain, slice.inside)}));
        cover(chains.back());
        tell(progress_, static_cast<double>(i) / static_cast<double>(slices_.slices.size()));
      }
    }
    for (const Node& seed : ends_on_lines()) {
      const auto has_it = [&](const TwoRateChain& chain) {
        return std::ranges::any_of(std::array{chain.nodes.front(), chain.nodes.back()},
                                   [&](const Node& end) { return (share(end) - share(seed)).norm() < same_crossing; });
      };
      if (std::ranges::any_of(chains, has_it)) continue;
      chains.push_back(through(seed));
      cover(chains.back());
    }
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
  static Vector3d place(const Node& node) { return {node.angle, node.wall.stiffness, node.wall.damping}; }
  static Node node_at(const Vector3d& place) { return {place(0), {place(1), place(2)}}; }
  [[nodiscard]] Vector3d share(const Node& node) const { return place(node).cwiseQuotient(curve_.scales); }

  // Where the curve begins with nothing outside, and where it ends at z = -1: between two slices there may be no more of it.
  [[nodiscard]] std::vector<Node> ends_on_lines() const {
    std::vector<Node> seeds;
    const auto add = [&](double angle, double outside, double inside) {
      if (angle > lowest_(0) && angle <= highest_(0) && outside < slices_.most_outside) {
        seeds.push_back({angle, curve_.wall(outside, inside)});
      }
    };
    for (const GainCrossing& each : curve_.crossings_alone().crossings) {
      if (each.gain < slices_.most_inside && each.poles_leaving != 0)
        add(curve_.seen_angle(each.angle), 0.0, each.gain);
    }
    const double angle = highest_(0);
    const auto phase = [&](double inside) { return curve_.phase(angle, inside); };
    double before = 0.0;
    for (std::size_t i = 0; i < slices_.slices.size(); ++i) {
      const double inside = slices_.slices[i].inside;
      if (inside > slices_.most_inside) break;
      const double here = phase(inside);
      if (i > 0 && before * here < 0.0) {
        std::uintmax_t steps = most_steps_to_end;
        const auto [low, high] =
            boost::math::tools::toms748_solve(phase, slices_.slices[i - 1].inside, inside, before, here,
                                              boost::math::tools::eps_tolerance<double>(45), steps);
        const double middle = 0.5 * (low + high);
        if (const double gain = curve_.gain(angle, middle); gain > 0.0) add(angle, gain, middle);
      }
      before = here;
    }
    return seeds;
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
    double step = first_step;
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
      if (straighter) step = std::min(1.5 * step, longest_step);
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
    guess(coordinate) = bound;
    const std::optional<Node> end = curve_.solve(node_at(guess), Vector3d::Unit(coordinate));
    if (!end) return std::nullopt;
    // On the way, and not on another stretch.
    if ((share(*end) - guess.cwiseQuotient(curve_.scales)).norm() > (share(next) - share(last)).norm()) {
      return std::nullopt;
    }
    Vector3d exact = place(*end);
    exact(coordinate) = coordinate > 0 || bound < 1.0 ? bound : std::numbers::pi;
    return node_at(exact);
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

  // The curve of z = -1, whose gain outside is a function of the one inside.
  void add_nyquist(std::vector<TwoRateChain>& chains) const {
    std::vector<double> places{0.0};
    for (const RegionSlice& slice : slices_.slices) {
      if (slice.inside < slices_.most_inside) places.push_back(slice.inside);
    }
    places.push_back(slices_.most_inside);
    const auto is_within = [&](double gain) { return gain > 0.0 && gain < slices_.most_outside; };
    std::vector<Node> nodes;
    const auto node = [&](double inside) {
      return Node{std::numbers::pi, curve_.wall(curve_.nyquist_gain(inside), inside)};
    };
    const auto finish = [&] {
      if (nodes.size() > 1) chains.push_back({BoundaryKind::nyquist, nodes, false});
      nodes.clear();
    };
    // The last place within, from one that is to one that is not.
    const auto end_between = [&](double in, double out) {
      for (int i = 0; i < most_halvings; ++i) {
        const double middle = 0.5 * (in + out);
        (is_within(curve_.nyquist_gain(middle)) ? in : out) = middle;
      }
      return node(in);
    };
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Node here = node(places[i]);
      const bool within = is_within(curve_.outside(here.wall));
      if (within && nodes.empty() && i > 0) nodes.push_back(end_between(places[i], places[i - 1]));
      if (within) {
        if (!nodes.empty())
          refine_nyquist(nodes, here, 0);
        else
          nodes.push_back(here);
      } else if (!nodes.empty()) {
        const Node end = end_between(places[i - 1], places[i]);
        refine_nyquist(nodes, end, 0);
        finish();
      }
    }
    finish();
  }

  void refine_nyquist(std::vector<Node>& nodes, const Node& to, int depth) const {
    const Node from = nodes.back();
    const double inside = 0.5 * (curve_.inside(from.wall) + curve_.inside(to.wall));
    const double gain = curve_.nyquist_gain(inside);
    const double chord = 0.5 * (curve_.outside(from.wall) + curve_.outside(to.wall));
    if (depth < most_depth && std::abs(gain - chord) > straight * slices_.most_outside) {
      refine_nyquist(nodes, {std::numbers::pi, curve_.wall(gain, inside)}, depth + 1);
      refine_nyquist(nodes, to, depth + 1);
      return;
    }
    nodes.push_back(to);
  }

  const TwoRateCurve& curve_;
  const RegionSlices& slices_;
  const Progress& progress_;
  Vector3d lowest_;
  Vector3d highest_;
  std::vector<std::vector<bool>> covered_;
};

}  // namespace

std::vector<TwoRateChain> trace_chains(const TwoRateCurve& curve, const RegionSlices& slices,
                                       const Progress& progress) {
  return ChainTracer(curve, slices, progress).all();
}

}  // namespace zwidth::internal

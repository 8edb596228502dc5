#include "identification/friction_fit.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace zwidth::internal {
namespace {

constexpr ShotFitOptions thorough{.most_iterations = 40, .tolerance = 1e-6};

}  // namespace

std::optional<FittedShots> with_held_friction(const Follower& follower, ShotFit start, Eigen::Index friction,
                                              double value, const std::vector<ShotNoise>& noise) {
  const auto& [model, search, shots] = follower;
  const Eigen::VectorXd towards = start.x;
  start.x(friction) = value;
  start.held.assign(static_cast<std::size_t>(start.x.size()), false);
  start.held[static_cast<std::size_t>(friction)] = true;
  const auto fit = fit_shots(model, shots, noise, std::move(start), towards, thorough);
  if (!fit) return std::nullopt;
  return search.with_noise(*fit, shots, towards, thorough);
}

std::optional<FittedShots> best_from(const Follower& follower, const std::vector<SearchStart>& starts,
                                     const std::vector<Shot>& short_shots) {
  const auto& [model, search, shots] = follower;
  auto ends = search.from_each(starts, shots);
  const auto of_short = search.from_each(starts, short_shots);
  std::vector<SearchStart> next;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (of_short[i]) next.push_back({of_short[i]->fitted.fit.x, starts[i].handicap});
  }
  std::ranges::move(search.from_each(next, shots), std::back_inserter(ends));
  const std::optional<FittedShots> best = least_bad(std::move(ends));
  return best ? search.with_noise(best->fit, shots, best->fit.x, thorough) : std::nullopt;
}

std::optional<FrictionFit> with_free_friction(const Follower& follower, const FittedShots& held,
                                              double linear_badness) {
  const auto& [model, search, shots] = follower;
  ShotFit start = held.fit;
  start.held.assign(start.held.size(), false);
  auto found = search.with_noise(start, shots, start.x, thorough);
  if (!found) return std::nullopt;
  const double badness = search.badness(*found, shots);
  return FrictionFit{*std::move(found), badness, linear_badness};
}

std::optional<FrictionFit> beside_linear(const Follower& follower, FittedShots best, const Eigen::VectorXd& linear,
                                         Eigen::Index friction) {
  const auto& [model, search, shots] = follower;
  const auto alone = search.with_fitted_states(linear, shots, best.noise, ShotSearch::Constants::fitted);
  if (!alone) return std::nullopt;
  auto without = with_held_friction(follower, *alone, friction, 0.0, best.noise);
  if (!without) return std::nullopt;
  const double badness = search.badness(best, shots);
  FrictionFit found{std::move(best), badness, search.badness(*without, shots)};
  if (found.gain() > as_much) return found;
  return with_free_friction(follower, *without, found.linear_badness);
}

}  // namespace zwidth::internal

#include "identification/shot_search.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "zwidth/error.hpp"

namespace zwidth::internal {

std::vector<Shot> cut_into_shots(const std::vector<MotionRecord>& records, const Device& device, double length,
                                 std::size_t least) {
  std::vector<Shot> shots;
  for (std::size_t r = 0; r < records.size(); ++r) {
    const MotionRecord& record = records[r];
    constexpr double settled = 5.0;  // time constants
    constexpr double most_skipped = 0.1;
    const double late = 2.0 * device.loop().delay + settled * device.parameters().actuator.time_constant;
    const auto size = static_cast<double>(record.force.size());
    const auto skip = static_cast<std::size_t>(std::min(most_skipped * size, late / record.sampling_period + 2.0));
    const std::size_t left = record.force.size() - skip;
    const auto wanted = std::max(static_cast<double>(least), length / record.sampling_period);
    const auto count = static_cast<std::size_t>(std::max(1.0, std::floor(static_cast<double>(left) / wanted + 0.5)));
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t begin = skip + left * i / count;
      shots.push_back({r, begin, skip + left * (i + 1) / count - begin});
    }
  }
  return shots;
}

std::vector<Shot> some_of(const std::vector<Shot>& shots, std::size_t records, std::size_t each) {
  std::vector<Shot> some;
  for (std::size_t r = 0; r < records; ++r) {
    std::vector<Shot> own;
    std::ranges::copy_if(shots, std::back_inserter(own), [&](const Shot& shot) { return shot.record == r; });
    const std::size_t count = std::min(each, own.size());
    for (std::size_t i = 0; i < count; ++i) some.push_back(own[(2 * i + 1) * own.size() / (2 * count)]);
  }
  return some;
}

std::optional<FittedShots> least_bad(std::vector<std::optional<SearchEnd>> ends) {
  std::erase_if(ends, [](const auto& end) { return !end; });
  const auto best = std::ranges::min_element(ends, {}, [](const auto& end) { return end->badness; });
  if (best == ends.end()) return std::nullopt;
  return std::move((*best)->fitted);
}

std::vector<std::optional<SearchEnd>> ShotSearch::from_each(const std::vector<SearchStart>& starts,
                                                            const std::vector<Shot>& shots) const {
  constexpr std::array ways{From::recorded_states, From::fitted_states};
  std::vector<std::optional<SearchEnd>> all(starts.size() * ways.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    const SearchStart& start = starts[i / ways.size()];
    const ShotModel model = model_;  // it keeps the motions that it played last
    const ShotSearch search(model, steps_, order_);
    auto found = search.from(start.x, shots, ways[i % ways.size()]);
    if (!found) return;
    const double badness = search.badness(*found, shots) + start.handicap;
    all[i] = SearchEnd{*std::move(found), badness};
  });
  std::vector<std::optional<SearchEnd>> ends(starts.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::optional<SearchEnd>& end = ends[i / ways.size()];
    if (all[i] && (!end || all[i]->badness < end->badness)) end = std::move(all[i]);
  }
  return ends;
}

std::optional<FittedShots> ShotSearch::from(const Eigen::VectorXd& x, const std::vector<Shot>& shots, From from) const {
  // Friction in the place of damping changes slow motion, which white noise weighs most: masses and links would follow it.
  ShotFit start{x, model_.recorded_states(shots), std::vector<bool>(static_cast<std::size_t>(x.size()), false)};
  for (std::size_t i = 0; i < model_.coordinates().size(); ++i) {
    const std::string& key = model_.coordinates()[i].key;
    const bool is_of_friction = key.starts_with("body.") && (key.ends_with(".coulomb") || key.ends_with(".damping"));
    start.held[i] = !is_of_friction;
  }
  std::vector<ShotNoise> white(steps_.size());
  for (std::size_t r = 0; r < steps_.size(); ++r) {
    const auto& position = model_.records()[r].position;
    double squares = 0.0;
    for (std::size_t k = 1; k < position.size(); ++k) squares += std::pow(position[k] - position[k - 1], 2);
    white[r].deviation = std::sqrt(squares / static_cast<double>(position.size())) + 1e-300;
  }
  if (from == From::fitted_states) {
    auto fitted = with_fitted_states(x, shots, white, Constants::fitted);
    if (!fitted) return std::nullopt;
    start.x = std::move(fitted->x);
    start.states = std::move(fitted->states);
  }
  constexpr int few = 8;
  constexpr double coarse = 1e-3;
  auto rough = fit_shots(model_, shots, white, start, x, {few, coarse});
  if (!rough) return std::nullopt;
  rough->held.assign(rough->held.size(), false);
  return with_noise(*rough, shots, x, {few, 1e-3});
}

std::optional<FittedShots> ShotSearch::with_noise(const ShotFit& start, const std::vector<Shot>& shots,
                                                  const Eigen::VectorXd& towards, const ShotFitOptions& options) const {
  const auto residuals = shot_residuals(model_, shots, start.x, start.states);
  if (!residuals) return std::nullopt;
  std::vector<ShotNoise> noise = shot_noise(shots, *residuals, steps_, order_);
  auto fit = fit_shots(model_, shots, noise, start, towards, options);
  if (!fit) return std::nullopt;
  return FittedShots{*std::move(fit), std::move(noise)};
}

std::optional<ShotFit> ShotSearch::with_fitted_states(const Eigen::VectorXd& x, const std::vector<Shot>& shots,
                                                      const std::vector<ShotNoise>& noise, Constants constants) const
    try {
  const auto records = static_cast<Eigen::Index>(model_.records().size());
  const Eigen::VectorXd own = x.tail(records);
  const std::vector<bool> held(model_.records().size(), constants == Constants::held);
  auto fit = fit_shots(model_.at(x), shots, noise, {own, model_.recorded_states(shots), held}, own,
                       {.most_iterations = 20, .tolerance = 1e-4});
  if (!fit) return std::nullopt;
  ShotFit found{x, std::move(fit->states)};
  found.x.tail(records) = fit->x;
  return found;
} catch (const Error&) {  // no device has these numbers
  return std::nullopt;
}

double ShotSearch::restart_states(ShotFit& fit, const std::vector<Shot>& shots,
                                  const std::vector<ShotNoise>& noise) const {
  const auto again = with_fitted_states(fit.x, shots, noise, Constants::held);
  if (!again) return 0.0;
  const auto before = shot_residuals(model_, shots, fit.x, fit.states);
  const auto after = shot_residuals(model_, shots, fit.x, again->states);
  if (!before || !after) return 0.0;
  double gain = 0.0;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const auto misfit = [&](const ShotPositions& of) { return whitened(noise[shots[i].record], of[i]).squaredNorm(); };
    const double fall = misfit(*before) - misfit(*after);
    if (!(fall > 0.0)) continue;
    gain += 0.5 * fall;
    fit.states[i] = again->states[i];
  }
  return gain;
}

double ShotSearch::badness(const FittedShots& fitted, const std::vector<Shot>& shots) const {
  const auto residuals = shot_residuals(model_, shots, fitted.fit.x, fitted.fit.states);
  if (!residuals) return std::numeric_limits<double>::infinity();
  const std::vector<ShotNoise> noise = shot_noise(shots, *residuals, steps_, order_);
  double sum = 0.0;
  for (const Shot& shot : shots) sum += static_cast<double>(shot.count) * std::log(noise[shot.record].deviation);
  return sum;
}

}  // namespace zwidth::internal

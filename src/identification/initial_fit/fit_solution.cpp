#include "identification/initial_fit/fit_solution.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <utility>

#include "identification/initial_fit/fit_weights.hpp"
#include "identification/initial_fit/identifiability.hpp"
#include "identification/initial_fit/initial_values.hpp"
#include "identification/initial_fit/link_mode.hpp"
#include "identification/initial_fit/response_features.hpp"
#include "model/loop_keys.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

constexpr std::size_t points_for_starts = 40;
constexpr std::size_t points_for_search = 120;
// Nepers: a logarithmic fit as close as this on average has found its minimum.
constexpr double close_start = 0.1;
constexpr LeastSquaresOptions rough_fit{
    .misfit = Misfit::logarithmic, .robust_threshold = 0.5, .most_iterations = 30, .tolerance = 1e-3};

/// A fit of the logarithm from each initial position, until one comes close.
std::vector<LeastSquares> logarithmic_fits(const FitModel& model, const std::vector<ResponsePoint>& points,
                                           const ResponseFeatures& features) {
  const FitData data = fit_data(points, 0.0);
  std::vector<LeastSquares> fits;
  for (const Eigen::VectorXd& start : initial_positions(model, points, features)) {
    fits.push_back(least_squares(model, data, start, rough_fit));
    const double mean_square = 2.0 * fits.back().cost / static_cast<double>(points.size());
    if (mean_square < close_start * close_start) break;
  }
  std::ranges::stable_sort(fits, {}, &LeastSquares::cost);
  return fits;
}

Error no_convergence() { return {ErrorCode::did_not_converge, Problem{.code = ProblemCode::structure_never_fits}}; }

/// What the fit at x leaves of each point, over the deviations that go with a model error.
std::vector<std::complex<double>> left_by(const FitModel& model, const std::vector<ResponsePoint>& points,
                                          const Eigen::VectorXd& x, double model_error) {
  const FitData data = fit_data(points, model_error);
  const Eigen::VectorXcd values = model.response_at(x, data.frequencies);
  std::vector<std::complex<double>> left(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    left[i] = (data.measured[i] - values(static_cast<Eigen::Index>(i))) / data.deviations[i];
  }
  return left;
}

/// Mean square of that, each point's share bounded.
double mean_misfit(const FitModel& model, const std::vector<ResponsePoint>& points, const Eigen::VectorXd& x,
                   double model_error) {
  constexpr double most = 100.0;
  double sum = 0.0;
  for (const std::complex<double>& each : left_by(model, points, x, model_error)) {
    const double square = std::norm(each);
    sum += std::isfinite(square) ? std::min(square, most) : most;
  }
  return sum / static_cast<double>(points.size());
}

/// Whether what is left of neighbouring lines is alike, which a search that ended at the device does not leave, however
/// little it is: the mean correlation of lines 3 to 8 apart, further than a window makes them share, beyond three of its
/// deviations.
bool are_alike(const std::vector<std::complex<double>>& left, double line_correlation) {
  constexpr std::size_t nearest = 3;
  constexpr std::size_t farthest = 8;
  constexpr double clear = 3.0;
  const auto lines = static_cast<double>(left.size());
  double squares = 0.0;
  for (const std::complex<double>& each : left) squares += std::norm(each);
  double products = 0.0;
  for (std::size_t apart = nearest; apart <= farthest; ++apart) {
    for (std::size_t i = apart; i < left.size(); ++i) products += std::real(left[i] * std::conj(left[i - apart]));
  }
  constexpr auto means = static_cast<double>(farthest - nearest + 1);
  return products / means > clear * squares * std::sqrt(line_correlation / (2.0 * means * lines));
}

/// The best of a solution and those reached from different positions, as it shows at some of the points.
Solution searched_from(const ResponseFeatures& features, const std::vector<ResponsePoint>& some, const FitModel& model,
                       const std::vector<ResponsePoint>& points, Solution found, double robust_threshold) {
  constexpr std::size_t most_starts = 12;
  constexpr std::size_t most_solved = 2;
  constexpr int most_iterations = 80;
  constexpr double promising = 0.95;  // of the cost at some of the points
  const LeastSquaresOptions weighted{
      .robust_threshold = robust_threshold, .most_iterations = most_iterations, .tolerance = 1e-4};
  const FitData data = fit_data(some, found.model_error);
  const LeastSquares own = least_squares(model, data, found.x, weighted);
  const std::vector<Eigen::VectorXd> positions = different_positions(model, some, features, most_starts);
  std::vector<LeastSquares> fits(positions.size());
  tbb::parallel_for(std::size_t{0}, positions.size(), [&](std::size_t i) {
    const Eigen::VectorXd& x = positions[i];
    // Unpulled a body that moves as one with the next would vanish.
    const LeastSquares near = least_squares(model, fit_data(some, 0.0), x, rough_fit, start_at(model, x).pull);
    fits[i] = least_squares(model, data, near.x, weighted, start_at(model, near.x).pull);
  });
  std::erase_if(fits,
                [&](const LeastSquares& fit) { return !fit.x.allFinite() || !(fit.cost < promising * own.cost); });
  if (fits.empty()) return found;
  std::ranges::stable_sort(fits, {}, &LeastSquares::cost);
  std::vector<Start> starts{{found.x, found.pull}};
  for (std::size_t i = 0; i < std::min(most_solved, fits.size()); ++i) starts.push_back(start_at(model, fits[i].x));
  return solve(model, points, starts, robust_threshold);
}

/// From one position of a coordinate to another, in equal ratios of its value.
double part_of_the_way(const Coordinate& coordinate, double from, double to, double share) {
  if (coordinate.kind == Coordinate::Kind::logarithmic) return from + share * (to - from);
  constexpr double least = 1e-12;
  return std::max(from, least) * std::pow(std::max(to, least) / std::max(from, least), share);
}

}  // namespace

Start start_at(const FitModel& model, const Eigen::VectorXd& x) {
  return start_at(model, x, x, std::vector<bool>(static_cast<std::size_t>(x.size()), true));
}

Start start_at(const FitModel& model, const Eigen::VectorXd& x, const Eigen::VectorXd& towards,
               const std::vector<bool>& determined) {
  Start start{x, {x, Eigen::VectorXd::Zero(x.size())}};
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool is_logarithmic = model.coordinates()[k].kind == Coordinate::Kind::logarithmic;
    if (is_logarithmic || !determined[k]) start.pull.strength(i) = known_beforehand;
    if (!determined[k]) start.pull.towards(i) = towards(i);
  }
  return start;
}

std::vector<Start> starts_near(const FitModel& model, const Eigen::VectorXd& x, double highest) {
  std::vector<std::string> keys;
  for (const Coordinate& coordinate : model.coordinates()) keys.push_back(coordinate.key);
  std::vector<Eigen::VectorXd> positions{x};
  constexpr double above = 2.0;
  if (const auto springs = with_springs(model.parameters_at(x), keys, above * highest)) {
    positions.push_back(model.position_of(*springs));
  }
  const Eigen::Index delay = std::ranges::find(keys, key_of_delay) - keys.begin();
  const Eigen::Index lag = std::ranges::find(keys, key_of_lag) - keys.begin();
  std::vector<Start> starts;
  for (const Eigen::VectorXd& each : positions) {
    starts.push_back(start_at(model, each));
    if (delay == x.size() || lag == x.size()) continue;
    Eigen::VectorXd shared = each;
    shared(delay) = shared(lag) = 0.5 * (x(delay) + x(lag));  // of the same unit
    starts.push_back(start_at(model, shared));
  }
  return starts;
}

std::vector<Start> promising_starts(const FitModel& model, const std::vector<ResponsePoint>& points) {
  std::vector<ResponsePoint> clear;  // those that the noise does not drown
  for (const ResponsePoint& point : points) {
    if (point.variance < 0.1 * std::norm(point.value)) clear.push_back(point);
  }
  if (clear.size() < 10) clear = points;
  const ResponseFeatures features = response_features(clear);
  const std::vector<ResponsePoint> some = thinned(clear, features, points_for_starts);
  const std::vector<LeastSquares> fits = logarithmic_fits(model, some, features);
  std::vector<Start> starts;
  for (const LeastSquares& fit : fits) {
    const bool is_new = std::ranges::none_of(
        starts, [&](const Start& other) { return (fit.x - other.x).lpNorm<Eigen::Infinity>() < 0.2; });
    if (starts.empty() || (is_new && fit.cost < 2.0 * fits.front().cost)) starts.push_back(start_at(model, fit.x));
    if (starts.size() == 2) break;
  }
  return starts;
}

Solution solve(const FitModel& model, const std::vector<ResponsePoint>& points, const std::vector<Start>& starts,
               double robust_threshold) {
  constexpr int most_rounds = 6;
  constexpr double close_enough = 0.05;
  const LeastSquaresOptions options{Misfit::weighted, robust_threshold, 200};
  const FitData all = fit_data(points, 0.0);
  LeastSquaresOptions rough = options;
  rough.tolerance = 1e-5;
  Solution best;
  best.model_error = std::numeric_limits<double>::infinity();
  double best_misfit = best.model_error;
  std::vector<LeastSquares> fits(starts.size());
  std::vector<double> errors(starts.size());
  tbb::parallel_for(std::size_t{0}, starts.size(), [&](std::size_t i) {
    // Weighted by what a start is off, lines tell little.
    constexpr int rough_rounds = 3;
    fits[i].x = starts[i].x;
    double error = model_error_of(points, model.response_at(fits[i].x, all.frequencies));
    for (int round = 0; round < rough_rounds; ++round) {
      fits[i] = least_squares(model, fit_data(points, error), fits[i].x, rough, starts[i].pull);
      errors[i] = model_error_of(points, model.response_at(fits[i].x, all.frequencies));
      if (std::abs(errors[i] - error) <= close_enough * errors[i]) break;
      error = errors[i];
    }
  });
  for (std::size_t i = 0; i < starts.size(); ++i) {  // the one that explains the data best
    if (!fits[i].x.allFinite()) continue;
    const double misfit = mean_misfit(model, points, fits[i].x, errors[i]);
    if (std::pair(errors[i], misfit) < std::pair(best.model_error, best_misfit)) {
      best = {fits[i].x, errors[i], starts[i].pull, fits[i].converged};
      best_misfit = misfit;
    }
  }
  if (best.x.size() == 0) throw no_convergence();
  for (int round = 0; round < most_rounds; ++round) {
    const LeastSquares fit = least_squares(model, fit_data(points, best.model_error), best.x, options, best.pull);
    if (!fit.x.allFinite()) throw no_convergence();
    best.settled = fit.converged;
    const double error = model_error_of(points, model.response_at(fit.x, all.frequencies));
    const bool is_done = std::abs(error - best.model_error) <= close_enough * error;
    best.x = fit.x;
    if (!is_done) best.model_error = error;
    if (is_done) break;
  }
  return best;
}

Solution searched_widely(const FitModel& model, const FrequencyResponse& response, Solution found,
                         double robust_threshold) {
  const std::vector<ResponsePoint>& points = response.points;
  constexpr double poor = 1.5;  // mean square of the residuals, in variances of the noise
  const bool is_noise_known = std::ranges::all_of(points, [](const ResponsePoint& p) { return p.variance > 0.0; });
  if (!is_noise_known) return found;
  const bool is_explained = mean_misfit(model, points, found.x, 0.0) < poor &&
                            !are_alike(left_by(model, points, found.x, 0.0), response.line_correlation);
  if (is_explained) return found;
  const ResponseFeatures features = response_features(points);
  return searched_from(features, thinned(points, features, points_for_search), model, points, std::move(found),
                       robust_threshold);
}

Solution searched_near(const std::vector<double>& modes, const FitModel& model,
                       const std::vector<ResponsePoint>& points, Solution found, double robust_threshold) {
  ResponseFeatures features = response_features(points);
  std::vector<ResponsePoint> some = thinned(points, features, points_for_starts);
  features.resonances = modes;
  features.antiresonances.clear();
  features.has_all_modes = true;
  for (const ResponsePoint& point : points) {  // a mode that was passed over is narrow
    constexpr double near = 0.05;
    const bool shows_a_mode =
        std::ranges::any_of(modes, [&](double mode) { return std::abs(point.frequency - mode) < near * mode; });
    if (shows_a_mode) some.push_back(point);
  }
  std::ranges::sort(some, {}, &ResponsePoint::frequency);
  const auto is_same = [](const ResponsePoint& a, const ResponsePoint& b) { return a.frequency == b.frequency; };
  some.erase(std::unique(some.begin(), some.end(), is_same), some.end());
  return searched_from(features, some, model, points, std::move(found), robust_threshold);
}

Solution drawn_back(const FitModel& model, const std::vector<ResponsePoint>& points, const Solution& solution,
                    const Eigen::VectorXd& towards, const std::vector<bool>& determined, double robust_threshold) {
  constexpr double allowed = 1.02;  // growth of the mean square
  const Start start = start_at(model, solution.x, towards, determined);
  Solution drawn = solve(model, points, {start}, robust_threshold);
  const double most = allowed * mean_misfit(model, points, solution.x, solution.model_error);
  const auto explains = [&](const Eigen::VectorXd& x) {
    return mean_misfit(model, points, x, solution.model_error) <= most;
  };
  if (explains(drawn.x)) return drawn;
  // All at once they pull the others off: one after the other, the others standing still.
  drawn = solution;
  for (Eigen::Index i = 0; i < towards.size(); ++i) {
    if (determined[static_cast<std::size_t>(i)]) continue;
    constexpr double shares[] = {1.0, 0.9, 0.7, 0.5};
    for (const double share : shares) {
      Eigen::VectorXd x = drawn.x;
      x(i) = part_of_the_way(model.coordinates()[static_cast<std::size_t>(i)], x(i), towards(i), share);
      if (!explains(x)) continue;
      drawn.x = x;
      break;
    }
  }
  return drawn;
}

}  // namespace zwidth::internal

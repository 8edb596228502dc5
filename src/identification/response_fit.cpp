#include "identification/response_fit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "identification/evidence/given_numbers.hpp"
#include "identification/evidence/likelihood.hpp"
#include "identification/evidence/limit_evidence.hpp"
#include "identification/evidence/response_evidence.hpp"
#include "identification/optimiser/minimise.hpp"
#include "identification/response_start.hpp"
#include "identification/verdict/confidence.hpp"
#include "identification/verdict/line_bands.hpp"
#include "identification/verdict/log_critical_stiffness.hpp"
#include "identification/verdict/profile.hpp"
#include "linear_systems.hpp"
#include "zwidth/identification/parameter_fit.hpp"

namespace zwidth::internal {
namespace {

/// Of the numbers, others refitted; 0 for those that a bound holds, which the fit does not move.
Eigen::MatrixXd moved_covariance(const LeastSquaresProblem& problem, const Minimum& best, Eigen::Index count) {
  constexpr double near = 1e-9;
  const Eigen::VectorXd bounds = problem.lowest();
  Eigen::MatrixXd hessian = best.picture.hessian;
  std::vector<Eigen::Index> held;
  for (Eigen::Index i = 0; i < hessian.rows(); ++i) {
    if (best.z(i) > bounds(i) + near) continue;
    hessian.row(i).setZero();
    hessian.col(i).setZero();
    hessian(i, i) = 1.0;
    held.push_back(i);
  }
  Eigen::MatrixXd covariance = inverse(hessian);
  for (const Eigen::Index i : held) covariance(i, i) = 0.0;
  return covariance.topLeftCorner(count, count);
}

}  // namespace

std::optional<ResponseFit> fit_response(const ResponseFitSetting& setting) {
  constexpr MinimiseOptions fine{.most_steps = 60, .least_gain = 1e-4};
  if (!setting.response && setting.limits.empty()) return std::nullopt;
  if (!setting.response && !setting.known && frees_all(setting.free)) return std::nullopt;
  const ResponseStart start = setting.response ? start_of_response(setting) : start_of_limits(setting);
  if (start.numbers.empty()) return std::nullopt;
  const DeviceFamily family(start.device, start.numbers, setting.locked);
  std::vector<std::shared_ptr<const LikelihoodTerm>> terms;
  std::shared_ptr<ResponseEvidence> lines;
  if (setting.response) terms.push_back(lines = std::make_shared<ResponseEvidence>(family, *setting.response));
  const std::vector<MeasuredLimit> walls(setting.limits.begin(), setting.limits.end());
  const auto limits = std::make_shared<LimitEvidence>(family, walls);
  if (!walls.empty()) terms.push_back(limits);
  if (start.given)
    terms.push_back(std::make_shared<GivenNumbers>(family, setting.structure.parameters(), *start.given));
  const Likelihood likelihood(family.numbers(), terms);

  const auto limit = [&](const Eigen::VectorXd& z) { return log_critical_stiffness(family.device_at(z)); };
  std::optional<Minimum> best = minimise(likelihood, likelihood.start(family.coordinates_of(start.device)), fine);
  if (!best) return std::nullopt;
  const double shared = setting.response ? shared_noise(*setting.response) : 1.0;
  const auto range = profile_range(
      likelihood, *best, [&](const Minimum&) { return std::optional<LogOf>(limit); }, family.of_device(),
      rise_of_95 * shared, fine);
  if (!range) return std::nullopt;

  const auto count = static_cast<Eigen::Index>(start.numbers.size());
  ResponseFit found{family.device_at(best->z), family.numbers(), best->z.head(count), {}, {}};
  const Eigen::VectorXd slope = slope_of(limit, best->z, family.of_device(), likelihood.lowest());
  found.slope = slope.head(count);
  found.rivals = start.rivals;
  SumOfSquares left;
  if (lines) {
    const Eigen::MatrixXd moved = moved_covariance(likelihood, *best, count);
    left = squares_of_bands(family, *lines, *setting.response, best->z, moved);
  }
  if (!walls.empty()) {
    // Of limits alone all that is fitted has a prior, which gives way: together they are as many squares as there are limits.
    left.sum += lines ? 2.0 * limits->cost(found.x, {}).value_or(0.0) : 2.0 * best->picture.cost;
    for (const MeasuredLimit& each : walls) left.freedom += each.frequency_hz ? 2.0 : 1.0;
  }
  found.covariance = shared * inverse(best->picture.hessian).topLeftCorner(count, count);
  // Neighbouring lines that are off together are fewer than they count.
  const double together = left.freedom > 0.0 ? std::sqrt(std::max(1.0, left.sum / left.freedom)) : 1.0;
  found.covariance *= together * together;
  found.lower = std::exp(range->middle - together * (range->middle - range->low.value));
  found.value = std::exp(range->middle);
  found.upper = std::exp(range->middle + together * (range->high.value - range->middle));
  found.last_change = std::max({last_change(*best, slope), range->low.last_change, range->high.last_change});
  found.omnibus = omnibus_of_lines(left);
  return found;
}

}  // namespace zwidth::internal

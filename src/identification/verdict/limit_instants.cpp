#include "identification/verdict/limit_instants.hpp"

#include <Eigen/Core>
#include <algorithm>

#include "identification/verdict/confidence.hpp"
#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

constexpr double half = 0.5;

/// Of one drift: `log_limit` of coordinates and its instant.
std::optional<double> limit_instant(
    const std::function<std::optional<double>(const Eigen::VectorXd&, double)>& log_limit, const Minimum& minimum,
    Eigen::Index first, Eigen::Index last) {
  constexpr double step = 1e-3;
  const std::optional<double> begin = log_limit(minimum.z, 0.0);
  const std::optional<double> middle = log_limit(minimum.z, half);
  const std::optional<double> end = log_limit(minimum.z, 1.0);
  if (!begin || !middle || !end) return std::nullopt;
  const double softer = *begin < *end ? 0.0 : 1.0;
  const double fall = *middle - std::min(*begin, *end);
  if (last <= first || fall <= 0.0) return half;
  Eigen::VectorXd by = Eigen::VectorXd::Zero(minimum.z.size());
  for (Eigen::Index i = first; i < last; ++i) {
    const auto fall_at = [&](double change) {
      Eigen::VectorXd z = minimum.z;
      z(i) += change;
      return log_limit(z, half).value_or(*middle) - log_limit(z, softer).value_or(*middle - fall);
    };
    by(i) = (fall_at(step) - fall_at(-step)) / (2.0 * step);
  }
  const double variance = by.dot(solve_symmetric(minimum.picture.hessian, by));
  return half + std::max(0.0, 1.0 - chi_squared_of_95 * variance / (fall * fall)) * (softer - half);
}

}  // namespace

std::optional<DriftInstants> limit_instants(
    const std::function<std::optional<double>(const Eigen::VectorXd&, const DriftInstants&)>& log_limit,
    const Minimum& minimum, Eigen::Index first, Eigen::Index last) {
  DriftInstants instants;
  for (double DriftInstants::*drift : {&DriftInstants::damping, &DriftInstants::delay}) {
    const auto of_drift = [&](const Eigen::VectorXd& z, double instant) {
      DriftInstants at;
      at.*drift = instant;
      return log_limit(z, at);
    };
    const std::optional<double> instant = limit_instant(of_drift, minimum, first, last);
    if (!instant) return std::nullopt;
    instants.*drift = *instant;
  }
  return instants;
}

}  // namespace zwidth::internal

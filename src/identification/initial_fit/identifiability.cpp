#include "identification/initial_fit/identifiability.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "eigenvalues.hpp"
#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

// Change of the response, relative to itself, over a typical change of a coordinate: below, it is rounding.
constexpr double least_influence = 3e-7;
// Of a unit vector: a smaller part of a direction does not take part in it.
constexpr double least_part = 0.03;

/// Slopes in deviations.
Eigen::MatrixXcd weighted_slopes(const ResponseWithSlopes& at_solution, const FitData& data) {
  Eigen::MatrixXcd slopes = at_solution.slopes;
  for (Eigen::Index i = 0; i < slopes.rows(); ++i) slopes.row(i) /= data.deviations[static_cast<std::size_t>(i)];
  return slopes;
}

bool has_influence(const ResponseWithSlopes& at_solution, Eigen::Index coordinate) {
  const Eigen::ArrayXd relative = at_solution.slopes.col(coordinate).array().abs() / at_solution.values.array().abs();
  return relative.maxCoeff() > least_influence;
}

/// The vectors that span the columns' space with as many zeros as row reduction finds: which parameters form a
/// combination shows only so. Pivots: of each vector the row in which the others are 0.
struct SparseBasis {
  Eigen::MatrixXd vectors;
  std::vector<Eigen::Index> pivots;
};

SparseBasis sparse_basis(Eigen::MatrixXd basis) {
  std::vector<Eigen::Index> pivots;
  for (Eigen::Index column = 0; column < basis.cols(); ++column) {
    Eigen::Index pivot = 0;
    basis.col(column).cwiseAbs().maxCoeff(&pivot);
    basis.col(column) /= basis(pivot, column);
    for (Eigen::Index other = 0; other < basis.cols(); ++other) {
      if (other != column) basis.col(other) -= basis(pivot, other) * basis.col(column);
    }
    pivots.push_back(pivot);
  }
  basis.colwise().normalize();
  return {std::move(basis), std::move(pivots)};
}

/// Root mean square of the residuals around each point: how far the deviations are from the truth there. The window
/// holds many more points than there are coordinates, which take their share of the residuals.
Eigen::VectorXd local_level(const Eigen::VectorXcd& residuals, Eigen::Index coordinates) {
  const Eigen::Index points = residuals.size();
  const Eigen::Index reach = std::max({Eigen::Index{8}, points / 20, 2 * coordinates});
  const double taken = 1.0 - static_cast<double>(coordinates) / (2.0 * static_cast<double>(points));
  // Residuals of exact data are rounding: their level must not vanish.
  constexpr double least = 1e-12;
  Eigen::VectorXd level(points);
  for (Eigen::Index i = 0; i < points; ++i) {
    const Eigen::Index begin = std::max<Eigen::Index>(0, i - reach);
    const Eigen::Index count = std::min(points, i + reach + 1) - begin;
    level(i) = std::sqrt(residuals.segment(begin, count).squaredNorm() / (static_cast<double>(count) * taken) + least);
  }
  return level;
}

/// Covariance of the scores sum_i J_i^H r_i: for independent residuals of variance 1, and for every lag at which they
/// are correlated, up to the first at which they are not.
Eigen::MatrixXd scores_covariance(const Eigen::MatrixXcd& slopes, const Eigen::VectorXcd& residuals) {
  const Eigen::Index points = slopes.rows();
  const double insignificant = 2.0 / std::sqrt(static_cast<double>(points));
  Eigen::MatrixXd covariance = 2.0 * (slopes.adjoint() * slopes).real();
  const Eigen::MatrixXd independent = covariance;
  const double squares = residuals.squaredNorm();
  for (Eigen::Index lag = 1; lag <= points / 10 && squares > 0.0; ++lag) {
    const Eigen::Index overlap = points - lag;
    const std::complex<double> correlation = residuals.head(overlap).dot(residuals.tail(overlap)) / squares;
    if (std::abs(correlation) < insignificant) break;
    const Eigen::MatrixXd term =
        2.0 * (correlation * (slopes.bottomRows(overlap).adjoint() * slopes.topRows(overlap))).real();
    covariance += term + term.transpose();
  }
  // Cut off at some lag, the sum need not be positive; correlation may only widen.
  const auto [lower, inverse] = cholesky(independent);
  const SymmetricEigen eigen = symmetric_eigen(inverse * covariance * inverse.transpose());
  return lower * eigen.vectors * eigen.values.cwiseMax(1.0).asDiagonal() * eigen.vectors.transpose() *
         lower.transpose();
}

}  // namespace

Identifiability identifiability(const ResponseWithSlopes& at_solution, const FitData& data) {
  const Eigen::Index n = at_solution.slopes.cols();
  Identifiability result;
  result.determined.assign(static_cast<std::size_t>(n), true);
  result.estimated = result.determined;
  Eigen::MatrixXcd slopes = weighted_slopes(at_solution, data);
  std::vector<Eigen::Index> shown;  // coordinates that change the response at all
  for (Eigen::Index i = 0; i < n; ++i) {
    if (has_influence(at_solution, i)) {
      slopes.col(i).normalize();
      shown.push_back(i);
    } else {
      result.determined[static_cast<std::size_t>(i)] = result.estimated[static_cast<std::size_t>(i)] = false;
      result.combinations.push_back({static_cast<std::size_t>(i)});
    }
  }
  if (shown.empty()) return result;
  const Eigen::MatrixXcd of_shown = slopes(Eigen::all, shown);
  const Eigen::MatrixXd correlation = (of_shown.adjoint() * of_shown).real();
  const SymmetricEigen eigen = symmetric_eigen(correlation);
  const Eigen::Index vanishing = (eigen.values.array() < least_eigenvalue).count();
  if (vanishing == 0) return result;
  const auto [basis, pivots] = sparse_basis(eigen.vectors.leftCols(vanishing));
  for (const Eigen::Index pivot : pivots) {
    result.estimated[static_cast<std::size_t>(shown[static_cast<std::size_t>(pivot)])] = false;
  }
  for (Eigen::Index column = 0; column < vanishing; ++column) {
    std::vector<std::size_t> parts;
    for (Eigen::Index i = 0; i < basis.rows(); ++i) {
      if (std::abs(basis(i, column)) < least_part) continue;
      parts.push_back(static_cast<std::size_t>(shown[static_cast<std::size_t>(i)]));
      result.determined[parts.back()] = false;
    }
    result.combinations.push_back(std::move(parts));
  }
  return result;
}

Eigen::MatrixXd covariance(const ResponseWithSlopes& at_solution, const FitData& data, const Identifiability& known,
                           double robust_threshold) {
  const Eigen::Index all = at_solution.slopes.cols();
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(all, all);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < all; ++i) {
    if (known.shows(static_cast<std::size_t>(i))) kept.push_back(i);
  }
  if (kept.empty()) return full;

  Eigen::MatrixXcd slopes = weighted_slopes(at_solution, data)(Eigen::all, kept);
  const Eigen::Index points = slopes.rows();
  Eigen::VectorXcd residuals(points);
  for (Eigen::Index i = 0; i < points; ++i) {
    const auto k = static_cast<std::size_t>(i);
    residuals(i) = (data.measured[k] - at_solution.values(i)) / data.deviations[k];
    // Huber's loss counts a far residual as one at the threshold, and its slopes as little.
    const double far = robust_threshold > 0.0 ? std::abs(residuals(i)) / robust_threshold : 0.0;
    if (far > 1.0) {
      residuals(i) /= std::sqrt(far);
      slopes.row(i) /= std::sqrt(far);
    }
  }
  // Scaled, so that units of the parameters do not matter to the inverse; along the directions that show.
  const Eigen::VectorXd scale = slopes.colwise().norm().cwiseInverse();
  slopes = slopes * scale.asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen((slopes.adjoint() * slopes).real());
  const Eigen::Index vanishing = (eigen.values.array() < least_eigenvalue).count();
  const Eigen::Index n = eigen.values.size() - vanishing;
  const Eigen::MatrixXd showing = eigen.vectors.rightCols(n);
  const Eigen::VectorXd level = local_level(residuals, n);
  const Eigen::MatrixXd scores = scores_covariance(level.asDiagonal() * slopes * showing,
                                                   residuals.cwiseQuotient(level.cast<std::complex<double>>()));
  // Re and Im of a residual each have half of the variance, hence the 2.
  const Eigen::MatrixXd inverse = (0.5 * eigen.values.tail(n).cwiseInverse()).asDiagonal() * showing.transpose();
  Eigen::MatrixXd result = inverse.transpose() * scores * inverse;
  if (vanishing > 0) {  // known beforehand alone
    const Eigen::MatrixXd hidden = eigen.vectors.leftCols(vanishing);
    const Eigen::MatrixXd before = known_beforehand * scale.asDiagonal() * hidden;
    result += hidden * inverse_of_positive(before.transpose() * before) * hidden.transpose();
  }
  result = scale.asDiagonal() * result * scale.asDiagonal();
  full(kept, kept) = 0.5 * (result + result.transpose());
  return full;
}

}  // namespace zwidth::internal

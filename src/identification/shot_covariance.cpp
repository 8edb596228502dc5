#include "identification/shot_covariance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "eigenvalues.hpp"
#include "identification/correlated_residuals.hpp"
#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

/// Of standard deviations. Where bodies stick and slip the misfit has kinks, and an encoder's rounding goes along with slow
/// motion: what the residuals' scores show is too small by about that much. Found on seeds 800001 to 800023 of
/// benchmarks/friction_campaign; it is checked on others.
constexpr double calibration = 1.5;

/// The columns less their least-squares share in the span of `of_states`, which may be of deficient rank.
Eigen::MatrixXd outside(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& of_states) {
  const Eigen::VectorXd scale = of_states.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  constexpr double rank_tolerance = 1e-9;
  return outside_span(columns, of_states * scale.asDiagonal(), rank_tolerance);
}

/// What is not held, and of what is held what those that are not follow wholly: at its bound it is no better known than the
/// combination of them.
std::vector<Eigen::Index> not_known(const Eigen::MatrixXd& regressors, const std::vector<bool>& held) {
  constexpr double own_part = 1e-4;
  std::vector<Eigen::Index> found;
  for (Eigen::Index i = 0; i < regressors.cols(); ++i) {
    if (!held[static_cast<std::size_t>(i)]) found.push_back(i);
  }
  const Eigen::MatrixXd of_varied = regressors(Eigen::all, found);
  for (Eigen::Index i = 0; i < regressors.cols(); ++i) {
    if (!held[static_cast<std::size_t>(i)] || of_varied.cols() == 0) continue;
    if (outside(regressors.col(i), of_varied).norm() < own_part * regressors.col(i).norm()) found.push_back(i);
  }
  std::ranges::sort(found);
  return found;
}

/// Of regressors of norm 1: directions in which they change something, and in which they do not.
struct Directions {
  Eigen::MatrixXd showing;
  Eigen::MatrixXd hidden;
};

Directions directions_of(const Eigen::MatrixXd& regressors) {
  const SymmetricEigen eigen = symmetric_eigen(regressors.transpose() * regressors);
  const Eigen::Index hidden = (eigen.values.array() < least_eigenvalue).count();
  if (hidden == 0) return {Eigen::MatrixXd::Identity(regressors.cols(), regressors.cols()), {}};
  return {eigen.vectors.rightCols(regressors.cols() - hidden), eigen.vectors.leftCols(hidden)};
}

/// Covariance from sums of the scores over stretches of the record: what stays correlated for longer than the noise's
/// autoregression (rounding of slow motion, friction that is not quite Coulomb's) counts.
Eigen::MatrixXd covariance_of_stretches(const Eigen::MatrixXd& regressors, const Eigen::VectorXd& residuals) {
  constexpr Eigen::Index stretches_wanted = 100;
  const Eigen::Index p = regressors.cols();
  const Eigen::Index length = std::max<Eigen::Index>(1, regressors.rows() / std::max(stretches_wanted, 4 * p));
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(p, p);
  double stretches = 0.0;
  for (Eigen::Index begin = 0; begin < regressors.rows(); begin += length, stretches += 1.0) {
    const Eigen::Index count = std::min(length, regressors.rows() - begin);
    const Eigen::VectorXd score = regressors.middleRows(begin, count).transpose() * residuals.segment(begin, count);
    middle += score * score.transpose();
  }
  const Eigen::MatrixXd inverse = inverse_of_squares(regressors);
  return stretches / (stretches - static_cast<double>(p)) * inverse * middle * inverse;
}

}  // namespace

void widen(Eigen::MatrixXd& covariance, const Eigen::MatrixXd& least) {
  for (Eigen::Index j = 0; j < covariance.cols(); ++j) {
    const double ratio = covariance(j, j) > 0.0 ? least(j, j) / covariance(j, j) : 0.0;
    if (!(ratio > 1.0)) continue;
    covariance.row(j) *= std::sqrt(ratio);
    covariance.col(j) *= std::sqrt(ratio);
  }
}

ShotCovariance shot_covariance(const ShotSlopes& slopes, const std::vector<bool>& held) {
  Eigen::Index rows = 0;
  for (const Eigen::VectorXd& each : slopes.residuals) rows += each.size();
  const Eigen::Index size = slopes.of_parameters.front().cols();
  Eigen::MatrixXd regressors(rows, size);
  Eigen::VectorXd residuals(rows);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < slopes.residuals.size(); ++i) {
    const Eigen::Index count = slopes.residuals[i].size();
    regressors.middleRows(row, count) = outside(slopes.of_parameters[i], slopes.of_states[i]);
    residuals.segment(row, count) = slopes.residuals[i];
    row += count;
  }
  ShotCovariance result{.known = {},
                        .covariance = Eigen::MatrixXd::Zero(size, size),
                        .varies = std::vector<bool>(static_cast<std::size_t>(size), false),
                        .pull = {},
                        .pulled_deviation = {},
                        .step = Eigen::VectorXd::Zero(size)};
  const std::vector<Eigen::Index> varied = not_known(regressors, held);
  for (const Eigen::Index i : varied) result.varies[static_cast<std::size_t>(i)] = true;
  const Eigen::MatrixXd of_varied = regressors(Eigen::all, varied);
  const ResponseWithSlopes at_solution{Eigen::VectorXcd::Ones(rows), of_varied.cast<std::complex<double>>()};
  FitData data;
  data.deviations.assign(static_cast<std::size_t>(rows), 1.0);
  const Identifiability known = identifiability(at_solution, data);
  // Of dampings that nearly make up for each other, one held at 0 shows in what the other cannot follow alone.
  result.pull = result.pulled_deviation = Eigen::VectorXd::Zero(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    if (result.varies[static_cast<std::size_t>(i)]) continue;
    const Eigen::VectorXd own = outside(regressors.col(i), of_varied);
    const double norm = own.norm();
    if (!(norm > 0.0)) continue;
    result.pull(i) = -own.dot(residuals) / norm;
    result.pulled_deviation(i) = 1.0 / norm;
  }
  result.known.determined.assign(static_cast<std::size_t>(size), true);
  result.known.estimated = result.known.determined;
  std::vector<Eigen::Index> shown;
  for (std::size_t k = 0; k < varied.size(); ++k) {
    result.known.determined[static_cast<std::size_t>(varied[k])] = known.determined[k];
    result.known.estimated[static_cast<std::size_t>(varied[k])] = known.estimated[k];
    if (known.shows(k)) shown.push_back(varied[k]);
  }
  for (const std::vector<std::size_t>& combination : known.combinations) {
    result.known.combinations.emplace_back();
    for (const std::size_t k : combination) {
      result.known.combinations.back().push_back(static_cast<std::size_t>(varied[k]));
    }
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    if (held[static_cast<std::size_t>(i)]) result.covariance(i, i) = 1.0 / regressors.col(i).squaredNorm();
  }
  if (shown.empty()) return result;
  // Scaled, so that units do not matter; along the directions that show.
  const Eigen::VectorXd scale = regressors(Eigen::all, shown).colwise().norm().cwiseInverse();
  const Directions directions = directions_of(regressors(Eigen::all, shown) * scale.asDiagonal());
  const Eigen::MatrixXd& showing = directions.showing;
  const Eigen::MatrixXd estimated = regressors(Eigen::all, shown) * scale.asDiagonal() * showing;
  const auto of_shown = [&](const Eigen::MatrixXd& covariance) {
    const Eigen::MatrixXd unscaled =
        scale.asDiagonal() * showing * covariance * showing.transpose() * scale.asDiagonal();
    return Eigen::MatrixXd(0.5 * (unscaled + unscaled.transpose()));  // rounding of the inverse
  };
  result.step(shown) =
      -scale.cwiseProduct(showing * (inverse_of_squares(estimated) * (estimated.transpose() * residuals)));
  Eigen::MatrixXd covariance = of_shown(covariance_with_correlated_residuals(estimated, residuals));
  widen(covariance, of_shown(covariance_of_stretches(estimated, residuals)));
  covariance *= calibration * calibration;
  const double mean_square = residuals.squaredNorm() / static_cast<double>(rows);
  if (mean_square < 1.0) covariance /= mean_square;
  if (directions.hidden.cols() > 0) {
    const Eigen::MatrixXd hidden = scale.asDiagonal() * directions.hidden;
    covariance += hidden * inverse_of_squares(known_beforehand * hidden) * hidden.transpose();
  }
  result.covariance(shown, shown) = covariance;
  return result;
}

}  // namespace zwidth::internal

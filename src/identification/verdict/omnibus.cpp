#include "identification/verdict/omnibus.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numbers>
#include <optional>

#include "identification/verdict/calibration.hpp"

namespace zwidth::internal {
namespace {

using Columns = Eigen::MatrixXd;

Eigen::Index rows_of(const std::vector<LeftOver>& left) {
  Eigen::Index rows = 0;
  for (const LeftOver& each : left) rows += each.residuals.size();
  return rows;
}

Columns stacked(const std::vector<LeftOver>& left, Columns LeftOver::*member) {
  Columns all(rows_of(left), (left.front().*member).cols());
  Eigen::Index at = 0;
  for (const LeftOver& each : left) {
    all.middleRows(at, each.residuals.size()) = each.*member;
    at += each.residuals.size();
  }
  return all;
}

/// An orthonormal basis of what columns have beyond `least` of their size.
Columns basis_of(Columns columns, const Eigen::VectorXd& sizes, double least) {
  for (Eigen::Index j = 0; j < columns.cols(); ++j) columns.col(j) /= std::max(sizes(j), 1e-300);
  Eigen::ColPivHouseholderQR<Columns> decomposition(columns);
  Eigen::Index rank = 0;
  while (rank < columns.cols() && std::abs(decomposition.matrixQR()(rank, rank)) > least) ++rank;
  return decomposition.householderQ() * Columns::Identity(columns.rows(), rank);
}

/// What is fitted: states of each segment, and the numbers.
class Fitted {
 public:
  explicit Fitted(const std::vector<LeftOver>& left) {
    for (const LeftOver& each : left) own_.push_back(basis_of(each.own, each.own.colwise().norm(), least_rank));
    const Columns shared = stacked(left, &LeftOver::shared);
    shared_ = basis_of(without_own(shared), shared.colwise().norm(), least_rank);
  }
  [[nodiscard]] Columns without(const Columns& columns) const {
    const Columns rest = without_own(columns);
    return rest - shared_ * (shared_.transpose() * rest);
  }

 private:
  static constexpr double least_rank = 1e-9;
  [[nodiscard]] Columns without_own(Columns columns) const {
    Eigen::Index at = 0;
    for (const Columns& each : own_) {
      auto part = columns.middleRows(at, each.rows());
      part -= (each * (each.transpose() * part)).eval();
      at += each.rows();
    }
    return columns;
  }
  std::vector<Columns> own_;
  Columns shared_;
};

/// sum_k u_k and its covariance: Bartlett's weights, within a record folded by the period of its force.
struct Score {
  Eigen::VectorXd sum;
  Columns covariance;
};

Score score_of(const Columns& terms, const std::vector<LeftOver>& left) {
  Score score{terms.colwise().sum().transpose(), Columns::Zero(terms.cols(), terms.cols())};
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < left.size();) {
    Columns folded;
    const std::size_t period = left[i].period;
    const std::size_t record = left[i].record;
    Eigen::Index rows = 0;
    std::size_t end = i;
    for (; end < left.size() && left[end].record == record; ++end) rows += left[end].residuals.size();
    if (period == 0) {
      folded = terms.middleRows(at, rows);
    } else {
      folded = Columns::Zero(static_cast<Eigen::Index>(period), terms.cols());
      Eigen::Index row = at;
      for (std::size_t s = i; s < end; ++s) {
        for (Eigen::Index k = 0; k < left[s].residuals.size(); ++k) {
          folded.row(static_cast<Eigen::Index>((left[s].first + static_cast<std::size_t>(k)) % period)) +=
              terms.row(row++);
        }
      }
    }
    // Newey & West 1994: the bandwidth 4 (N / 100)^(2/9).
    const auto bandwidth = std::min<Eigen::Index>(
        folded.rows() - 1, std::lround(4.0 * std::pow(static_cast<double>(folded.rows()) / 100.0, 2.0 / 9.0)));
    score.covariance += folded.transpose() * folded;
    for (Eigen::Index lag = 1; lag <= bandwidth; ++lag) {
      const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(bandwidth + 1);
      const Columns product = folded.bottomRows(folded.rows() - lag).transpose() * folded.topRows(folded.rows() - lag);
      score.covariance += weight * (product + product.transpose());
    }
    at += rows;
    i = end;
  }
  return score;
}

/// The part of the test, and its terms along the direction that makes it most: their sum is the statistic.
struct Tested {
  Omnibus::Part part;
  Eigen::VectorXd terms;
};

std::optional<Tested> tested(Omnibus::Kind kind, const Columns& terms, const std::vector<LeftOver>& left, int freedom) {
  if (terms.cols() == 0 || freedom <= 0) return std::nullopt;
  const Score score = score_of(terms, left);
  const Eigen::VectorXd direction = score.covariance.ldlt().solve(score.sum);
  const double statistic = score.sum.dot(direction);
  if (!std::isfinite(statistic)) return std::nullopt;
  const boost::math::chi_squared law(freedom);
  const double p = boost::math::cdf(boost::math::complement(law, std::max(statistic, 0.0)));
  return Tested{{kind, statistic, freedom, p}, terms * direction};
}

/// Products e[k] e[k - lag], whose sums a white residual has about 0.
Columns lagged_products(const Eigen::VectorXd& residuals, const std::vector<LeftOver>& left) {
  Eigen::Index order = 0;
  for (const LeftOver& each : left) order = std::max(order, each.order);
  const Eigen::Index first = order + 1;  // the filter has made those before it 0
  Columns products = Columns::Zero(residuals.size(), std::max<Eigen::Index>(0, Calibration::most_lags - order));
  Eigen::Index at = 0;
  for (const LeftOver& each : left) {
    const Eigen::Index rows = each.residuals.size();
    for (Eigen::Index j = 0; j < products.cols() && first + j < rows; ++j) {
      const Eigen::Index lag = first + j;
      products.col(j).segment(at + lag, rows - lag) =
          residuals.segment(at + lag, rows - lag).cwiseProduct(residuals.segment(at, rows - lag));
    }
    at += rows;
  }
  return products;
}

/// Of tenths of each segment the one whose terms add most.
void place_of(const Eigen::VectorXd& terms, const std::vector<LeftOver>& left, Omnibus& found) {
  constexpr Eigen::Index pieces = 10;
  double most = 0.0;
  Eigen::Index at = 0;
  for (const LeftOver& each : left) {
    const Eigen::Index rows = each.residuals.size();
    for (Eigen::Index piece = 0; piece < pieces; ++piece) {
      const Eigen::Index begin = rows * piece / pieces;
      const Eigen::Index count = rows * (piece + 1) / pieces - begin;
      const double sum = terms.segment(at + begin, count).sum();
      if (sum <= most) continue;
      most = sum;
      found.record = each.record;
      found.first = each.first + static_cast<std::size_t>(begin);
      found.count = static_cast<std::size_t>(count);
    }
    at += rows;
  }
}

/// Cauchy combination: the mean of tan((1/2 - p) pi) is as one of them; its tail for a small p is 1 / (p pi).
double combined(const std::vector<Omnibus::Part>& parts) {
  constexpr double small = 1e-12;
  constexpr double least = 1e-300;
  double mean = 0.0;
  for (const Omnibus::Part& each : parts) {
    const double p = std::max(each.p, least);
    mean += (p < small ? 1.0 / (p * std::numbers::pi) : std::tan((0.5 - std::min(p, 1.0 - small)) * std::numbers::pi)) /
            static_cast<double>(parts.size());
  }
  return mean > 1.0 / small ? 1.0 / (mean * std::numbers::pi) : 0.5 - std::atan(mean) / std::numbers::pi;
}

}  // namespace

Omnibus omnibus(const std::vector<LeftOver>& left) {
  Omnibus found;
  if (left.empty() || rows_of(left) == 0) return found;
  const Fitted fitted(left);
  Eigen::VectorXd residuals(rows_of(left));
  Columns speed(residuals.size(), 1);
  Eigen::VectorXd counts(residuals.size());
  Eigen::Index at = 0;
  for (const LeftOver& each : left) {
    residuals.segment(at, each.residuals.size()) = each.residuals;
    const double mean = each.speed.sum() / std::max(1.0, each.counts.sum());
    speed.col(0).segment(at, each.residuals.size()) = each.speed - mean * each.counts;
    counts.segment(at, each.residuals.size()) = each.counts;
    at += each.residuals.size();
  }
  if (counts.sum() < 1.0) return found;
  residuals = fitted.without(residuals);
  std::optional<Tested> clearest;
  const auto add = [&](std::optional<Tested> test) {
    if (!test) return;
    found.parts.push_back(test->part);
    const double excess = (test->part.statistic - test->part.freedom) / std::sqrt(2.0 * test->part.freedom);
    if (clearest && excess <= found.excess) return;
    found.excess = excess;
    clearest = std::move(test);
  };
  const Columns products = lagged_products(residuals, left);
  add(tested(Omnibus::Kind::correlated, products, left, static_cast<int>(products.cols())));
  const auto add_score = [&](Omnibus::Kind kind, const Columns& candidates) {
    const Columns basis = basis_of(fitted.without(candidates), candidates.colwise().norm(), Calibration::least_share);
    add(tested(kind, residuals.asDiagonal() * basis, left, static_cast<int>(basis.cols())));
  };
  add_score(Omnibus::Kind::follows_force, stacked(left, &LeftOver::lagged));
  add_score(Omnibus::Kind::nonlinear, stacked(left, &LeftOver::forces));
  const Eigen::VectorXd squares = residuals.array().square() - residuals.squaredNorm() / counts.sum();
  add(tested(Omnibus::Kind::varies_with_speed, squares.asDiagonal() * speed, left, 1));
  if (!clearest) return found;
  found.clearest = clearest->part.kind;
  found.p = combined(found.parts);
  place_of(clearest->terms, left, found);
  return found;
}

}  // namespace zwidth::internal

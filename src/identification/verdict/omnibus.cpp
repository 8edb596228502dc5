#include "identification/verdict/omnibus.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "identification/verdict/calibration.hpp"
#include "linear_systems.hpp"
#include "signal/fourier.hpp"

namespace zwidth::internal {
namespace {

using Columns = Eigen::MatrixXd;

Eigen::Index rows_of(const std::vector<SegmentResiduals>& segments) {
  Eigen::Index rows = 0;
  for (const SegmentResiduals& each : segments) rows += each.residuals.size();
  return rows;
}

Columns stacked(const std::vector<SegmentResiduals>& segments, Columns SegmentResiduals::*member) {
  Columns all(rows_of(segments), (segments.front().*member).cols());
  Eigen::Index at = 0;
  for (const SegmentResiduals& each : segments) {
    all.middleRows(at, each.residuals.size()) = each.*member;
    at += each.residuals.size();
  }
  return all;
}

/// What the numbers do to each record but the last alone: where records are of different devices, theirs differ.
Columns by_record(const std::vector<SegmentResiduals>& segments) {
  const Columns shared = stacked(segments, &SegmentResiduals::shared);
  std::vector<std::size_t> records;
  for (const SegmentResiduals& each : segments) {
    if (std::ranges::find(records, each.record) == records.end()) records.push_back(each.record);
  }
  const Eigen::Index numbers = shared.cols();
  Columns apart = Columns::Zero(shared.rows(), numbers * static_cast<Eigen::Index>(records.size() - 1));
  Eigen::Index at = 0;
  for (const SegmentResiduals& each : segments) {
    const Eigen::Index rows = each.residuals.size();
    const auto record = std::ranges::find(records, each.record) - records.begin();
    if (record * numbers < apart.cols()) {
      apart.block(at, record * numbers, rows, numbers) = shared.middleRows(at, rows);
    }
    at += rows;
  }
  return apart;
}

/// An orthonormal basis of what columns have beyond `least` of their size.
Columns basis_of(Columns columns, const Eigen::VectorXd& sizes, double least) {
  for (Eigen::Index j = 0; j < columns.cols(); ++j) columns.col(j) /= std::max(sizes(j), 1e-300);
  return basis_above(columns, least);
}

/// What is fitted: states of each segment, and the numbers.
class Fitted {
 public:
  explicit Fitted(const std::vector<SegmentResiduals>& segments) {
    for (const SegmentResiduals& each : segments)
      own_.push_back(basis_of(each.own, each.own.colwise().norm(), least_rank));
    const Columns shared = stacked(segments, &SegmentResiduals::shared);
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

/// Spectra of a segment's columns, scaled so that products over all lines sum as those over all samples.
Eigen::MatrixXcd spectra_of(const Eigen::Ref<const Columns>& columns) {
  Eigen::MatrixXcd all(columns.rows() / 2 + 1, columns.cols());
  const double scale = std::sqrt(2.0 / static_cast<double>(columns.rows()));
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const Eigen::VectorXd column = columns.col(j);
    const auto lines = spectrum(std::span<const double>(column.data(), static_cast<std::size_t>(column.size())));
    for (Eigen::Index k = 0; k < all.rows(); ++k) all(k, j) = scale * lines[static_cast<std::size_t>(k)];
  }
  all.row(0) *= std::numbers::sqrt2 / 2.0;
  if (columns.rows() % 2 == 0) all.bottomRows(1) *= std::numbers::sqrt2 / 2.0;
  return all;
}

/// Sums of residuals times candidates, and their covariance: lines of a spectrum are independent whatever its shape, and alike
/// in the segments of a record whose force repeats.
struct Score {
  Eigen::VectorXd sum;
  Columns covariance;
};

Score score_of(const Eigen::VectorXd& residuals, const Columns& candidates,
               const std::vector<SegmentResiduals>& segments) {
  Score score{candidates.transpose() * residuals, Columns::Zero(candidates.cols(), candidates.cols())};
  Columns terms;
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Eigen::Index rows = segments[i].residuals.size();
    const Eigen::MatrixXcd residual = spectra_of(residuals.segment(at, rows));
    const Eigen::MatrixXcd candidate = spectra_of(candidates.middleRows(at, rows));
    const Columns own = (candidate.conjugate().array().colwise() * residual.col(0).array()).real();
    const bool goes_on =
        i > 0 && segments[i].period > 0 && segments[i - 1].record == segments[i].record && terms.rows() == own.rows();
    terms = goes_on ? Columns(terms + own) : own;
    const bool is_last = i + 1 == segments.size() || segments[i].period == 0 ||
                         segments[i + 1].record != segments[i].record || segments[i + 1].residuals.size() != rows;
    if (is_last) score.covariance += terms.transpose() * terms;
    at += rows;
  }
  return score;
}

/// The part of the test, and its terms along the direction that makes it most: their sum is the statistic.
struct Tested {
  Omnibus::Part part;
  Eigen::VectorXd terms;
};

std::optional<Tested> tested(Omnibus::Kind kind, const Eigen::VectorXd& residuals, const Columns& candidates,
                             const std::vector<SegmentResiduals>& segments) {
  const auto freedom = static_cast<int>(candidates.cols());
  if (freedom == 0) return std::nullopt;
  const Score score = score_of(residuals, candidates, segments);
  const Eigen::VectorXd direction = solve_symmetric(score.covariance, score.sum);
  const double statistic = score.sum.dot(direction);
  if (!std::isfinite(statistic)) return std::nullopt;
  const boost::math::chi_squared law(freedom);
  const double p = boost::math::cdf(boost::math::complement(law, std::max(statistic, 0.0)));
  return Tested{{kind, statistic, freedom, p}, residuals.cwiseProduct(candidates * direction)};
}

/// Of tenths of each segment the one whose terms add most.
void place_of(const Eigen::VectorXd& terms, const std::vector<SegmentResiduals>& segments, Omnibus& found) {
  constexpr Eigen::Index pieces = 10;
  double most = 0.0;
  Eigen::Index at = 0;
  for (const SegmentResiduals& each : segments) {
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

Omnibus omnibus(const std::vector<SegmentResiduals>& segments) {
  Omnibus found;
  if (segments.empty() || rows_of(segments) == 0) return found;
  const Fitted fitted(segments);
  Eigen::VectorXd residuals(rows_of(segments));
  double counts = 0.0;
  Eigen::Index at = 0;
  for (const SegmentResiduals& each : segments) {
    residuals.segment(at, each.residuals.size()) = each.residuals;
    counts += each.counts.sum();
    at += each.residuals.size();
  }
  if (counts < 1.0) return found;
  residuals = fitted.without(residuals);
  std::optional<Tested> clearest;
  const auto add = [&](Omnibus::Kind kind, const Columns& candidates) {
    if (candidates.cols() == 0) return;
    const Columns basis = basis_of(fitted.without(candidates), candidates.colwise().norm(), Calibration::least_share);
    std::optional<Tested> test = tested(kind, residuals, basis, segments);
    if (!test) return;
    found.parts.push_back(test->part);
    const double excess = (test->part.statistic - test->part.freedom) / std::sqrt(2.0 * test->part.freedom);
    if (clearest && excess <= found.excess) return;
    found.excess = excess;
    clearest = std::move(test);
  };
  add(Omnibus::Kind::follows_force, stacked(segments, &SegmentResiduals::lagged));
  add(Omnibus::Kind::nonlinear, stacked(segments, &SegmentResiduals::forces));
  add(Omnibus::Kind::records_differ, by_record(segments));
  if (!clearest) return found;
  found.clearest = clearest->part.kind;
  found.p = combined(found.parts);
  place_of(clearest->terms, segments, found);
  return found;
}

}  // namespace zwidth::internal

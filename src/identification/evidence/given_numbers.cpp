#include "identification/evidence/given_numbers.hpp"

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

#include "eigenvalues.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth::internal {

GivenNumbers::GivenNumbers(const DeviceFamily& family, const DeviceParameters& file, const Uncertainty& uncertainty)
    : SquaresOfNumbers(family), keys_(uncertainty.parameters), values_(values_of(file)) {
  constexpr double no_width = 1e-9;  // of a correlation matrix's eigenvalues
  const Eigen::Index count = values_.size();
  Eigen::MatrixXd covariance(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j) {
      covariance(i, j) = uncertainty.covariance[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const SymmetricEigen eigen = symmetric_eigen(scale.asDiagonal() * covariance * scale.asDiagonal());
  Eigen::Index left_out = 0;
  while (left_out < count && eigen.values(left_out) < no_width) ++left_out;
  const Eigen::Index kept = count - left_out;
  whitening_ = eigen.values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal() *
               eigen.vectors.rightCols(kept).transpose() * scale.asDiagonal();
}

Eigen::VectorXd GivenNumbers::values_of(const DeviceParameters& device) const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(keys_.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values(i) = parameter(device, keys_[static_cast<std::size_t>(i)]).value_or(0.0);
  }
  return values;
}

std::optional<Eigen::VectorXd> GivenNumbers::residuals(const Eigen::VectorXd& x) const {
  Eigen::VectorXd left = whitening_ * (values_of(family().device_at(x)) - values_);
  if (!left.allFinite()) return std::nullopt;
  return left;
}

}  // namespace zwidth::internal

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

#include "identification/model/device_family.hpp"

namespace zwidth::internal {

/// d values / dx by central differences, one-sided ones at a bound; 0 for numbers that are not the device's. Nothing where a value
/// beside x cannot be computed.
///
/// `values_at`: x to an optional vector, whose size does not change.
template <typename ValuesAt>
[[nodiscard]] std::optional<Eigen::MatrixXd> difference_slopes(const DeviceFamily& family, const Eigen::VectorXd& x,
                                                               const Eigen::VectorXd& values,
                                                               const ValuesAt& values_at) {
  constexpr double h = 1e-5;  // of coordinates of about 1: an error of 1e-10 by the third derivative, 1e-10 by rounding
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(values.size(), x.size());
  for (Eigen::Index i = 0; i < family.of_device(); ++i) {
    const auto shifted = [&](double by) -> std::optional<Eigen::VectorXd> {
      Eigen::VectorXd moved = x;
      moved(i) += by;
      return values_at(moved);
    };
    const bool at_bound = x(i) - h < family.numbers()[static_cast<std::size_t>(i)].lowest();
    const auto above = shifted(h);
    const auto other = shifted(at_bound ? 2.0 * h : -h);
    if (!above || !other) return std::nullopt;
    if (at_bound) {
      slopes.col(i) = (4.0 * *above - 3.0 * values - *other) / (2.0 * h);
    } else {
      slopes.col(i) = (*above - *other) / (2.0 * h);
    }
  }
  return slopes;
}

}  // namespace zwidth::internal

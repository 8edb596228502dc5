#pragma once

#include <Eigen/Core>
#include <optional>

#include "identification/evidence/likelihood_term.hpp"
#include "identification/model/device_family.hpp"

namespace zwidth::internal {

/// Evidence whose residuals hang on the numbers of the device alone: cost = r(x)'r(x) / 2. It has no elements of its own.
class SquaresOfNumbers : public LikelihoodTerm {
 public:
  explicit SquaresOfNumbers(const DeviceFamily& family) : family_(family) {}

  [[nodiscard]] Eigen::VectorXd own_lowest() const override { return Eigen::VectorXd(0); }
  [[nodiscard]] Eigen::VectorXd own_start(const Eigen::VectorXd& /*x*/) const override { return Eigen::VectorXd(0); }
  [[nodiscard]] std::optional<double> cost(const Eigen::VectorXd& x, const Eigen::VectorXd& own) const override;
  [[nodiscard]] bool add_picture(const Eigen::VectorXd& x, const Eigen::VectorXd& own, Eigen::Index at,
                                 Picture& sum) const override;

  /// Of deviation 1; nothing where they cannot be computed.
  [[nodiscard]] virtual std::optional<Eigen::VectorXd> residuals(const Eigen::VectorXd& x) const = 0;

 protected:
  [[nodiscard]] const DeviceFamily& family() const noexcept { return family_; }

 private:
  const DeviceFamily& family_;
};

}  // namespace zwidth::internal

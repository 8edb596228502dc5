#pragma once

#include <vector>

#include "identification/evidence/likelihood_term.hpp"
#include "identification/model/device_family.hpp"
#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// The lines of a frequency response. Its own element: q = log e, e the relative deviation of the model, common to all lines.
///
///     cost = sum of rho(|G_k - H_k| / (s_k |H_k|)) + log s_k^2,    s_k^2 = variance_k / (2 |H_k|^2) + e^2
///
/// s_k: relative, of each of the two real parts. e is that of the largest likelihood, at least 1e-4. rho(u): Huber's, u^2 / 2 up
/// to u = 4, which 3 in 10 000 lines exceed. The curvature in q is the expected one, 4 (e / s)^4 a line; between q and x it is 0.
/// Of a record, G is the exact sampled plant of its period; of a table, G(jw) with the delay's phase.
class ResponseEvidence : public LikelihoodTerm {
 public:
  ResponseEvidence(const DeviceFamily& family, FrequencyResponse response);

  [[nodiscard]] Eigen::VectorXd own_lowest() const override;
  [[nodiscard]] Eigen::VectorXd own_start(const Eigen::VectorXd& x) const override;
  [[nodiscard]] std::optional<double> cost(const Eigen::VectorXd& x, const Eigen::VectorXd& own) const override;
  [[nodiscard]] bool add_picture(const Eigen::VectorXd& x, const Eigen::VectorXd& own, Eigen::Index at,
                                 Picture& sum) const override;

  /// Model less measured over |H|: the real parts of all lines, then the imaginary ones.
  [[nodiscard]] std::optional<Eigen::VectorXd> relative_errors(const Eigen::VectorXd& x) const;

 private:
  const DeviceFamily& family_;
  FrequencyResponse response_;
};

}  // namespace zwidth::internal

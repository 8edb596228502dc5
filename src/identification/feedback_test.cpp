#include "identification/feedback_test.hpp"

#include <algorithm>
#include <cmath>

namespace zwidth::internal {

std::vector<double> feedback_evidence(const ShotModel& model, const std::vector<Shot>& shots,
                                      const std::vector<ShotNoise>& noise, const ShotPositions& residuals) {
  constexpr Eigen::Index lags = 20;
  ShotPositions forces;
  for (const Shot& shot : shots) {
    forces.emplace_back(Eigen::Map<const Eigen::VectorXd>(model.records()[shot.record].force.data() + shot.first,
                                                          static_cast<Eigen::Index>(shot.count)));
  }
  const std::size_t records = model.records().size();
  const std::size_t order = noise.front().filter.size() - 1;
  const std::vector<ShotNoise> of_force = shot_noise(shots, forces, std::vector<double>(records, 0.0), order);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(lags + 1, static_cast<Eigen::Index>(records));
  Eigen::MatrixXd squares = sums;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const auto record = static_cast<Eigen::Index>(shots[i].record);
    const Eigen::VectorXd e = whitened(noise[shots[i].record], residuals[i]);
    const Eigen::VectorXd v = whitened(of_force[shots[i].record], forces[i]);
    for (Eigen::Index lag = 0; lag <= lags; ++lag) {
      const Eigen::Index count = e.size() - lag;
      const Eigen::ArrayXd terms = e.head(count).array() * v.tail(count).array();
      sums(lag, record) += terms.sum();
      squares(lag, record) += terms.square().sum();
    }
  }
  const Eigen::ArrayXXd evidence = sums.array().abs() / (squares.array().sqrt() + 1e-300);
  std::vector<double> most(records);
  for (std::size_t r = 0; r < records; ++r) most[r] = evidence.col(static_cast<Eigen::Index>(r)).maxCoeff();
  return most;
}

}  // namespace zwidth::internal

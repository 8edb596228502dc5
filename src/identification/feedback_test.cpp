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
  const auto columns = static_cast<Eigen::Index>(records);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(2 * lags + 1, columns);
  Eigen::MatrixXd squares = sums;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const auto record = static_cast<Eigen::Index>(shots[i].record);
    const Eigen::VectorXd e = whitened(noise[shots[i].record], residuals[i]);
    const Eigen::VectorXd v = whitened(of_force[shots[i].record], forces[i]);
    for (Eigen::Index lag = -lags; lag <= lags; ++lag) {
      const Eigen::Index count = e.size() - std::abs(lag);
      const Eigen::ArrayXd terms = e.segment(std::max<Eigen::Index>(0, -lag), count).array() *
                                   v.segment(std::max<Eigen::Index>(0, lag), count).array();
      sums(lags + lag, record) += terms.sum();
      squares(lags + lag, record) += terms.square().sum();
    }
  }
  const Eigen::ArrayXXd evidence = sums.array().abs() / (squares.array().sqrt() + 1e-300);
  std::vector<double> most(records);
  for (std::size_t r = 0; r < records; ++r) {
    const auto of_record = evidence.col(static_cast<Eigen::Index>(r));
    const double before = of_record.head(lags).maxCoeff();
    const double after = of_record.tail(lags + 1).maxCoeff();
    most[r] = std::sqrt(std::max(0.0, after * after - before * before));
  }
  return most;
}

}  // namespace zwidth::internal

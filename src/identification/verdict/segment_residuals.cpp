#include "identification/verdict/segment_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "identification/model/linear_step.hpp"
#include "identification/verdict/calibration.hpp"

namespace zwidth::internal {
namespace {

/// The smallest number of samples after which a force repeats, at least twice in its length; 0: it does not.
std::size_t repeat_of(std::span<const double> force) {
  double largest = 0.0;
  for (const double each : force) largest = std::max(largest, std::abs(each));
  constexpr double rounding = 1e-9;
  for (std::size_t period = 2; period <= force.size() / 2; ++period) {
    std::size_t k = period;
    while (k < force.size() && std::abs(force[k] - force[k - period]) <= rounding * largest) ++k;
    if (k == force.size()) return period;
  }
  return 0;
}

double sample_at(std::span<const double> samples, std::ptrdiff_t at) {
  return at < 0 || at >= static_cast<std::ptrdiff_t>(samples.size()) ? 0.0 : samples[static_cast<std::size_t>(at)];
}

/// Positions of the sensed body under forces from rest: x[k + 1] = e^{AT} x[k] + C f[k], a column of forces each.
Eigen::MatrixXd positions_under(const Device& device, double period, const Eigen::MatrixXd& forces) {
  const auto sensed = static_cast<Eigen::Index>(device.parameters().loop.sensed);
  const LinearStep step = linear_step(motion_columns(device), {}, period);
  const Eigen::Index states = step.columns.rows();
  const Eigen::VectorXd input = step.columns.col(states + 1 + sensed);
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(states, forces.cols());
  Eigen::MatrixXd positions(forces.rows(), forces.cols());
  for (Eigen::Index k = 0; k < forces.rows(); ++k) {
    positions.row(k) = state.row(0);
    if (sensed != 0) positions.row(k) += state.row(sensed);
    state = step.columns.leftCols(states) * state + input * forces.row(k);
  }
  return positions;
}

/// 1 where the samples about a row span enough steps of the encoder.
Eigen::VectorXd moving_rows(const Eigen::Ref<const Eigen::VectorXd>& recorded, double step) {
  Eigen::VectorXd moving = Eigen::VectorXd::Ones(recorded.size());
  constexpr Eigen::Index half = Calibration::moving_within / 2;
  for (Eigen::Index k = 0; k < recorded.size(); ++k) {
    const Eigen::Index begin = std::max<Eigen::Index>(0, k - half);
    const auto about = recorded.segment(begin, std::min(recorded.size(), k + half) - begin);
    if (about.maxCoeff() - about.minCoeff() < Calibration::least_steps * step) moving(k) = 0.0;
  }
  return moving;
}

}  // namespace

std::optional<std::vector<SegmentResiduals>> segment_residuals(const TimeEvidence& evidence, const Eigen::VectorXd& z) {
  const MotionModel& model = evidence.model();
  const Eigen::Index numbers = evidence.numbers();
  std::vector<Eigen::VectorXd> states;
  for (std::size_t i = 0; i < evidence.segments().size(); ++i) {
    states.emplace_back(z.segment(numbers + static_cast<Eigen::Index>(i) * model.states(), model.states()));
  }
  const auto played = model.play(z.head(numbers), evidence.segments(), states, true);
  if (!played) return std::nullopt;
  const Device device = model.family().recorded_device(z.head(numbers));
  std::vector<SegmentResiduals> segments;
  for (std::size_t i = 0; i < played->size(); ++i) {
    const Segment& segment = evidence.segments()[i];
    const ForceMotionRecord& record = model.records()[segment.record];
    const Noise& noise = evidence.noise()[segment.record];
    const auto count = static_cast<Eigen::Index>(segment.count);
    const Eigen::VectorXd& position = (*played)[i].positions;
    constexpr auto lags = static_cast<Eigen::Index>(Calibration::force_lags.size());
    Eigen::MatrixXd lagged(count, lags);
    Eigen::MatrixXd forces(count, 8);
    const double mean = position.mean();
    for (Eigen::Index k = 0; k < count; ++k) {
      const auto at = static_cast<std::ptrdiff_t>(segment.first) + k;
      for (Eigen::Index j = 0; j < lags; ++j)
        lagged(k, j) = sample_at(record.force, at - Calibration::force_lags[static_cast<std::size_t>(j)]);
      const Eigen::Index next = std::min(k + 1, count - 1);
      const Eigen::Index last = std::max<Eigen::Index>(k - 1, 0);
      const double velocity =
          (position(next) - position(last)) / (static_cast<double>(next - last) * record.sampling_period);
      const double force = sample_at(record.force, at);
      const double place = position(k) - mean;
      const double share = static_cast<double>(at) / static_cast<double>(record.position.size()) - 0.5;
      const double speed = std::abs(velocity);
      forces.row(k) << force * force, force * force * force, velocity > 0.0 ? 1.0 : -1.0, speed, velocity * speed,
          place * place, place * place * place, share * velocity;
    }
    forces.colwise().normalize();
    const auto order = static_cast<Eigen::Index>(noise.filter.size()) - 1;
    const Eigen::MatrixXd slopes = whitened(noise, (*played)[i].slopes);
    const Eigen::Map<const Eigen::VectorXd> recorded(record.position.data() + segment.first, count);
    const Eigen::VectorXd counts = moving_rows(recorded, evidence.encoder_steps()[segment.record]).tail(count - order);
    const auto counted = [&](const Eigen::MatrixXd& columns) -> Eigen::MatrixXd {
      return counts.asDiagonal() * columns;
    };
    segments.push_back({segment.record, segment.first + static_cast<std::size_t>(order), repeat_of(record.force),
                        counted(whitened(noise, position - recorded)), counted(slopes.leftCols(numbers)),
                        counted(slopes.rightCols(model.states())), counted(whitened(noise, lagged)),
                        counted(whitened(noise, positions_under(device, record.sampling_period, forces))), counts});
  }
  return segments;
}

}  // namespace zwidth::internal

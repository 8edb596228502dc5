#include "identification/evidence/time_evidence.hpp"

#include <limits>
#include <utility>

namespace zwidth::internal {

TimeEvidence::TimeEvidence(const MotionModel& model, std::vector<Segment> segments, std::vector<double> encoder_steps,
                           Eigen::Index noise_order)
    : model_(model),
      segments_(std::move(segments)),
      steps_(std::move(encoder_steps)),
      order_(noise_order),
      noise_(model.records().size()) {}

Eigen::VectorXd TimeEvidence::own_lowest() const {
  const Eigen::Index states = static_cast<Eigen::Index>(segments_.size()) * model_.states();
  return Eigen::VectorXd::Constant(states, -std::numeric_limits<double>::infinity());
}

Eigen::VectorXd TimeEvidence::own_start(const Eigen::VectorXd& /*x*/) const {
  const Eigen::Index s = model_.states();
  Eigen::VectorXd own(static_cast<Eigen::Index>(segments_.size()) * s);
  for (std::size_t i = 0; i < segments_.size(); ++i)
    own.segment(static_cast<Eigen::Index>(i) * s, s) = model_.recorded_state(segments_[i]);
  return own;
}

Eigen::Map<const Eigen::VectorXd> TimeEvidence::recorded(const Segment& segment) const {
  return {model_.records()[segment.record].position.data() + segment.first, static_cast<Eigen::Index>(segment.count)};
}

std::optional<std::vector<PlayedSegment>> TimeEvidence::play(const Eigen::VectorXd& x, const Eigen::VectorXd& own,
                                                             bool with_slopes) const {
  std::vector<Eigen::VectorXd> states;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    states.emplace_back(own.segment(static_cast<Eigen::Index>(i) * model_.states(), model_.states()));
  }
  return model_.play(x, segments_, states, with_slopes);
}

std::optional<std::vector<Eigen::VectorXd>> TimeEvidence::residuals(const Eigen::VectorXd& x,
                                                                    const Eigen::VectorXd& own) const {
  const auto played = play(x, own, false);
  if (!played) return std::nullopt;
  std::vector<Eigen::VectorXd> left;
  for (std::size_t i = 0; i < segments_.size(); ++i) left.emplace_back((*played)[i].positions - recorded(segments_[i]));
  return left;
}

std::optional<std::vector<Noise>> TimeEvidence::noise_at(const Eigen::VectorXd& x, const Eigen::VectorXd& own) const {
  const auto left = residuals(x, own);
  if (!left) return std::nullopt;
  std::vector<Noise> noise;
  for (std::size_t record = 0; record < steps_.size(); ++record) {
    std::vector<const Eigen::VectorXd*> of_record;
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      if (segments_[i].record == record) of_record.push_back(&(*left)[i]);
    }
    noise.push_back(of_record.empty() ? Noise{} : noise_of(of_record, steps_[record], order_));
  }
  return noise;
}

std::optional<double> TimeEvidence::cost(const Eigen::VectorXd& x, const Eigen::VectorXd& own) const {
  auto left = residuals(x, own);
  if (!left) return std::nullopt;
  double squares = 0.0;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    whiten(noise_[segments_[i].record], (*left)[i]);
    squares += (*left)[i].squaredNorm();
  }
  return 0.5 * squares;
}

bool TimeEvidence::add_picture(const Eigen::VectorXd& x, const Eigen::VectorXd& own, Eigen::Index first,
                               Picture& sum) const {
  auto played = play(x, own, true);  // slopes are large: filtered where they are, their memory is used again
  if (!played) return false;
  const Eigen::Index n = numbers();
  const Eigen::Index s = model_.states();
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Noise& noise = noise_[segments_[i].record];
    Eigen::VectorXd left = (*played)[i].positions - recorded(segments_[i]);
    Eigen::MatrixXd& slopes = (*played)[i].slopes;
    whiten(noise, left);
    whiten(noise, slopes);
    const Eigen::VectorXd gradient = slopes.transpose() * left;
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n + s, n + s);
    hessian.selfadjointView<Eigen::Lower>().rankUpdate(slopes.transpose());
    hessian.triangularView<Eigen::StrictlyUpper>() = hessian.transpose();
    const Eigen::Index at = first + static_cast<Eigen::Index>(i) * s;
    sum.cost += 0.5 * left.squaredNorm();
    sum.gradient.head(n) += gradient.head(n);
    sum.gradient.segment(at, s) += gradient.tail(s);
    sum.hessian.topLeftCorner(n, n) += hessian.topLeftCorner(n, n);
    sum.hessian.block(0, at, n, s) += hessian.topRightCorner(n, s);
    sum.hessian.block(at, 0, s, n) += hessian.bottomLeftCorner(s, n);
    sum.hessian.block(at, at, s, s) += hessian.bottomRightCorner(s, s);
  }
  return true;
}

}  // namespace zwidth::internal

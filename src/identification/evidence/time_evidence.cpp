#include "identification/evidence/time_evidence.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace zwidth::internal {

TimeEvidence::TimeEvidence(const MotionModel& model, std::vector<Segment> segments, std::vector<double> encoder_steps, Eigen::Index noise_order)
    : model_(model), segments_(std::move(segments)), steps_(std::move(encoder_steps)), order_(noise_order), noise_(model.records().size()) {}

Eigen::VectorXd TimeEvidence::lowest() const {
  const Eigen::Index states = static_cast<Eigen::Index>(segments_.size()) * model_.states();
  Eigen::VectorXd bounds = Eigen::VectorXd::Constant(numbers() + states, -std::numeric_limits<double>::infinity());
  for (Eigen::Index i = 0; i < numbers(); ++i) bounds(i) = model_.numbers()[static_cast<std::size_t>(i)].lowest();
  return bounds;
}

Eigen::VectorXd TimeEvidence::start(const Eigen::VectorXd& x) const {
  Eigen::VectorXd z(lowest().size());
  z.head(numbers()) = x;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    z.segment(numbers() + static_cast<Eigen::Index>(i) * model_.states(), model_.states()) = model_.recorded_state(segments_[i]);
  }
  return z;
}

Eigen::Map<const Eigen::VectorXd> TimeEvidence::recorded(const Segment& segment) const {
  return {model_.records()[segment.record].position.data() + segment.first, static_cast<Eigen::Index>(segment.count)};
}

std::optional<std::vector<PlayedSegment>> TimeEvidence::play(const Eigen::VectorXd& z, bool with_slopes) const {
  std::vector<Eigen::VectorXd> states;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    states.emplace_back(z.segment(numbers() + static_cast<Eigen::Index>(i) * model_.states(), model_.states()));
  }
  return model_.play(z.head(numbers()), segments_, states, with_slopes);
}

std::optional<std::vector<Eigen::VectorXd>> TimeEvidence::residuals(const Eigen::VectorXd& z) const {
  const auto played = play(z, false);
  if (!played) return std::nullopt;
  std::vector<Eigen::VectorXd> left;
  for (std::size_t i = 0; i < segments_.size(); ++i) left.emplace_back((*played)[i].positions - recorded(segments_[i]));
  return left;
}

std::optional<std::vector<Noise>> TimeEvidence::noise_at(const Eigen::VectorXd& z) const {
  const auto left = residuals(z);
  if (!left) return std::nullopt;
  std::vector<Noise> noise;
  for (std::size_t record = 0; record < steps_.size(); ++record) {
    std::vector<const Eigen::VectorXd*> own;
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      if (segments_[i].record == record) own.push_back(&(*left)[i]);
    }
    noise.push_back(own.empty() ? Noise{} : noise_of(own, steps_[record], order_));
  }
  return noise;
}

std::optional<double> TimeEvidence::cost(const Eigen::VectorXd& z) const {
  const auto left = residuals(z);
  if (!left) return std::nullopt;
  double squares = 0.0;
  for (std::size_t i = 0; i < segments_.size(); ++i) squares += whitened(noise_[segments_[i].record], (*left)[i]).squaredNorm();
  for (Eigen::Index i = 0; i < numbers(); ++i) {
    const Number& number = model_.numbers()[static_cast<std::size_t>(i)];
    squares += std::pow((z(i) - number.expected) / number.prior_deviation, 2);
  }
  return 0.5 * squares;
}

std::optional<Picture> TimeEvidence::picture(const Eigen::VectorXd& z) const {
  const auto played = play(z, true);
  if (!played) return std::nullopt;
  const Eigen::Index n = numbers();
  const Eigen::Index s = model_.states();
  Picture made{0.0, Eigen::VectorXd::Zero(z.size()), Eigen::MatrixXd::Zero(z.size(), z.size())};
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Noise& noise = noise_[segments_[i].record];
    const Eigen::VectorXd left = whitened(noise, (*played)[i].positions - recorded(segments_[i]));
    const Eigen::MatrixXd slopes = whitened(noise, (*played)[i].slopes);
    const Eigen::VectorXd gradient = slopes.transpose() * left;
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n + s, n + s);
    hessian.selfadjointView<Eigen::Lower>().rankUpdate(slopes.transpose());
    hessian.triangularView<Eigen::StrictlyUpper>() = hessian.transpose();
    const Eigen::Index at = n + static_cast<Eigen::Index>(i) * s;
    made.cost += 0.5 * left.squaredNorm();
    made.gradient.head(n) += gradient.head(n);
    made.gradient.segment(at, s) += gradient.tail(s);
    made.hessian.topLeftCorner(n, n) += hessian.topLeftCorner(n, n);
    made.hessian.block(0, at, n, s) += hessian.topRightCorner(n, s);
    made.hessian.block(at, 0, s, n) += hessian.bottomLeftCorner(s, n);
    made.hessian.block(at, at, s, s) += hessian.bottomRightCorner(s, s);
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const Number& number = model_.numbers()[static_cast<std::size_t>(i)];
    const double left = (z(i) - number.expected) / number.prior_deviation;
    made.cost += 0.5 * left * left;
    made.gradient(i) += left / number.prior_deviation;
    made.hessian(i, i) += 1.0 / (number.prior_deviation * number.prior_deviation);
  }
  return made;
}

}  // namespace zwidth::internal

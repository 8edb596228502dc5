#include "identification/evidence/sum_of_evidence.hpp"

#include <cstddef>
#include <utility>

namespace zwidth::internal {

SumOfEvidence::SumOfEvidence(std::vector<Number> numbers, std::vector<std::shared_ptr<const PartOfEvidence>> parts,
                             std::function<void()> tell)
    : numbers_(std::move(numbers)), parts_(std::move(parts)), tell_(std::move(tell)) {}

Eigen::VectorXd SumOfEvidence::lowest() const {
  Eigen::VectorXd bounds(count());
  for (Eigen::Index i = 0; i < count(); ++i) bounds(i) = numbers_[static_cast<std::size_t>(i)].lowest();
  for (const auto& part : parts_) {
    const Eigen::VectorXd own = part->own_lowest();
    bounds.conservativeResize(bounds.size() + own.size());
    bounds.tail(own.size()) = own;
  }
  return bounds;
}

Eigen::VectorXd SumOfEvidence::start(const Eigen::VectorXd& x) const {
  Eigen::VectorXd z = x;
  for (const auto& part : parts_) {
    const Eigen::VectorXd own = part->own_start(x);
    z.conservativeResize(z.size() + own.size());
    z.tail(own.size()) = own;
  }
  return z;
}

std::optional<double> SumOfEvidence::cost(const Eigen::VectorXd& z) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < count(); ++i) {
    const Number& number = numbers_[static_cast<std::size_t>(i)];
    const double left = (z(i) - number.expected) / number.prior_deviation;
    sum += 0.5 * left * left;
  }
  Eigen::Index at = count();
  for (const auto& part : parts_) {
    const Eigen::Index size = part->own_lowest().size();
    const auto cost = part->cost(z.head(count()), z.segment(at, size));
    if (!cost) return std::nullopt;
    sum += *cost;
    at += size;
  }
  return sum;
}

std::optional<Picture> SumOfEvidence::picture(const Eigen::VectorXd& z) const {
  if (tell_) tell_();
  Picture sum{0.0, Eigen::VectorXd::Zero(z.size()), Eigen::MatrixXd::Zero(z.size(), z.size())};
  for (Eigen::Index i = 0; i < count(); ++i) {
    const Number& number = numbers_[static_cast<std::size_t>(i)];
    const double left = (z(i) - number.expected) / number.prior_deviation;
    sum.cost += 0.5 * left * left;
    sum.gradient(i) += left / number.prior_deviation;
    sum.hessian(i, i) += 1.0 / (number.prior_deviation * number.prior_deviation);
  }
  Eigen::Index at = count();
  for (const auto& part : parts_) {
    const Eigen::Index size = part->own_lowest().size();
    if (!part->add_picture(z.head(count()), z.segment(at, size), at, sum)) return std::nullopt;
    at += size;
  }
  return sum;
}

}  // namespace zwidth::internal

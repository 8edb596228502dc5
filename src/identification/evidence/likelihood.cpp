#include "identification/evidence/likelihood.hpp"

#include <cstddef>
#include <utility>

namespace zwidth::internal {

Likelihood::Likelihood(std::vector<Number> numbers, std::vector<std::shared_ptr<const LikelihoodTerm>> terms,
                       std::function<void()> tell)
    : numbers_(std::move(numbers)), terms_(std::move(terms)), tell_(std::move(tell)) {}

Eigen::VectorXd Likelihood::lowest() const {
  Eigen::VectorXd bounds(count());
  for (Eigen::Index i = 0; i < count(); ++i) bounds(i) = numbers_[static_cast<std::size_t>(i)].lowest();
  for (const auto& term : terms_) {
    const Eigen::VectorXd own = term->own_lowest();
    bounds.conservativeResize(bounds.size() + own.size());
    bounds.tail(own.size()) = own;
  }
  return bounds;
}

Eigen::VectorXd Likelihood::start(const Eigen::VectorXd& x) const {
  Eigen::VectorXd z = x;
  for (const auto& term : terms_) {
    const Eigen::VectorXd own = term->own_start(x);
    z.conservativeResize(z.size() + own.size());
    z.tail(own.size()) = own;
  }
  return z;
}

std::optional<double> Likelihood::cost(const Eigen::VectorXd& z) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < count(); ++i) {
    const Number& number = numbers_[static_cast<std::size_t>(i)];
    const double left = (z(i) - number.expected) / number.prior_deviation;
    sum += 0.5 * left * left;
  }
  Eigen::Index at = count();
  for (const auto& term : terms_) {
    const Eigen::Index size = term->own_lowest().size();
    const auto cost = term->cost(z.head(count()), z.segment(at, size));
    if (!cost) return std::nullopt;
    sum += *cost;
    at += size;
  }
  return sum;
}

std::optional<Picture> Likelihood::picture(const Eigen::VectorXd& z) const {
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
  for (const auto& term : terms_) {
    const Eigen::Index size = term->own_lowest().size();
    if (!term->add_picture(z.head(count()), z.segment(at, size), at, sum)) return std::nullopt;
    at += size;
  }
  return sum;
}

}  // namespace zwidth::internal

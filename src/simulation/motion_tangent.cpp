#include "simulation/motion_tangent.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace zwidth::internal {
namespace {

/// Columns of S that are summed at once.
constexpr std::size_t block = 4;

/// Terms of a series in t with |A| t <= `size` until they are below rounding.
int terms_for(double size) {
  constexpr int most = 24;
  constexpr double rounding = 1e-17;
  double term = 1.0;
  int k = 0;
  while (k < most && term > rounding) term *= size / ++k;
  return k;
}

/// dA/dp as it is in a pattern: stuck bodies' velocities do not change.
Eigen::MatrixXd in_pattern(Eigen::MatrixXd slope, const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& free) {
  for (Eigen::Index i = 0; i < slope.rows(); ++i) {
    if (matrix.row(i).isZero(0.0) && !free.row(i).isZero(0.0)) slope.row(i).setZero();
  }
  return slope;
}

}  // namespace

MotionTangent::MotionTangent(const ContinuousMotion& motion, std::vector<MotionParameter> parameters,
                             std::size_t others)
    : parameters_(std::move(parameters)), size_(static_cast<std::size_t>(motion.patterns().front().matrix.rows())) {
  multiply_ = matrix_vector(size_);
  const auto n = static_cast<Eigen::Index>(size_);
  columns_ = static_cast<Eigen::Index>(parameters_.size() + others);
  limit_weights_.assign(parameters_.size(), 1.0);
  sliding_.resize(motion.bodies());
  constexpr auto of_block = static_cast<Eigen::Index>(block);
  slopes_ = Slopes::Zero(n, (columns_ + of_block - 1) / of_block * of_block);
  next_ = slopes_;
  term_ = slopes_;
  change_.resize(size_);
  for (const ContinuousMotion::Pattern& pattern : motion.patterns()) {
    matrices_.push_back(sparse(pattern.matrix));
    transitions_.emplace_back();
    for (const ContinuousMotion::RecurringStep& step : pattern.steps) {
      transitions_.back().push_back(sparse(step.transition));
    }
  }
  const Eigen::MatrixXd& free = motion.patterns().front().matrix;
  for (std::size_t j = 0; j < parameters_.size(); ++j) {
    if (parameters_[j].matrix.size() == 0 || parameters_[j].matrix.isZero(0.0)) continue;
    Varied varied{j, 1.0, {}, {}};
    for (const ContinuousMotion::Pattern& pattern : motion.patterns()) {
      const Eigen::MatrixXd slope = in_pattern(parameters_[j].matrix, pattern.matrix, free);
      varied.entries.emplace_back();
      for (std::size_t column = 0; column < size_; ++column) {
        for (std::size_t row = 0; row < size_; ++row) {
          const double value = slope.data()[column * size_ + row];
          if (value != 0.0) varied.entries.back().push_back({row, column, value});
        }
      }
      make_steps(varied, pattern, slope, motion);
    }
    varied_.push_back(std::move(varied));
  }
}

/// By their series over a short time, and e^{2M} = (e^M)², d e^{2M} = de^M e^M + e^M de^M.
void MotionTangent::make_steps(Varied& varied, const ContinuousMotion::Pattern& pattern, const Eigen::MatrixXd& slope,
                               const ContinuousMotion& motion) const {
  const auto halvings = static_cast<int>(motion.halvings());
  std::vector<Eigen::MatrixXd>& steps = varied.steps.emplace_back();
  for (const double length : motion.recurring_lengths()) {
    constexpr double small = 0.25;
    const int doublings = std::max(halvings, static_cast<int>(std::ceil(std::log2(pattern.norm * length / small))));
    const double part = std::ldexp(length, -doublings);
    const auto n = pattern.matrix.rows();
    Eigen::MatrixXd term = Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd slope_term = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd sum = term;
    Eigen::MatrixXd slope_sum = slope_term;
    for (int k = 1; k <= terms_for(small); ++k) {
      slope_term = (part / k * (pattern.matrix * slope_term + slope * term)).eval();
      term = (part / k * (pattern.matrix * term)).eval();
      sum += term;
      slope_sum += slope_term;
    }
    const std::size_t first = steps.size();
    steps.resize(first + motion.halvings() + 1);
    for (int left = doublings; left >= 0; --left) {
      if (left <= halvings) steps[first + static_cast<std::size_t>(left)] = slope_sum;
      slope_sum = (slope_sum * sum + sum * slope_sum).eval();
      sum = (sum * sum).eval();
    }
  }
}

MotionTangent::Sparse MotionTangent::sparse(const Eigen::MatrixXd& matrix) {
  Sparse result;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    result.begins.push_back(result.entries.size());
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      if (matrix(i, j) == 0.0) continue;
      result.entries.push_back({static_cast<std::size_t>(i), static_cast<std::size_t>(j), matrix(i, j)});
    }
  }
  result.begins.push_back(result.entries.size());
  return result;
}

void MotionTangent::multiply(const Sparse& matrix, double factor, const Slopes& in, Slopes& out) const noexcept {
  const auto width = static_cast<std::size_t>(in.cols());
  const Entry* const entries = matrix.entries.data();
  for (std::size_t i = 0; i < size_; ++i) {
    const std::size_t begin = matrix.begins[i];
    const std::size_t end = matrix.begins[i + 1];
    double* __restrict row = out.data() + i * width;
    for (std::size_t first = 0; first < width; first += block) {
      double sum[block] = {};
      for (std::size_t k = begin; k < end; ++k) {
        const double* __restrict other = in.data() + entries[k].column * width + first;
        for (std::size_t j = 0; j < block; ++j) sum[j] += entries[k].value * other[j];
      }
      for (std::size_t j = 0; j < block; ++j) row[first + j] = factor * sum[j];
    }
  }
}

void MotionTangent::weigh(std::size_t parameter, double weight) noexcept {
  for (Varied& each : varied_) {
    if (each.column == parameter) each.weight = weight;
  }
  limit_weights_[parameter] = weight;
  const std::vector<double>& limits = parameters_[parameter].limits;
  for (std::size_t body = 0; body < limits.size(); ++body) {
    const auto& [force, direction] = sliding_[body];
    if (direction == 0) continue;
    slopes_(static_cast<Eigen::Index>(force), static_cast<Eigen::Index>(parameter)) =
        -direction * weight * limits[body];
  }
}

void MotionTangent::step(unsigned stuck, std::size_t which, const double* x) noexcept {
  multiply(transitions_[stuck][which], 1.0, slopes_, next_);
  slopes_.swap(next_);
  const auto width = static_cast<std::size_t>(slopes_.cols());
  for (const Varied& each : varied_) {
    multiply_(each.steps[stuck][which].data(), x, change_.data(), size_);
    for (std::size_t i = 0; i < size_; ++i) slopes_.data()[i * width + each.column] += each.weight * change_[i];
  }
}

void MotionTangent::move(const ContinuousMotion::Pattern& pattern, unsigned stuck, const Eigen::MatrixXd& series,
                         std::size_t known, double length, double fraction) noexcept {
  const int terms = terms_for(pattern.norm * length * fraction);
  const auto width = static_cast<std::size_t>(slopes_.cols());
  const auto all = width * size_;
  std::copy_n(slopes_.data(), all, term_.data());
  double power = 1.0;  // of the fraction: the columns of `series` are over the whole length
  for (int k = 1; k <= terms; ++k) {
    const double factor = length * fraction / k;
    multiply(matrices_[stuck], factor, term_, next_);
    if (static_cast<std::size_t>(k) <= known) {
      const double* x = series.data() + static_cast<std::size_t>(k - 1) * size_;
      for (const Varied& each : varied_) {
        for (const Entry& entry : each.entries[stuck]) {
          next_.data()[entry.row * width + each.column] += factor * each.weight * entry.value * power * x[entry.column];
        }
      }
    }
    power *= fraction;
    term_.swap(next_);
    for (std::size_t i = 0; i < all; ++i) slopes_.data()[i] += term_.data()[i];
  }
}

void MotionTangent::turn(std::size_t velocity, double ratio) noexcept {
  slopes_.row(static_cast<Eigen::Index>(velocity)) *= ratio;
}

void MotionTangent::slide(std::size_t body, std::size_t force, int direction) noexcept {
  sliding_[body] = {force, direction};
  for (std::size_t j = 0; j < parameters_.size(); ++j) {
    if (parameters_[j].limits.empty()) continue;
    slopes_(static_cast<Eigen::Index>(force), static_cast<Eigen::Index>(j)) =
        -direction * limit_weights_[j] * parameters_[j].limits[body];
  }
}

void MotionTangent::start(std::size_t velocity, double acceleration) noexcept {
  for (std::size_t j = 0; j < parameters_.size(); ++j) {
    slopes_(static_cast<Eigen::Index>(velocity), static_cast<Eigen::Index>(j)) -=
        acceleration * parameters_[j].switching;
  }
}

void MotionTangent::switch_command(const Eigen::MatrixXd& matrix, std::size_t command, double fall) noexcept {
  for (std::size_t j = 0; j < parameters_.size(); ++j) {
    if (parameters_[j].switching == 0.0) continue;
    slopes_.col(static_cast<Eigen::Index>(j)) +=
        fall * parameters_[j].switching * matrix.col(static_cast<Eigen::Index>(command));
  }
}

}  // namespace zwidth::internal

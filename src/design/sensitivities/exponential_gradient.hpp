#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>

namespace zwidth::internal {

/// Matrices of one precision; `Most` bounds their size (Eigen::Dynamic: no bound).
template <typename RealType, int Most>
struct Precision {
  using Real = RealType;
  using Complex = std::complex<Real>;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, 0, Most, Most>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, Most, 1>;
  using ComplexMatrix = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, 0, Most, Most>;
  using ComplexVector = Eigen::Matrix<Complex, Eigen::Dynamic, 1, 0, Most, 1>;
};

/// e^M - I, and by adjoint() the gradient of <W, e^M> to the entries of M: by the Taylor series of M / 2^halvings and
/// E <- 2 E + E², both differentiated (N. J. Higham, Functions of Matrices, section 10.6).
template <typename P>
class ExponentialGradient {
 public:
  using Real = typename P::Real;
  using Matrix = typename P::Matrix;

  explicit ExponentialGradient(Matrix matrix) : m_(std::move(matrix)) {
    const Real norm = m_.cwiseAbs().rowwise().sum().maxCoeff();
    halvings_ = norm > Real(0.25) ? static_cast<int>(std::ceil(std::log2(norm / Real(0.25)))) : 0;
    m_ *= std::ldexp(Real(1.0), -halvings_);
    powers_[0] = m_;
    sum_ = m_;
    for (std::size_t k = 2; k <= terms; ++k) {
      powers_[k - 1].noalias() = powers_[k - 2] * m_;
      powers_[k - 1] /= Real(k);
      sum_ += powers_[k - 1];
    }
    value_ = sum_;
    for (int i = 0; i < halvings_; ++i) value_ = doubled(value_);
  }

  [[nodiscard]] const Matrix& minus_one() const { return value_; }

  /// L(M^T, W), by the same series and doublings as e^M: term k of the series has the derivative
  /// L_k = (M^T L_{k-1} + W (M^T)^{k-1}/(k-1)!)/k.
  [[nodiscard]] Matrix adjoint(const Matrix& weights) const {
    const Matrix transposed = m_.transpose();
    const Matrix scaled = weights * std::ldexp(Real(1.0), -halvings_);
    Matrix term = scaled;
    Matrix slope = scaled;
    Matrix next(scaled.rows(), scaled.cols());
    for (std::size_t k = 2; k <= terms; ++k) {
      next.noalias() = transposed * term;
      next.noalias() += scaled * powers_[k - 2].transpose();
      term = next / Real(k);
      slope += term;
    }
    Matrix value = sum_.transpose();
    for (int i = 0; i < halvings_; ++i) {
      next.noalias() = slope * value;
      next.noalias() += value * slope;
      slope = Real(2.0) * slope + next;
      if (i + 1 < halvings_) value = doubled(value);
    }
    return slope;
  }

 private:
  static constexpr std::size_t terms = sizeof(Real) > sizeof(double) ? 15 : 12;  // 0.25^terms / terms! below rounding

  static Matrix doubled(const Matrix& value) {
    Matrix squared(value.rows(), value.cols());
    squared.noalias() = value * value;
    return Real(2.0) * value + squared;
  }

  Matrix m_;
  Matrix powers_[terms];  // M^k / k!, k from 1
  Matrix sum_;
  Matrix value_;
  int halvings_ = 0;
};

}  // namespace zwidth::internal

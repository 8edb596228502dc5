#include "stability/tip/tip_response.hpp"

#include <cmath>
#include <numbers>

#include "eigenvalues.hpp"

namespace zwidth::internal {
namespace {

// Quicker than the division, which looks for what overflows.
std::complex<double> reciprocal(std::complex<double> value) { return std::conj(value) / std::norm(value); }

}  // namespace

TipResponse::TipResponse(const SampledTip& plant) : delay_samples_(static_cast<double>(plant.delay_samples)) {
  const Hessenberg form = hessenberg(plant.Phi);
  hessenberg_ = form.matrix;
  output_ = plant.C * form.basis;
  input_ = form.basis.transpose() * plant.Gamma1;
  if (plant.has_fraction()) late_input_ = form.basis.transpose() * plant.Gamma2;
}

// (delta - H) x = b by elimination of the one subdiagonal, rows exchanged where that is larger.
Eigen::MatrixXcd TipResponse::at(double angle) const {
  const Eigen::Index n = hessenberg_.rows();
  const double half = std::sin(0.5 * angle);
  const std::complex<double> delta(-2.0 * half * half, std::sin(angle));
  Eigen::MatrixXcd rows = -hessenberg_.cast<std::complex<double>>();
  rows.diagonal().array() += delta;
  Eigen::MatrixXcd x = input_.cast<std::complex<double>>();
  if (late_input_.size() > 0) x += std::polar(1.0, -angle) * late_input_;
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    if (std::norm(rows(k + 1, k)) > std::norm(rows(k, k))) {
      for (Eigen::Index j = k; j < n; ++j) std::swap(rows(k, j), rows(k + 1, j));
      for (Eigen::Index j = 0; j < x.cols(); ++j) std::swap(x(k, j), x(k + 1, j));
    }
    const std::complex<double> factor = rows(k + 1, k) * reciprocal(rows(k, k));
    for (Eigen::Index j = k + 1; j < n; ++j) rows(k + 1, j) -= factor * rows(k, j);
    for (Eigen::Index j = 0; j < x.cols(); ++j) x(k + 1, j) -= factor * x(k, j);
  }
  for (Eigen::Index k = n; k-- > 0;) {
    const std::complex<double> one_over = reciprocal(rows(k, k));
    for (Eigen::Index j = 0; j < x.cols(); ++j) {
      for (Eigen::Index i = k + 1; i < n; ++i) x(k, j) -= rows(k, i) * x(i, j);
      x(k, j) *= one_over;
    }
  }
  return std::polar(1.0, -angle * delay_samples_) * (output_ * x);
}

std::vector<double> TipResponse::angles_of_poles() const {
  constexpr double widths[] = {0.0, 0.3, 1.0, 2.5, 6.0};  // of a pole's distance from the circle
  std::vector<double> angles;
  for (const std::complex<double>& delta : eigenvalues(hessenberg_)) {
    const std::complex<double> z = 1.0 + delta;
    if (std::arg(z) < 0.0 || std::abs(z) == 0.0) continue;
    for (const double width : widths) {
      for (const double side : {-1.0, 1.0}) {
        const double angle = std::arg(z) + side * width * std::abs(std::log(std::abs(z)));
        if (angle > 0.0 && angle < std::numbers::pi) angles.push_back(angle);
      }
    }
  }
  return angles;
}

}  // namespace zwidth::internal

#include "stability/solved_motions.hpp"

#include <Eigen/LU>
#include <array>
#include <span>
#include <vector>

namespace zwidth::internal {
namespace {

// As real equations of twice as many unknowns, the real parts above the imaginary ones: Eigen's search for a complex pivot
// takes a hypot of every entry, longer than all else here. `most`: unknowns, for which there is room without the heap.
template <int most>
void solve(const DeviceMatrices<long double>& matrices, Eigen::Index forced, long double w,
           std::span<long double> positions) {
  using Real = long double;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most, most>;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1, Eigen::ColMajor, most, 1>;
  const auto n = static_cast<Eigen::Index>(matrices.mass.size());
  Matrix impedance(2 * n, 2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto entry = static_cast<std::size_t>(i * n + j);
      const Real inertia = i == j ? w * w * matrices.mass[static_cast<std::size_t>(i)] : Real(0.0);
      const Real loss = w * matrices.damping[entry];
      impedance(i, j) = impedance(n + i, n + j) = matrices.stiffness[entry] - inertia;
      impedance(n + i, j) = loss;
      impedance(i, n + j) = -loss;
    }
  }
  Vector force = Vector::Zero(2 * n);
  force(forced) = Real(1.0);
  const Eigen::PartialPivLU<Eigen::Ref<Matrix>> elimination(impedance);
  Eigen::Map<Vector>(positions.data(), 2 * n) = elimination.solve(force);
}

}  // namespace

SolvedMotions::SolvedMotions(const Device& device, std::size_t forced)
    : matrices_(device_matrices<long double>(device)), forced_(forced) {}

void SolvedMotions::responses(double frequency, std::complex<double>* values) const {
  constexpr int few = 16;
  const std::size_t n = matrices_.mass.size();
  std::array<long double, few> room{};
  std::vector<long double> more(2 * n > few ? 2 * n : 0);
  const std::span<long double> positions = more.empty() ? std::span<long double>(room) : std::span<long double>(more);
  const auto forced = static_cast<Eigen::Index>(forced_);
  const auto w = static_cast<long double>(frequency);
  more.empty() ? solve<few>(matrices_, forced, w, positions) : solve<Eigen::Dynamic>(matrices_, forced, w, positions);
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const auto [body, past] = motions_[i];
    long double real = positions[body];
    long double imaginary = positions[n + body];
    if (past != body) real -= positions[past], imaginary -= positions[n + past];
    values[i] = {static_cast<double>(real), static_cast<double>(imaginary)};
  }
}

}  // namespace zwidth::internal

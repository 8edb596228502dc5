#include "sampling/decimation.hpp"

#include <vector>

namespace zwidth::internal {
namespace {

class SquareMatrix {
 public:
  explicit SquareMatrix(std::size_t size) : size_(size), entries_(size * size, Extended(0.0)) {}
  Extended& operator()(std::size_t i, std::size_t j) { return entries_[i * size_ + j]; }
  const Extended& operator()(std::size_t i, std::size_t j) const { return entries_[i * size_ + j]; }
  [[nodiscard]] std::size_t size() const { return size_; }

  friend SquareMatrix operator*(const SquareMatrix& a, const SquareMatrix& b) {
    SquareMatrix c(a.size_);
    for (std::size_t i = 0; i < a.size_; ++i)
      for (std::size_t k = 0; k < a.size_; ++k)
        for (std::size_t j = 0; j < a.size_; ++j) c(i, j) += a(i, k) * b(k, j);
    return c;
  }
  friend SquareMatrix operator+(SquareMatrix a, const SquareMatrix& b) {
    for (std::size_t i = 0; i < a.entries_.size(); ++i) a.entries_[i] += b.entries_[i];
    return a;
  }

 private:
  std::size_t size_;
  std::vector<Extended> entries_;
};

// (I + change)^steps - I
SquareMatrix power_minus_one(SquareMatrix change, std::size_t steps) {
  SquareMatrix result(change.size());
  bool is_first = true;
  while (steps > 0) {
    if (steps % 2 == 1) result = is_first ? change : result + change + result * change;
    is_first = is_first && steps % 2 == 0;
    steps /= 2;
    if (steps > 0) change = change + change + change * change;
  }
  return result;
}

}  // namespace

ExtendedTerm decimated(const ExtendedTerm& fast, std::size_t integrators, std::size_t steps, std::size_t late) {
  const std::size_t n = fast.denominator.size() - 1;
  SquareMatrix change(n);  // A - I, companion form
  for (std::size_t i = 0; i + 1 < n; ++i) change(i, i + 1) = Extended(1.0);
  for (std::size_t i = 0; i < n; ++i) change(n - 1, i) = Extended(0.0) - fast.denominator[i];

  // sum_{i < count} A^i b at count = steps - late and at steps.
  std::vector<Extended> state(n, Extended(0.0));
  std::vector<Extended> with_new;
  for (std::size_t step = 0; step < steps; ++step) {
    if (step == steps - late) with_new = state;
    Extended last = Extended(1.0);
    for (std::size_t i = 0; i < n; ++i) last += change(n - 1, i) * state[i];
    for (std::size_t i = 0; i + 1 < n; ++i) state[i] += state[i + 1];
    state[n - 1] += last;
  }
  if (late == 0) with_new = state;
  std::vector<Extended> with_old = std::move(state);
  for (std::size_t i = 0; i < n; ++i) with_old[i] -= with_new[i];

  // Faddeev-LeVerrier, as in sample_extended().
  const SquareMatrix phi = power_minus_one(change, steps);
  SquareMatrix b(n);
  for (std::size_t i = 0; i < n; ++i) b(i, i) = Extended(1.0);
  ExtendedTerm slow;
  slow.denominator.assign(n + 1, Extended(1.0));
  std::vector<Extended> from_new(n, Extended(0.0));
  std::vector<Extended> from_old(n, Extended(0.0));
  for (std::size_t k = 1; k <= n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const Extended each = fast.numerator[i] * b(i, j);
        from_new[n - k] += each * with_new[j];
        from_old[n - k] += each * with_old[j];
      }
    }
    b = phi * b;
    Extended trace(0.0);
    for (std::size_t i = 0; i < n; ++i) trace += b(i, i);
    slow.denominator[n - k] = Extended(0.0) - trace / Extended(static_cast<double>(k));
    if (n - k < integrators) slow.denominator[n - k] = Extended(0.0);
    for (std::size_t i = 0; i < n; ++i) b(i, i) += slow.denominator[n - k];
  }
  slow.numerator = from_new;
  slow.numerator.emplace_back(0.0);
  if (late > 0) {  // (1 + delta) N_new + N_old
    for (std::size_t i = 0; i < n; ++i) {
      slow.numerator[i] += from_old[i];
      slow.numerator[i + 1] += from_new[i];
    }
  }
  return slow;
}

}  // namespace zwidth::internal

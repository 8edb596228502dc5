#include "zwidth/model/transfer_function.hpp"

#include <flint/fmpz_mat.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "model/balls.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Integer = FlintValue<fmpz, fmpz_init, fmpz_clear, fmpz_set>;

// Relative rounding of each entry that is allowed for, per state: some operations made it, not one.
constexpr int slack_bits = 47;  // 2^-47 n

class IntegerMatrix {
 public:
  IntegerMatrix(Eigen::Index rows, Eigen::Index columns) { fmpz_mat_init(matrix_, rows, columns); }
  IntegerMatrix(IntegerMatrix&& other) noexcept {
    fmpz_mat_init(matrix_, 0, 0);
    fmpz_mat_swap(matrix_, other.matrix_);
  }
  IntegerMatrix(const IntegerMatrix&) = delete;
  IntegerMatrix& operator=(const IntegerMatrix&) = delete;
  IntegerMatrix& operator=(IntegerMatrix&&) = delete;
  ~IntegerMatrix() { fmpz_mat_clear(matrix_); }

  fmpz* operator()(Eigen::Index i, Eigen::Index j) { return fmpz_mat_entry(matrix_, i, j); }
  operator fmpz_mat_struct*() { return matrix_; }              // NOLINT(google-explicit-constructor): FLINT's functions
  operator const fmpz_mat_struct*() const { return matrix_; }  // NOLINT(google-explicit-constructor)

 private:
  fmpz_mat_t matrix_ = {};
};

// values = integers 2^exponent; returns the exponent.
long set(IntegerMatrix& integers, const Eigen::MatrixXd& values) {
  int lowest = std::numeric_limits<int>::max();
  for (const double value : values.reshaped()) {
    if (value != 0.0) lowest = std::min(lowest, std::ilogb(value) - 52);
  }
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (Eigen::Index j = 0; j < values.cols(); ++j) {
      if (values(i, j) == 0.0) continue;
      const int last_bit = std::ilogb(values(i, j)) - 52;
      fmpz_set_d(integers(i, j), std::ldexp(values(i, j), -last_bit));
      fmpz_mul_2exp(integers(i, j), integers(i, j), static_cast<ulong>(last_bit - lowest));
    }
  }
  return lowest == std::numeric_limits<int>::max() ? 0 : lowest;
}

double rounded(const fmpz* integer, long exponent) {
  RealBall ball;
  arf_set_fmpz(arb_midref(ball), integer);
  arf_mul_2exp_si(arb_midref(ball), arb_midref(ball), exponent);
  return arf_get_d(arb_midref(ball), ARF_RND_NEAR);
}

// Whether changes of all entries by 2^-slack_bits n of themselves may have made it.
bool is_rounding(const fmpz* coefficient, const fmpz* change, Eigen::Index n) {
  Integer left;
  Integer right;
  fmpz_abs(left, coefficient);
  fmpz_mul_2exp(left, left, slack_bits);
  fmpz_mul_si(right, change, n);
  return fmpz_cmp(left, right) <= 0;
}

// sum_ij |A_ij| |N_ji|
Integer product_of_magnitudes(const IntegerMatrix& A, const IntegerMatrix& N) {
  Integer sum;
  Integer product;
  for (slong i = 0; i < fmpz_mat_nrows(A); ++i) {
    for (slong j = 0; j < fmpz_mat_ncols(A); ++j) {
      fmpz_mul(product, fmpz_mat_entry(A, i, j), fmpz_mat_entry(N, j, i));
      fmpz_abs(product, product);
      fmpz_add(sum, sum, product);
    }
  }
  return sum;
}

IntegerMatrix product_of(const IntegerMatrix& left, const IntegerMatrix& right) {
  IntegerMatrix product(fmpz_mat_nrows(left), fmpz_mat_ncols(right));
  fmpz_mat_mul(product, left, right);
  return product;
}

// adj(s I - A) = sum_k N_k s^k and det(s I - A) = sum_k c_k s^k, all of integers where A is:
//
//     N_{n-1} = I,   c_k = -tr(A N_k) / (n - k),   N_{k-1} = A N_k + c_k I
class Adjugate {
 public:
  explicit Adjugate(const IntegerMatrix& A) : A_(A), n_(fmpz_mat_nrows(A)), k_(n_ - 1), N_(n_, n_) {
    fmpz_mat_one(N_);
    find_coefficient();
  }
  // N_k and c_k, k = n - 1 to begin with.
  [[nodiscard]] const IntegerMatrix& N() const { return N_; }
  [[nodiscard]] const Integer& c() const { return c_; }
  // k <- k - 1
  void next() {
    fmpz_mat_swap(N_, AN_);
    for (slong i = 0; i < n_; ++i) fmpz_add(N_(i, i), N_(i, i), c_);
    --k_;
    find_coefficient();
  }

 private:
  void find_coefficient() {
    fmpz_mat_mul(AN_, A_, N_);
    fmpz_mat_trace(c_, AN_);
    fmpz_neg(c_, c_);
    fmpz_divexact_si(c_, c_, n_ - k_);
  }

  const IntegerMatrix& A_;
  slong n_;
  slong k_;
  IntegerMatrix N_;
  IntegerMatrix AN_{n_, n_};
  Integer c_;
};

void check(const ContinuousStateSpace& system) {
  const Eigen::Index n = system.A.rows();
  if (n < 1 || n > static_cast<Eigen::Index>(max_exact_states) || system.A.cols() != n || system.B.size() != n ||
      system.C.size() != n) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::state_space_of_other_sizes,
                                              .evidence = {{"rows", static_cast<double>(n)},
                                                           {"columns", static_cast<double>(system.A.cols())},
                                                           {"inputs", static_cast<double>(system.B.size())},
                                                           {"outputs", static_cast<double>(system.C.size())},
                                                           {"most", static_cast<double>(max_exact_states)}}});
  }
  const auto check_entries = [](const auto& entries) {
    for (const double value : entries.reshaped()) {
      if (value != 0.0 && !(std::abs(value) >= 1e-100 && std::abs(value) <= 1e100)) {
        throw Error(ErrorCode::invalid_argument,
                    {.code = ProblemCode::state_space_entry_not_possible, .evidence = {{"value", value}}});
      }
    }
  };
  check_entries(system.A);
  check_entries(system.B);
  check_entries(system.C);
}

}  // namespace

// The numerator is det(s I - A + B C) - det(s I - A). Coefficients change, where entries change by themselves, by
//
//     of s^k in det(s I - A):  -(N_k)_ji of A_ij,    in the numerator:  the difference of two such, (N_k B)_i of C_i, (C N_k)_j of B_j
TransferFunction transfer_function(const ContinuousStateSpace& system) {
  check(system);
  const Eigen::Index n = system.A.rows();
  IntegerMatrix A(n, n);
  IntegerMatrix B(n, 1);
  IntegerMatrix C(1, n);
  const long time_exponent = set(A, system.A);  // of A, hence of s
  const long gain_exponent = set(B, system.B) + set(C, system.C);
  IntegerMatrix closed = product_of(B, C);
  fmpz_mat_sub(closed, A, closed);
  Adjugate open_adjugate(A);
  Adjugate closed_adjugate(closed);

  const auto size = static_cast<std::size_t>(n);
  TransferFunction result{std::vector<double>(size, 0.0), std::vector<double>(size + 1, 0.0)};
  result.denominator.front() = 1.0;
  bool numerator_begun = false;
  std::size_t denominator_end = 0;  // the last coefficient that is more than rounding
  IntegerMatrix difference(n, n);
  Integer numerator;
  Integer change;
  for (std::size_t place = 0; place < size; ++place) {  // of the numerator; s^(n - 1 - place)
    const IntegerMatrix& N = open_adjugate.N();
    const auto power = static_cast<long>(place);
    fmpz_sub(numerator, closed_adjugate.c(), open_adjugate.c());
    fmpz_mat_sub(difference, closed_adjugate.N(), N);
    change = product_of_magnitudes(A, difference);
    fmpz_add(change, change, product_of_magnitudes(C, product_of(N, B)));
    fmpz_add(change, change, product_of_magnitudes(product_of(C, N), B));
    numerator_begun = numerator_begun || !is_rounding(numerator, change, n);
    if (numerator_begun) result.numerator[place] = rounded(numerator, gain_exponent + power * time_exponent);
    result.denominator[place + 1] = rounded(open_adjugate.c(), (power + 1) * time_exponent);
    if (!is_rounding(open_adjugate.c(), product_of_magnitudes(A, N), n)) denominator_end = place + 1;
    if (place + 1 == size) break;
    open_adjugate.next();
    closed_adjugate.next();
  }
  std::fill(result.denominator.begin() + static_cast<std::ptrdiff_t>(denominator_end) + 1, result.denominator.end(),
            0.0);
  return result;
}

}  // namespace zwidth

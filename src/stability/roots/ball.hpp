#pragma once

// A real number with a proven bound of its error (Arb) that is used as a number is: sums and products keep as many bits
// as BallDigits asks for.

#include <arb.h>

#include "model/balls.hpp"

namespace zwidth::internal {

// The bits that Balls of this thread keep, as long as it lives.
class BallDigits {
 public:
  explicit BallDigits(slong bits) : before_(bits_) { bits_ = bits; }
  BallDigits(const BallDigits&) = delete;
  BallDigits& operator=(const BallDigits&) = delete;
  ~BallDigits() { bits_ = before_; }

  [[nodiscard]] static slong bits() { return bits_; }

 private:
  static inline thread_local slong bits_ = 256;
  slong before_;
};

class Ball {
 public:
  Ball() = default;
  explicit Ball(double exact) { arb_set_d(value_, exact); }

  [[nodiscard]] const arb_struct* get() const { return value_; }
  [[nodiscard]] arb_struct* get() { return value_; }

  // 0 where the ball holds zero.
  [[nodiscard]] int sure_sign() const {
    return arb_is_positive(value_) != 0 ? 1 : arb_is_negative(value_) != 0 ? -1 : 0;
  }
  [[nodiscard]] double middle() const {
    return arf_get_d(arb_midref(value_.operator const arb_struct*()), ARF_RND_NEAR);
  }
  [[nodiscard]] bool is_finite() const { return arb_is_finite(value_) != 0; }
  // Its middle, as exact.
  [[nodiscard]] Ball sharp() const {
    Ball result;
    arb_get_mid_arb(result.value_, value_);
    return result;
  }

  friend Ball operator+(const Ball& a, const Ball& b) {
    Ball sum;
    arb_add(sum.value_, a.value_, b.value_, BallDigits::bits());
    return sum;
  }
  friend Ball operator-(const Ball& a, const Ball& b) {
    Ball difference;
    arb_sub(difference.value_, a.value_, b.value_, BallDigits::bits());
    return difference;
  }
  friend Ball operator-(const Ball& a) {
    Ball negative;
    arb_neg(negative.value_, a.value_);
    return negative;
  }
  friend Ball operator*(const Ball& a, const Ball& b) {
    Ball product;
    arb_mul(product.value_, a.value_, b.value_, BallDigits::bits());
    return product;
  }
  friend Ball operator/(const Ball& a, const Ball& b) {
    Ball quotient;
    arb_div(quotient.value_, a.value_, b.value_, BallDigits::bits());
    return quotient;
  }
  Ball& operator+=(const Ball& b) {
    arb_add(value_, value_, b.value_, BallDigits::bits());
    return *this;
  }
  Ball& operator-=(const Ball& b) {
    arb_sub(value_, value_, b.value_, BallDigits::bits());
    return *this;
  }
  friend bool operator==(const Ball& a, const Ball& b) { return arb_equal(a.value_, b.value_) != 0; }

 private:
  RealBall value_;
};

}  // namespace zwidth::internal

#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "model/balls.hpp"

namespace zwidth::internal {

/// A real pole, or the upper one of a complex pair.
struct ExactPole {
  ComplexBall at;
  slong multiplicity = 1;
  bool is_real = false;
  Complex<Extended> rounded;
};

/// Bits of the balls that the poles are last sought with.
inline constexpr slong most_precision = 16384;

/// All poles of p, with proof, zero among them, each known to `precision` bits; nothing where they cannot be told apart.
[[nodiscard]] std::optional<std::vector<ExactPole>> find_poles(const IntegerPolynomial& p, slong precision);

/// find_poles(), each polynomial sought once at each precision: all paths of a device have one denominator.
class KnownPoles {
 public:
  [[nodiscard]] const std::optional<std::vector<ExactPole>>& of(const IntegerPolynomial& p, slong precision);

 private:
  struct Known {
    IntegerPolynomial p;
    slong precision = 0;
    std::optional<std::vector<ExactPole>> poles;
  };
  std::deque<Known> known_;
};

}  // namespace zwidth::internal

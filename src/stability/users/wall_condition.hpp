#pragma once

#include <array>
#include <complex>
#include <optional>

#include "stability/loop/damper_response.hpp"
#include "stability/users/disc_pieces.hpp"

namespace zwidth::internal {

/// The condition that no passive user destabilises the wall C = K u + d (see WallResponse), at all gains K up to some one
/// and on a whole interval of frequencies: with A = |c|² - r²
///
///     f(K) = |1 + C c|² - |C|² r² = p + 2 q K + A |u|² K² > 0
///     p = 1 + 2 Re[d c] + A |d|²,   q = Re[u c] + A Re[u conj d]
///
/// (all over the disc's `one`, which takes the place of 1 and is 0 where the disc is a half plane), times a positive factor
/// that makes p, q and A smooth. f > 0 at all 0 < K <= K1 if p >= 0, f(K1) > 0 and one of
/// A < 0, p + q K1 > 0, (p + q K1)² < p f(K1); the last is p A |u|² > q² too, where the difference of products that are
/// nearly alike is one polynomial.
class WallCondition {
 public:
  /// The values at one frequency.
  struct Terms {
    double constant = 0.0;   // p
    double half = 0.0;       // q
    double quadratic = 0.0;  // A |u|²
  };
  [[nodiscard]] static Terms terms(const TerminationDiscs::Disc& disc, const WallResponse& wall);

  /// On a piece; `walls`: at its nodes.
  WallCondition(const DiscPieces::Piece& piece, const std::array<WallResponse, interpolation_points>& walls);

  enum class Verdict { holds, broken, undecided };
  struct Answer {
    Verdict verdict = Verdict::undecided;
    double at = 0.0;  // where it is broken, in -1..1 of the piece
  };
  [[nodiscard]] Answer up_to(double stiffness) const;

  /// The least K > 0 with f(K) = 0 in the limit w -> 0, of a piece that begins there; 0 where no K > 0 is allowed,
  /// infinity where all are; nothing where the piece does not tell.
  [[nodiscard]] std::optional<double> least_stiffness_at_zero() const { return at_zero_; }

 private:
  struct NearZero;
  void look_at_zero(const NearZero& terms);
  [[nodiscard]] double last_at(std::size_t node, double stiffness) const;

  std::array<DiscPieces::Node, interpolation_points> nodes_;
  std::array<WallResponse, interpolation_points> walls_;
  std::array<Terms, interpolation_points> terms_;
  bool is_undamped_ = false;      // d = 0: p is the factor, positive as it stands
  bool holds_for_all_k_ = false;  // f has no root K > 0 on the piece
  std::optional<double> at_zero_;
};

}  // namespace zwidth::internal

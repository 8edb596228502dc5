#pragma once

// The discs of passive users on intervals of frequency, by values at interpolation points. The sums over aliases are
// smooth between the images of modes and of zeros of Re Y above Nyquist and cost most: they are interpolated first, the many that lie far
// above all modes apart from the few that do not.

#include <array>
#include <cstddef>
#include <vector>

#include "stability/roots/interval_polynomial.hpp"
#include "stability/users/termination_discs.hpp"

namespace zwidth::internal {

/// TerminationDiscs::other_aliases() on (0, pi/T], interpolated.
class AliasSums {
 public:
  struct Singularity {
    double position = 0.0;  // rad/s
    double depth = 0.0;     // distance from the real axis
  };

  AliasSums() = default;
  AliasSums(const TerminationDiscs& discs, double period, const std::vector<Singularity>& images);

  struct Value {
    TerminationDiscs::OtherAliases sums;
    double error = 0.0;  // of either sum
  };
  [[nodiscard]] Value at(double frequency) const;

 private:
  struct Piece {
    double begin = 0.0;
    double end = 0.0;
    InterpolationValues real{};
    InterpolationValues imaginary{};
    InterpolationValues radius{};
    double error = 0.0;
  };
  using Pieces = std::vector<Piece>;  // by rising frequency

  template <typename Sums>
  static Pieces interpolated_sums(const Sums& sums, double nyquist, const std::vector<Singularity>& images);
  static const Piece& piece_at(const Pieces& pieces, double frequency);
  static void add(const Piece& piece, double frequency, Value& value);

  Pieces near_;  // TerminationDiscs::near_aliases()
  Pieces far_;   // TerminationDiscs::far_aliases()
};

/// The discs on pieces of (0, pi/T], made when they are first asked for and kept: they do not depend on the damper.
class DiscPieces {
 public:
  DiscPieces() = default;
  DiscPieces(const TerminationDiscs& discs, const Device& device);

  struct Node {
    double frequency = 0.0;
    TerminationDiscs::Disc disc;  // scaled
    double factor = 0.0;          // see TerminationDiscs::SplitDisc
    double error = 0.0;           // of centre and radius each, over the disc's `one`
  };
  struct Piece {
    double base = 0.0;  // rad/s; 0, or the image of a sharp zero, from which what vanishes there keeps its digits
    double side = 1.0;  // of the base: -1 below
    // Distances from the base, rad/s; from 0 to the first end the nodes stand in the frequency's square, in which all is
    // smooth at 0 too.
    double begin = 0.0;
    double end = 0.0;
    int depth = 0;
    int first_half = -1;  // index of the halves, once divided
    int second_half = -1;
    bool is_sampled = false;
    std::array<Node, interpolation_points> nodes{};
    [[nodiscard]] bool begins_at_rest() const { return base == 0.0 && begin == 0.0; }
    [[nodiscard]] bool begins_at_zero_of_dissipation() const { return base != 0.0 && begin == 0.0; }
    /// A place of the piece, from -1 <= x <= 1 in which it is interpolated.
    [[nodiscard]] TerminationDiscs::Place place_at(double x) const;
    [[nodiscard]] double lowest() const { return side > 0.0 ? base + begin : base - end; }
    [[nodiscard]] double highest() const { return side > 0.0 ? base + end : base - begin; }
  };

  /// Indices of the pieces to start with: they cover (0, pi/T].
  [[nodiscard]] std::size_t first_pieces() const { return first_pieces_; }
  [[nodiscard]] const Piece& sampled(std::size_t index);
  [[nodiscard]] const Piece& operator[](std::size_t index) const { return pieces_[index]; }
  /// Divides a piece, unless that is done.
  void divide(std::size_t index);

  /// Whether the poles of the sums and filters, and one at `further` on the imaginary axis, lie far enough from a piece
  /// for its values to speak for all of it.
  [[nodiscard]] bool is_clear_of_poles(std::size_t index, double further) const;

  /// The disc from the interpolated sums, scaled.
  [[nodiscard]] TerminationDiscs::Disc at(const TerminationDiscs::Place& place) const;

 private:
  void add_first(double begin, double end, double base = 0.0, double side = 1.0);
  void add_between(double begin, double end);
  double most_width_ = 0.0;  // of a piece, for the delay

  const TerminationDiscs* discs_ = nullptr;
  double period_ = 0.0;
  AliasSums sums_;
  std::vector<AliasSums::Singularity> singularities_;  // of the filters and of the images
  std::vector<Piece> pieces_;
  std::size_t first_pieces_ = 0;
};

}  // namespace zwidth::internal

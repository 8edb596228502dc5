#pragma once

namespace zwidth::internal {

/// A step of a body whose dry friction bends before it slides.
struct PreslidingStep {
  /// A number at the step's end, and how it changes.
  struct End {
    double value = 0.0;
    double by_before = 0.0;      ///< velocity at the step's beginning
    double by_free = 0.0;        ///< velocity at its end without friction
    double by_limit = 0.0;       ///< friction of a body that slides
    double by_compliance = 0.0;  ///< velocity at the end by a constant force
    double by_bend = 0.0;        ///< bend at the beginning
    double by_length = 0.0;      ///< presliding length
  };
  End velocity;
  End bend;
};

/// Dahl's law over a step in which all other forces are constant: the force is limit * bend, -1 <= bend <= 1,
///
///     d bend / dx = (1 - sign(dx) bend) / length
///
/// so that friction bends like a spring of limit / length after each turn and is Coulomb's for a length of 0. Parts of the step
/// whose force is that of their ends, none where the body slides all along: exact then, else to the first order of a part.
/// Without slopes: the values alone.
/// Source: Dahl 1968; de Wit et al. 1995 without the bristles' damping.
[[nodiscard]] PreslidingStep presliding_step(double before, double free, double limit, double compliance, double bend,
                                             double length, double duration, bool with_slopes = true);

}  // namespace zwidth::internal

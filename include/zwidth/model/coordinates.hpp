#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace zwidth {

/// A linear device in n generalised coordinates q, in place of bodies and links: a mechanism at a pose.
///
///     M q'' + (sum_e d_e w_e w_e') q' + (sum_e k_e w_e w_e') q = sum_p w_p f_p,     x_p = w_p' q
///
/// The loop names points: a force at a point acts on the coordinates with the weights with which it moves.
struct Coordinates {
  /// A spring and a damper along a length w' q: a joint's own, or a cable over several of them.
  struct Element {
    std::vector<double> weights;  ///< n
    double stiffness = 0.0;       ///< >= 0
    double damping = 0.0;         ///< >= 0, and stiffness + damping > 0
  };
  /// Coulomb friction along a length w' q; no limit depends on it.
  struct Friction {
    std::vector<double> weights;  ///< n
    double force = 0.0;           ///< > 0
  };
  /// What moves by w' q.
  struct Point {
    std::string name;             ///< for people
    std::vector<double> weights;  ///< n, not all 0
  };
  /// How the tip of a mechanism moves, in the world's frame: 3 x n each, row by row.
  struct Tip {
    /// J; at a singular pose, where the tip moves along fewer directions than beside, then J towards each of some poses
    /// beside, 3 x n each, of which the rows that J lacks count, not their size
    std::vector<double> moved;
    std::vector<double> sensed;  ///< as the controller knows it, in the directions in which the wall acts; else 0
    std::vector<double> pushed;  ///< as the controller pushes it, likewise
    std::array<double, 3> normal = {};  ///< of the wall, of any length; 0 of one in every direction
  };
  std::vector<double> mass;              ///< n x n, row by row; symmetric and positive definite
  std::vector<Element> elements;         ///< all that is stiff or damped
  std::vector<Point> points;             ///< what the loop can name
  std::vector<Friction> frictions = {};  ///< all that rubs
  std::optional<Tip> tip = {};           ///< of a mechanism, whose user holds it in every direction
  /// n
  [[nodiscard]] std::size_t size() const noexcept { return points.empty() ? 0 : points.front().weights.size(); }
};

}  // namespace zwidth

#pragma once

#include <complex>
#include <vector>

#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

// The crossings of a loop (K + B v) P that a grid of frequencies shows: where a function changes its sign between two of
// them, found to rounding. Others may lie between, so that what is seen bounds the loop from above: a wall that falls
// short of its margins as it is seen does fall short of them, for a hundredth of the cost of isolating every crossing.
class SeenCrossings {
 public:
  // A frequency, rad per sample, with P and B v there.
  struct Point {
    double angle = 0.0;
    std::complex<double> plant;
    std::complex<double> damper;
    bool is_clear = false;  // of rounding: see is_clear_of_rounding()
  };

  // `points`: by rising angle, the last one at pi; `plant` must outlive this.
  SeenCrossings(const FilteredPlant& plant, VirtualDamper damper, std::vector<Point> points);

  // Whether P keeps ten digits at this angle.
  [[nodiscard]] static bool is_clear_of_rounding(const FilteredPlant& plant, double angle);

  // No less than the end of the stable stiffnesses that begin at 0.
  [[nodiscard]] double limit() const;

  // No less than LoopsOfStiffness::slack() of a stable loop.
  [[nodiscard]] double slack(double stiffness, double gain_margin, double phase_margin) const;

 private:
  // Calls `found` with every place where the condition changes its sign.
  template <typename Condition, typename Found>
  void for_each_crossing(const Condition& condition, const Found& found) const;
  [[nodiscard]] Point at(double angle) const;

  const FilteredPlant& plant_;
  VirtualDamper damper_;
  std::vector<Point> points_;
};

}  // namespace zwidth::internal

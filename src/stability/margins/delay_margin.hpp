#pragma once

#include <optional>
#include <vector>

#include "stability/margins/unit_gain.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// A stable loop to whose delay a share of a sample is added.
class DelayedLoop {
 public:
  DelayedLoop() = default;
  DelayedLoop(const DelayedLoop&) = delete;
  DelayedLoop& operator=(const DelayedLoop&) = delete;
  virtual ~DelayedLoop() = default;

  // All its gain crossovers, by rising angle.
  [[nodiscard]] virtual std::vector<UnitGainPoint> points_at(double share) const = 0;
  // log |L| at Nyquist of what crosses 1 there; it is real.
  [[nodiscard]] virtual double level_at_nyquist(double share) const = 0;
  // Of one locus no two crossovers pass each other in angle; eigenvalues of several directions may.
  [[nodiscard]] virtual bool has_one_locus() const = 0;
  [[nodiscard]] virtual double period() const = 0;
  // rad/s: the quickest motion of the crossovers is that of the fastest mode between two samples.
  [[nodiscard]] virtual double fastest_mode() const = 0;
};

// The least delay, s, that added to the loop's own puts a pole on the unit circle. Nothing where no delay does: |L| < 1 at
// every angle and every fraction of a sample.
//
// With t samples of delay in all, P_t = z^-m P_(t - m): at which angles |L_t| = 1, and how much lag takes each of
// these points to -1, is periodic in t but for the lag's m * angle. So one period holds everything. It is followed in
// steps that are halved until every crossover has one successor; a pair that is born or dies is looked at for
// whether it straddles -1, and one that is born or dies alone, at Nyquist, for whether it does so at -1. The least m + fraction is then solved to rounding.
[[nodiscard]] std::optional<double> least_delay(const DelayedLoop& loop);

// Of the device with its own wall, stable as it is.
[[nodiscard]] std::optional<double> exact_delay_margin(const Device& device);

}  // namespace zwidth::internal

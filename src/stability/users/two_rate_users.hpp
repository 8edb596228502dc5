#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth::internal {

// The limit over all passive users of a device whose damper runs in a loop of its own. At each frequency of the damper's band
// the plant fills a disc; closing the damper maps it to a disc,
//
//     p -> p/(1 + g p), g = B v:   centre (c + conj(g) A)/D,  radius r/D,   A = |c|² - r²,  D = 1 + 2 Re[g c] + |g|² A
//
// and the discs of the N aliases of the spring's rate add up: the user may be another at each. Source: docs/theory.md, "Two rates".
//
// Where the delays differ by no whole periods of the damper, the spring's plant is apart from z^-m p by what the aliases beyond
// the damper's rate turn by; a disc of its own holds that, and the limit is a bound: every K below is safe, some above may be.
//
// Nothing unless bounds_all_users() (any_user_limit.hpp). The least over all frequencies is that of a grid, refined at its minima; what lies between
// is not shown to be higher. Throws as absolute_stability_limit().
[[nodiscard]] std::optional<AbsoluteStabilityLimit> two_rate_absolute_stability(const Device& device,
                                                                                const CriticalStiffness& nobody);

// The least K that some user does not allow at one frequency, `angle` in rad per period of the spring, 0 < angle <= pi; infinite
// where there is none. `device`: of a loop that knows_all_users().
[[nodiscard]] double two_rate_limit_at(const Device& device, double angle);

// The limit over all passive users of one device with many dampers, for searches.
class TwoRateUsers {
 public:
  // `device`: of a loop that bounds_all_users().
  explicit TwoRateUsers(const Device& device);
  TwoRateUsers(TwoRateUsers&&) noexcept;
  TwoRateUsers& operator=(TwoRateUsers&&) noexcept;
  TwoRateUsers(const TwoRateUsers&) = delete;
  TwoRateUsers& operator=(const TwoRateUsers&) = delete;
  ~TwoRateUsers();

  // two_rate_absolute_stability() with this damper; `nobody`: of the device that nobody holds, with it.
  [[nodiscard]] AbsoluteStabilityLimit limit(VirtualDamper damper, const CriticalStiffness& nobody) const;

  // The B, rising, at which the limit of limit_on_grid() falls to 0 or rises from it: of either, the damper alone.
  [[nodiscard]] std::vector<double> ends_of_damper(double velocity_filter_hz) const;

  // The least K over a grid of frequencies, without the limit of nobody and without refinement between them: at least
  // two_rate_absolute_stability().
  [[nodiscard]] double limit_on_grid(VirtualDamper damper) const;

  // The least K that some user does not allow at this frequency, in rad/s, up to Nyquist of the spring; infinite where there
  // is none.
  [[nodiscard]] double limit_at(double frequency, VirtualDamper damper) const;

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

}  // namespace zwidth::internal

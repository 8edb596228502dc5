#pragma once

#include <memory>
#include <optional>

#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth::internal {

// The limit over all passive users of a device whose damper runs in a loop of its own and is closed. At each frequency of the
// damper's rate the plant fills a disc; closing the damper maps it to a disc,
//
//     p -> p/(1 + g p), g = B v:   centre (c + conj(g) A)/D,  radius r/D,   A = |c|² - r²,  D = 1 + 2 Re[g c] + |g|² A
//
// and the N aliases of the spring's rate, at each of which a user may be another, add up. Source: theory, section 8.
//
// Nothing where the damper is the slower one, and where the delays of the two differ by no whole number of the damper's periods:
// their paths would see the aliases with different phases. The least over all frequencies is found by a scan, and not shown
// to be the least in between. Throws as absolute_stability_limit().
[[nodiscard]] std::optional<AbsoluteStabilityLimit> two_rate_absolute_stability(const Device& device,
                                                                                const CriticalStiffness& nobody);

// Whether the limit over all passive users of such a device is known: where two_rate_absolute_stability() gives one.
[[nodiscard]] bool knows_all_users(const Loop& loop);

// absolute_stability_limit() of the device with the damper of its wall, of one rate or two. Nothing where it is not known; refused
// where the limit that nobody holds is.
[[nodiscard]] std::optional<AbsoluteStabilityLimit> any_user_limit(const Device& device, const Progress& progress = {});

// The same; throws Error (invalid_argument) as require_one_rate() where it is not known.
[[nodiscard]] AbsoluteStabilityLimit known_any_user_limit(const Device& device, const Progress& progress = {});

// The least K that some user does not allow at one frequency, `angle` in rad per period of the spring, 0 < angle <= pi; infinite
// where there is none. `device`: of a loop that knows_all_users().
[[nodiscard]] double two_rate_limit_at(const Device& device, double angle);

// The limit over all passive users of one device with many dampers, for searches.
class TwoRateUsers {
 public:
  // `device`: of a loop that knows_all_users().
  explicit TwoRateUsers(const Device& device);
  TwoRateUsers(TwoRateUsers&&) noexcept;
  TwoRateUsers& operator=(TwoRateUsers&&) noexcept;
  TwoRateUsers(const TwoRateUsers&) = delete;
  TwoRateUsers& operator=(const TwoRateUsers&) = delete;
  ~TwoRateUsers();

  // The least K at the frequencies looked at, never below two_rate_absolute_stability(): refined between none of them, and
  // without the limit of nobody.
  [[nodiscard]] double limit_seen(VirtualDamper damper) const;

  // The least K that some user does not allow at this frequency, in rad/s, up to Nyquist of the spring; infinite where there
  // is none.
  [[nodiscard]] double limit_at(double frequency, VirtualDamper damper) const;

 private:
  struct Looks;
  std::unique_ptr<Looks> looks_;
};

}  // namespace zwidth::internal

#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {

/// Who holds the device. Every limit and verdict is of one of these, under the same name everywhere.
enum class Holder : std::uint8_t { nobody, user, any_user };

/// "nobody holding", "the file's user", "any passive user".
[[nodiscard]] std::string_view words_of(Holder holder);

/// The limits that one holder of the device leaves.
struct HolderLimit {
  /// K_CR; 0 where soft walls are unstable, infinite where none is, NaN where refused.
  double critical_stiffness = std::numeric_limits<double>::quiet_NaN();
  std::optional<double> frequency = {};               ///< rad/s, where the loop oscillates there; absent unless finite
  std::optional<Oscillator> limited_by = {};          ///< what oscillates; absent for any passive user
  std::optional<double> critical_damping = {};        ///< the largest B at K = 0; infinite where none is too large
  std::optional<double> damping_frequency = {};       ///< rad/s, where the loop oscillates at that B
  std::optional<Oscillator> damping_limited_by = {};  ///< what oscillates there
};

/// The limits with nobody holding, with the file's user and with any passive user.
struct HoldingLimits {
  HolderLimit nobody;                        ///< a person always lets go
  std::optional<HolderLimit> user = {};      ///< absent without an [operator]
  std::optional<HolderLimit> any_user = {};  ///< absent where it is not asked for, or there is none
};

/// Whom a wall is stable with. A pole at z = 1 of a position that nothing holds (K = 0) is no instability.
struct StableFor {
  bool nobody = false;                ///< holding
  std::optional<bool> user = {};      ///< absent without an [operator]
  std::optional<bool> any_user = {};  ///< absent where the limit with any passive user is
};

/// The verdict on a wall in one word. A person always lets go: `alone_only` and `anyone` need nobody and the file's user.
enum class WallStability : std::uint8_t {
  anyone,      ///< stable with nobody, the file's user and any passive user
  alone_only,  ///< stable with nobody and the file's user; some passive user destabilises it, or that is not known
  unstable     ///< with nobody, or with the file's user
};

/// anyone, alone_only or unstable.
[[nodiscard]] WallStability stability_of(const StableFor& wall);

/// "stable for anyone", "stable alone only", "unstable": the words of every text, figure and page.
[[nodiscard]] std::string_view words_of(WallStability stability);

}  // namespace zwidth

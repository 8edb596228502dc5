#pragma once

#include <optional>

#include "stability/users/absolute_stability_search.hpp"
#include "zwidth/design/wall_number.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// What a proposed change does to the limit with any passive user: that of K, or of a damper alone.
class AbsoluteStabilityCheck {
 public:
  // Judges nothing of a device that no user can hold. `progress` must outlive this; several threads may tell it.
  AbsoluteStabilityCheck(const Device& device, WallNumber number, const Progress& progress);

  struct Limit {
    double value = 0.0;      // infinite where nobody can destabilise a wall
    double frequency = 0.0;  // as AbsoluteStabilityLimit::frequency
    double truncation = 0.0;
    Trust trust;
  };
  // Of the device as it is; absent where there is none, or it is not found.
  [[nodiscard]] const std::optional<Limit>& limit_now() const { return now_; }
  [[nodiscard]] std::optional<double> now() const { return now_ ? std::optional(now_->value) : std::nullopt; }

  struct Judgement {
    std::optional<double> then;  // infinite where nobody can destabilise a wall
    std::optional<bool> safe;    // known to be no lower than now; absent where that is not known
  };
  [[nodiscard]] Judgement of(const Device& changed) const;
  // The same of K where `users` are those of the changed device: for many dampers.
  [[nodiscard]] Judgement of(const Device& changed, AbsoluteStabilitySearch& users) const;

 private:
  [[nodiscard]] Judgement judged(const std::optional<Limit>& limit) const;

  WallNumber number_;
  const Progress& progress_;
  std::optional<Limit> now_;
};

// The limit with any passive user; nothing where it is not known (any_user_limit()). Throws where it is not found.
[[nodiscard]] std::optional<AbsoluteStabilityCheck::Limit> absolute_stability_limit_of(const Device& device,
                                                                                       WallNumber number,
                                                                                       const Progress& progress);

}  // namespace zwidth::internal

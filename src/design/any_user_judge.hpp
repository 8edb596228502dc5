#pragma once

#include <optional>

#include "stability/any_user_search.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// What a proposed change does to the limit with any passive user.
class AnyUserJudge {
 public:
  // Judges nothing of a device that no user can hold. `progress` must outlive this; several threads may tell it.
  AnyUserJudge(const Device& device, const Progress& progress);

  // Of the device as it is; absent where there is none, or it is not found.
  [[nodiscard]] std::optional<double> now() const { return now_ ? std::optional(now_->stiffness) : std::nullopt; }
  [[nodiscard]] const std::optional<AnyUserLimit>& limit_now() const { return now_; }

  struct Judgement {
    std::optional<double> then;  // infinite where nobody can destabilise a wall
    std::optional<bool> safe;    // the limit is no lower than now, as far as both are known
  };
  [[nodiscard]] Judgement of(const Device& changed) const;
  // The same where `users` are those of the changed device: for many dampers.
  [[nodiscard]] Judgement of(const Device& changed, AnyUserSearch& users) const;

 private:
  [[nodiscard]] Judgement judged(const std::optional<AnyUserLimit>& limit) const;

  const Progress& progress_;
  std::optional<AnyUserLimit> now_;
};

}  // namespace zwidth::internal

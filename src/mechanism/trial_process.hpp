#pragma once

#include <functional>

namespace zwidth::internal {

// Whether the work ends in a process of its own within some seconds, by returning or throwing: what it does there stays
// there, and a crash too. False also where no process can be made.
[[nodiscard]] bool ends_in_trial(const std::function<void()>& work);

}  // namespace zwidth::internal

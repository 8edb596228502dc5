#pragma once

#include <functional>

namespace zwidth {

/// Called repeatedly by long work (on a device of ten bodies every 50 ms or so) with the fraction done, 0..1, never
/// falling; may be empty. Throwing from it ends the work: the exception passes through. Called from any thread of the
/// work, never from two at once.
using Progress = std::function<void(double fraction)>;

}  // namespace zwidth

#pragma once

#include <functional>

namespace zwidth {

/// Called now and then by long work with the fraction done, 0..1, never falling; may be empty. Throwing from it ends
/// the work: the exception passes through.
using Progress = std::function<void(double fraction)>;

}  // namespace zwidth

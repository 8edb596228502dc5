#include "zwidth/stability/absolute_stability.hpp"

#include "stability/users/absolute_stability_search.hpp"

namespace zwidth {
using namespace internal;

AbsoluteStabilityLimit absolute_stability_limit(const Device& device, VirtualDamper damper, const Progress& progress) {
  return AbsoluteStabilitySearch(device, progress).limit(damper, progress);
}

}  // namespace zwidth

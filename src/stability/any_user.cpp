#include "zwidth/stability/any_user.hpp"

#include "stability/any_user_search.hpp"

namespace zwidth {
using namespace internal;

AnyUserLimit any_user_limit(const Device& device, VirtualDamper damper, const Progress& progress) {
  return AnyUserSearch(device, progress).limit(damper, progress);
}

}  // namespace zwidth

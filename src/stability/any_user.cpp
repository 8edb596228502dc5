#include "zwidth/stability/any_user.hpp"

#include "stability/any_user_search.hpp"

namespace zwidth {
using namespace internal;

AnyUserLimit any_user_limit(const Device& device, VirtualDamper damper) { return AnyUserSearch(device).limit(damper); }

}  // namespace zwidth

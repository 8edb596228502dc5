#include "zwidth/stability/holding.hpp"

namespace zwidth {

WallStability stability_of(const StableFor& wall) {
  if (!wall.nobody || !wall.user.value_or(true)) return WallStability::unstable;
  return wall.any_user.value_or(false) ? WallStability::anyone : WallStability::alone_only;
}

}  // namespace zwidth

#include "zwidth/stability/holding.hpp"

namespace zwidth {

std::string_view words_of(Holder holder) {
  switch (holder) {
    case Holder::nobody:
      return "nobody holding";
    case Holder::user:
      return "the file's user";
    case Holder::any_user:
      break;
  }
  return "any passive user";
}

WallStability stability_of(const StableFor& wall) {
  if (!wall.nobody || !wall.user.value_or(true)) return WallStability::unstable;
  return wall.any_user.value_or(false) ? WallStability::anyone : WallStability::alone_only;
}

std::string_view words_of(WallStability stability) {
  switch (stability) {
    case WallStability::anyone:
      return "stable for anyone";
    case WallStability::alone_only:
      return "stable alone only";
    case WallStability::unstable:
      break;
  }
  return "unstable";
}

}  // namespace zwidth

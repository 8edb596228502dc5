#include "zwidth/stability/holder_limit.hpp"

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

std::string unstable_with(const StableFor& wall) {
  std::string with;
  const auto add = [&with](Holder holder) {
    with.append(with.empty() ? "with " : " and with ").append(words_of(holder));
  };
  if (!wall.nobody) add(Holder::nobody);
  if (!wall.user.value_or(true)) add(Holder::user);
  return with;
}

}  // namespace zwidth

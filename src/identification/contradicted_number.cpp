#include "identification/contradicted_number.hpp"

#include <fmt/format.h>

namespace zwidth::internal {

std::string contradiction_reason(const ContradictedNumber& number) {
  return fmt::format(
      "{} was not fitted, and the recordings contradict it: they ask for about {:.3g} where {:.3g} is taken, in SI "
      "units; free it too",
      number.key, number.shown, number.given);
}

}  // namespace zwidth::internal

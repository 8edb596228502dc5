#include "identification/contradicted_number.hpp"

namespace zwidth::internal {

Finding contradiction(const ContradictedNumber& number) {
  return {.code = FindingCode::fixed_parameter_inconsistent,
          .evidence = {{"shown", number.shown}, {"given", number.given}},
          .key = number.key};
}

}  // namespace zwidth::internal

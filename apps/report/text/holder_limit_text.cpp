#include "report/text/holder_limit_text.hpp"

#include <cmath>

#include "report/text/quantity.hpp"

namespace zwidth::report {

std::string holder_limit_text(const HolderLimit& limit, std::string_view unit) {
  if (std::isnan(limit.critical_stiffness)) return "refused";
  if (std::isinf(limit.critical_stiffness)) return "every wall is stable";
  if (limit.critical_stiffness == 0.0) return "none: no wall is stable from K = 0 on";
  return quantity(limit.critical_stiffness, unit);
}

}  // namespace zwidth::report

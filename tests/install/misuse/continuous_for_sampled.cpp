// A continuous model has no critical stiffness: only its sampled loop has.

#include "zwidth/zwidth.hpp"

zwidth::CriticalStiffness critical(const zwidth::ModalForm& form) {
#ifdef MISUSE
  return zwidth::critical_stiffness(form);
#else
  return zwidth::critical_stiffness(zwidth::filtered_plant(zwidth::sample(form, {.period = 1e-3}), {}));
#endif
}

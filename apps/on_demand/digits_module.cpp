#include "on_demand/on_demand.hpp"

using namespace zwidth;

const void* zwidth_module_functions() {
  static constexpr on_demand::Digits functions{internal::exact_modal_form, internal::sample_exactly,
                                               internal::unstable_poles_in_digits, internal::polish_poles_in_digits};
  return &functions;
}

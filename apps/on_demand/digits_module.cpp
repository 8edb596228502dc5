#include "on_demand/on_demand.hpp"

using namespace zwidth;

on_demand::Module zwidth_digits() {
  static constexpr on_demand::Digits functions{internal::exact_modal_form, internal::sample_exactly,
                                               internal::unstable_poles_in_digits, internal::polish_poles_in_digits};
  return {on_demand::build, &functions};
}

#include "on_demand/on_demand.hpp"

using namespace zwidth;

on_demand::Module zwidth_kernel() {
  static constexpr on_demand::Kernel functions{internal::solve_group};
  return {on_demand::build, &functions};
}

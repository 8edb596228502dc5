#include "on_demand/on_demand.hpp"

const void* zwidth_module_functions() {
  static constexpr zwidth::on_demand::Kernel functions{zwidth::internal::solve_group};
  return &functions;
}

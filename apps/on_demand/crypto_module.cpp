#include "on_demand/on_demand.hpp"

using namespace zwidth;

const void* zwidth_module_functions() {
  static constexpr on_demand::Crypto functions{server::sha256, server::equal_in_constant_time};
  return &functions;
}

#include "on_demand/on_demand.hpp"

using namespace zwidth;

on_demand::Module zwidth_crypto() {
  static constexpr on_demand::Crypto functions{server::sha256, server::equal_in_constant_time};
  return {on_demand::build, &functions};
}

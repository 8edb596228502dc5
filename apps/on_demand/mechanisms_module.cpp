#include "on_demand/on_demand.hpp"

using namespace zwidth;

on_demand::Module zwidth_mechanisms() {
  static constexpr on_demand::Mechanisms functions{internal::open_mujoco_file};
  return {on_demand::build, &functions};
}

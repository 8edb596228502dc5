#include "on_demand/on_demand.hpp"

using namespace zwidth;

on_demand::Module zwidth_fits() {
  static constexpr on_demand::Fits functions{internal::least_squares, internal::open_mat73_file,
                                             study_engine::write_result};
  return {on_demand::build, &functions};
}

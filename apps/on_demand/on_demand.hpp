#pragma once

// What the program loads at the first call: functions of the library, the studies and the server whose own libraries take longer
// to load than an answer takes. A module holds them and those libraries. The program holds a stand-in of the same name
// for each (stand_ins.cpp), which asks the module; all others that link with the library have the functions themselves.

#include "batch/kernel/stiffness_kernel.hpp"
#include "identification/initial_fit/least_squares.hpp"
#include "io/mat73_file.hpp"
#include "mechanism/mujoco_file.hpp"
#include "model/exact_modal_form.hpp"
#include "sampling/exact_sampling.hpp"
#include "server/api/digest.hpp"
#include "stability/second_route/pole_count.hpp"
#include "study/study_result_file.hpp"

namespace zwidth::on_demand {

/// What the program, or the module, was built from: of another build, a function's types may be others.
[[gnu::visibility("hidden")]] extern const char* const build;

/// What a module exports, by the name that the struct of its functions has for it.
struct Module {
  const char* build;
  const void* functions;
};

/// With Ceres and HDF5.
struct Fits {
  static constexpr const char* file = "fits-" ZWIDTH_VERSION ".so";
  static constexpr const char* name = "zwidth_fits";
  decltype(internal::least_squares)* least_squares;
  decltype(internal::open_mat73_file)* open_mat73_file;
  decltype(study_engine::write_result)* write_result;
};

/// With FLINT and Arb.
struct Digits {
  static constexpr const char* file = "digits-" ZWIDTH_VERSION ".so";
  static constexpr const char* name = "zwidth_digits";
  decltype(internal::exact_modal_form)* exact_modal_form;
  decltype(internal::sample_exactly)* sample_exactly;
  decltype(internal::unstable_poles_in_digits)* unstable_poles_in_digits;
  decltype(internal::polish_poles_in_digits)* polish_poles_in_digits;
};

/// With Highway.
struct Kernel {
  static constexpr const char* file = "kernel-" ZWIDTH_VERSION ".so";
  static constexpr const char* name = "zwidth_kernel";
  decltype(internal::solve_group)* solve_group;
};

/// With OpenSSL.
struct Crypto {
  static constexpr const char* file = "crypto-" ZWIDTH_VERSION ".so";
  static constexpr const char* name = "zwidth_crypto";
  decltype(server::sha256)* sha256;
  decltype(server::equal_in_constant_time)* equal_in_constant_time;
};

/// With MuJoCo and tinyxml2, where the build has it.
struct Mechanisms {
  static constexpr const char* file = "mechanisms-" ZWIDTH_VERSION ".so";
  static constexpr const char* name = "zwidth_mechanisms";
  decltype(internal::open_mujoco_file)* open_mujoco_file;
};

}  // namespace zwidth::on_demand

extern "C" {
[[gnu::visibility("default")]] zwidth::on_demand::Module zwidth_fits();
[[gnu::visibility("default")]] zwidth::on_demand::Module zwidth_digits();
[[gnu::visibility("default")]] zwidth::on_demand::Module zwidth_kernel();
[[gnu::visibility("default")]] zwidth::on_demand::Module zwidth_crypto();
[[gnu::visibility("default")]] zwidth::on_demand::Module zwidth_mechanisms();
}

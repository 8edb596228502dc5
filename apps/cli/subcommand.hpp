#pragma once

#include <CLI/App.hpp>
#include <stdexcept>
#include <string>

#include "zwidth/error.hpp"

namespace zwidth::cli {

/// Wrong usage or bad input: main prints every line of the message and exits with status 2.
struct BadInput : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The work itself failed (cannot write, does not converge): main prints the message and exits with status 1.
struct WorkFailed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs the library's work on what is called `name` (a file; empty: nothing). What it could not compute is WorkFailed;
/// what it refuses to compute lies in the input: BadInput.
template <typename Work>
auto worked(const std::string& name, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    const std::string text = (name.empty() ? "" : name + ": ") + error.what();
    if (error.code() == ErrorCode::did_not_converge) throw WorkFailed(text);
    throw BadInput(text);
  }
}

// Each adds one command to the program, in a file of its name. A command's footer is "Examples:" and one line
// "  zwidth ..." per example; the tests run every one of them beside a copy of devices/.
void add_analyze(CLI::App& app);
void add_bode(CLI::App& app);
void add_design(CLI::App& app);
void add_diagnose(CLI::App& app);
void add_excite(CLI::App& app);
void add_export(CLI::App& app);
void add_frf(CLI::App& app);
void add_identify(CLI::App& app);
void add_region(CLI::App& app);
void add_relay(CLI::App& app);
void add_reproduce(CLI::App& app);
void add_rig(CLI::App& app);
void add_serve(CLI::App& app);
void add_simulate(CLI::App& app);
void add_study(CLI::App& app);

}  // namespace zwidth::cli

#pragma once

#include <CLI/App.hpp>

#include "rig/flight_recorder.hpp"

namespace zwidth::cli {

/// Writes the record of a rig that stopped, where nobody said where, or there it could not be written: into a file of its own in $XDG_STATE_HOME/zwidth, else
/// ~/.local/state/zwidth, else the directory for temporary files. Says on standard error where it is, or that it is
/// nowhere, and why; throws nothing.
void keep_flight_record(const CLI::App& command, const rig::FlightRecorder& recorder) noexcept;

}  // namespace zwidth::cli

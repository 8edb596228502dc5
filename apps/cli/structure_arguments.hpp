#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zwidth/identification/identification.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth::cli {

/// The structure that a command fits to data: a device file, or a named one whose numbers need no guess.
struct StructureArguments {
  std::string structure;                  ///< a device file, "-", or rigid, two-body, three-body
  std::vector<std::string> overrides;     ///< KEY=VALUE of every --set
  std::string motion;                     ///< of a named structure; empty: by the record
  std::optional<double> sampling_period;  ///< s, of the loop to judge; else the structure's, else the record's
  std::vector<std::string> free;          ///< keys, or "all"
  std::vector<std::string> locked;        ///< names of bodies
  const CLI::App* command = nullptr;      ///< whose options these are
};

/// Declares --structure, --set, --motion, --sampling-period, --free and --locked; `arguments` must outlive the parsing.
void add_structure_arguments(CLI::App& command, StructureArguments& arguments);

/// --motion; nothing where it was not given.
[[nodiscard]] std::optional<Motion> asked_motion(const StructureArguments& arguments);

/// A structure to fit, and whether its numbers are known.
struct Structure {
  Device device;
  IdentifyOptions::StructureValues values = IdentifyOptions::StructureValues::known;
};

/// The structure as asked for, its parameters and bodies checked to be those that --free and --locked name.
/// `record_period` is the record's sampling period, where it has one; a named structure moves as the recordings' columns
/// state, unless it is asked for. Throws BadInput.
[[nodiscard]] Structure structure(const StructureArguments& arguments, std::optional<double> record_period,
                                  std::span<const Recording> recordings);

}  // namespace zwidth::cli

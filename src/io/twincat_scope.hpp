#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "io/exported_columns.hpp"
#include "io/text_lines.hpp"

namespace zwidth::internal {

/// Whether a text begins as the CSV export of TwinCAT Scope does: "Name", then "File" or more of "Name".
[[nodiscard]] bool is_twincat_scope(std::string_view text);

/// Reads the export of TwinCAT Scope:
///
///     Name  PROJECT                           a preamble of key and value: File, Starttime of export, ...
///     Name  F   x   Name  T                   the channels; each "Name" begins a group with a time column of its own
///     Unit  N   mm  Unit  C                   lines of metadata, any of them: SymbolName, SampleTime[ms], ...
///     0     1   2   0     20                  rows: a time in ms, or in 100 ns since 1601, and the channels' values
///     1     3   4                             a group that has ended or waits has no cells, or empty ones
///     EOF                                     where it was asked for
///
/// A slow channel's row that the export repeats is counted once.
/// Refused, with the line: a row with another number of cells, a time that is no number, a line of text among rows.
/// Source: Beckhoff Information System, TE13xx TwinCAT 3 Scope View, Export to csv.
[[nodiscard]] tl::expected<ExportedColumns, InputError> read_twincat_scope(TextLines lines,
                                                                           const RecordingOptions& options,
                                                                           const Progress& progress);

}  // namespace zwidth::internal

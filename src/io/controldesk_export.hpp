#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "io/exported_columns.hpp"
#include "io/text_lines.hpp"

namespace zwidth::internal {

/// Whether a text is a CSV export of dSPACE ControlDesk: one of its lines begins with "trace_values".
[[nodiscard]] bool is_controldesk_export(std::string_view text);

/// Reads the CSV export of dSPACE ControlDesk:
///
///     trace_names,,F,x                    lines of metadata: a key, nothing or a name for the times, a value a signal
///     path,,Model Root/Out/F,Model Root/In/x
///     unit,s,N,m
///     trace_values,0.0,1.5,0.25           from this line on rows, the first cell of the others empty: time, values
///     ,0.001,1.6,0.26
///                                         an empty line ends a section; the next has signals of another raster
///
/// Signals are called by trace_names, else by the last part of their path.
/// Refused, with the line: a row with another number of cells, a time that is no number, values without names.
[[nodiscard]] tl::expected<ExportedColumns, InputError> read_controldesk_export(TextLines lines,
                                                                                const RecordingOptions& options,
                                                                                const Progress& progress);

}  // namespace zwidth::internal

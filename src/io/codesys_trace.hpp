#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "io/exported_columns.hpp"
#include "io/text_lines.hpp"

namespace zwidth::internal {

/// Whether a text begins as a trace of CODESYS does: "[key]; [value]".
[[nodiscard]] bool is_codesys_trace(std::string_view text);

/// Reads a trace that CODESYS has saved as *.trace.csv:
///
///     [key]; [value]
///     Flags; 16                 the packet's: 16 (bit 4) times in ms, 32 (bit 5) in us
///     0.Variable; PLC_PRG.F     then the variable's settings
///     0.Data;
///     ; 2; 30.5                 its samples: time; value
///     1.Variable; PLC_PRG.x     the next variable, with times of its own
///
/// The columns are the variables in their order; then come their times.
/// Refused, with the line: samples outside of a block of data, a sample that is not time and value, flags that state no
/// unit of time where the options state none.
/// Source: CODESYS, CmpTraceMgr, TRACE_PACKET_FLAGS; CODESYS Trace, Save trace.
[[nodiscard]] tl::expected<ExportedColumns, InputError> read_codesys_trace(TextLines lines,
                                                                           const RecordingOptions& options,
                                                                           const Progress& progress);

}  // namespace zwidth::internal

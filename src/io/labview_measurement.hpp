#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "io/exported_columns.hpp"
#include "io/text_lines.hpp"

namespace zwidth::internal {

/// Whether a text begins as a LabVIEW measurement file (.lvm) does: "LabVIEW Measurement".
[[nodiscard]] bool is_labview_measurement(std::string_view text);

/// Reads a LabVIEW measurement file: a header, then segments, each of a header, a line of names and rows. A tag and what
/// belongs to it stand in one line:
///
///     Separator, Decimal_Separator, X_Columns   of the file: Tab or a character; a mark; One, Multi or No
///     Channels, Samples, Date, Time             of a segment, for each channel in the column of its values
///     X0, Delta_X, Y_Unit_Label, X_Dimension
///     ***End_of_Header***
///     X_Value  F  x  Comment
///
/// A sample's time is that of its column of X values (One, Multi), or X0 + i Delta_X (No, and channels of another
/// Delta_X than that column), counted from the segment's date and time. Special blocks and comments are passed over.
/// Segments follow each other by their dates and times; rows beyond Samples without X values are a doubt, since the
/// pause before them is not in the file.
/// Refused, with the line: a file that ends in a header, segments of different columns, X values that are no numbers.
/// Source: NI, Specification for the LabVIEW Measurement File (.lvm).
[[nodiscard]] tl::expected<ExportedColumns, InputError> read_labview_measurement(TextLines lines,
                                                                                 const RecordingOptions& options,
                                                                                 const Progress& progress);

}  // namespace zwidth::internal

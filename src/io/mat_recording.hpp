#pragma once

#include <string>
#include <tl/expected.hpp>

#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// Reads a recording from a MAT file, version 5 or 7.3.
///
/// A column is a real numeric array of any class: a vector by its name ("force"), a column of a matrix by the matrix's
/// name and the column's number from 1 ("data.3"), what a struct holds by a dotted name ("run.position"), what an
/// element of a struct array holds by its number ("run(2).position").
/// What holds no such column (text, cells, sparse arrays, complex numbers, MATLAB objects) is skipped with a remark.
/// A single number (a sampling rate) is never used unasked, but named where the rate is missing. Refused: version 4, a
/// file of nothing else, a damaged file.
[[nodiscard]] tl::expected<Recording, InputError> read_mat_recording(const std::string& path,
                                                                     const RecordingOptions& options,
                                                                     const Progress& progress = {});

/// The columns that read_mat_recording() finds; single numbers are in a remark.
[[nodiscard]] tl::expected<RecordingContents, InputError> list_mat_recording(const std::string& path,
                                                                             const RecordingOptions& options = {},
                                                                             const Progress& progress = {});

}  // namespace zwidth::internal

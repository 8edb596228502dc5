#pragma once

#include <string>
#include <tl/expected.hpp>

#include "io/mat_contents.hpp"

namespace zwidth::internal {

/// Opens a MAT file of version 7.3, an HDF5 file in which MATLAB keeps a dataset for each array and a group for each
/// struct. `path` is also its name in errors. Refused: what HDF5 cannot open.
/// Read with HDF5 itself, so that what a dataset claims to hold is compared with what it stores before any of it is
/// read.
/// Not read: what lies in other files (external links and storage), so that a file cannot name a file of the user's.
[[nodiscard]] tl::expected<MatFile, InputError> open_mat73_file(const std::string& path);

}  // namespace zwidth::internal

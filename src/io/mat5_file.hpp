#pragma once

#include <tl/expected.hpp>

#include "io/input_file.hpp"
#include "io/mat_contents.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

/// Opens a MAT file of version 5: walks through all of its variables, of which one at a time is in memory, and checks
/// them. A variable whose bytes contradict each other is skipped as damaged.
/// Refused: a file that ends inside a variable, that holds something else between its variables, or whose compressed
/// variables unpack to more than `most_unpacked` bytes in all.
/// Own code rather than matio: that library (1.5.23) gives zeros for the samples that a file's end cuts off.
[[nodiscard]] tl::expected<MatFile, InputError> open_mat5_file(InputFile file, std::size_t most_unpacked,
                                                               const Progress& progress);

}  // namespace zwidth::internal

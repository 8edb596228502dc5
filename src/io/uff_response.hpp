#pragma once

#include <string>
#include <tl/expected.hpp>

#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// Reads a frequency response function (function type 4) of a universal file, as read_response_table() promises:
/// `options.real` names the record (empty: the only one), `options.coherence` a record of function type 6.
/// A velocity per force is divided by jw and an acceleration by -w^2, where the file says that it is one: with a
/// remark.
[[nodiscard]] tl::expected<FrequencyResponse, InputError> read_uff_response(const std::string& path,
                                                                            const ResponseTableOptions& options,
                                                                            const Progress& progress);

}  // namespace zwidth::internal

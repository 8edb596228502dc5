#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "zwidth/io/input_error.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/study/study_distributions.hpp"

namespace zwidth {

/// What a study file says. What it leaves out is absent.
struct StudyFile {
  StudyDistributions distributions;        ///< what varies, and together with what
  std::optional<SamplingScheme> sampling;  ///< absent: not said
  std::optional<std::uint64_t> samples;    ///< absent: not said
  std::optional<std::uint64_t> seed;       ///< absent: not said
  Specification specification;             ///< what a unit must reach
};

/// Reads a study of the device from TOML text.
///
/// `folder` is where the files of distribution = "file" are looked for; without one, that is refused. Values not given are the device's own (a mean, a
/// median, a mode). Every refusal has its place. Never throws on any bytes. `source` names the text in errors.
[[nodiscard]] tl::expected<StudyFile, InputError> parse_study(std::string_view text, std::string_view source,
                                                              const Device& device,
                                                              const std::optional<std::string>& folder = ".");

/// Reads a study file; files that it names are looked for beside it.
[[nodiscard]] tl::expected<StudyFile, InputError> read_study_file(const std::string& path, const Device& device);

}  // namespace zwidth

#include "zwidth/io/recording_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <new>
#include <string_view>
#include <utility>

#include "io/input_file.hpp"
#include "io/mat_recording.hpp"
#include "io/prose.hpp"
#include "io/recording_channels.hpp"
#include "io/recording_format.hpp"
#include "io/text_lines.hpp"
#include "io/text_recording.hpp"
#include "io/uff_recording.hpp"
#include "zwidth/model/device_key.hpp"

namespace zwidth {
using namespace internal;
namespace {

/// A recording that is open, and what it is.
struct OpenRecording {
  RecordingFormat format = RecordingFormat::text;
  TextLines lines;
};

tl::expected<OpenRecording, InputError> open_recording(const std::string& path, RecordingFormat asked) {
  auto file = InputFile::open(path, "recording");
  if (!file) return tl::unexpected(std::move(file.error()));
  auto lines = TextLines::start(std::move(*file));
  if (!lines) return tl::unexpected(std::move(lines.error()));
  const RecordingFormat format = asked == RecordingFormat::detect ? format_of(lines->buffered()) : asked;
  if (format != RecordingFormat::text && !lines->file().is_regular()) {
    const std::string_view name = format == RecordingFormat::mat ? "MAT" : "UFF";
    return tl::unexpected(InputError{lines->file().source(), 0, 0, "",
                                     "has the format " + std::string(name) + ", which cannot be read from a pipe",
                                     "must be text, or a file given by its name"});
  }
  return OpenRecording{format, std::move(*lines)};
}

InputError too_large(const std::string& path) {
  return {path == "-" ? "standard input" : path,
          0,
          0,
          "",
          "does not fit into memory",
          "must be shorter, or have fewer columns asked for"};
}

}  // namespace

std::optional<OptionProblem> find_problem(const RecordingOptions& options) {
  const auto is_positive = [](const std::optional<double>& value) {
    return !value || (std::isfinite(*value) && *value > 0.0);
  };
  if (!is_positive(options.rate))
    return OptionProblem{"rate", fmt::format("is {} Hz", *options.rate), "must be above 0"};
  if (options.rate && !positive_numbers.contains(*options.rate)) {
    return option_problem("rate", {.code = ProblemCode::not_between,
                                   .evidence = {{"value", *options.rate, "Hz"},
                                                {"least", positive_numbers.least},
                                                {"most", positive_numbers.greatest}}});
  }
  if (!is_positive(options.time_scale)) {
    return OptionProblem{"time_scale", fmt::format("is {} s", *options.time_scale), "must be above 0"};
  }
  for (std::size_t i = 0; i < options.columns.size(); ++i) {
    const double scale = options.columns[i].scale.value_or(1.0);
    if (std::isfinite(scale) && scale != 0.0) continue;
    return OptionProblem{fmt::format("columns.{}.scale", i), fmt::format("is {}", scale), "must be finite and not 0"};
  }
  if (options.delimiter && options.decimal_mark && *options.delimiter == *options.decimal_mark) {
    return OptionProblem{"decimal_mark", "is the delimiter", "they must differ"};
  }
  return std::nullopt;
}

tl::expected<Recording, InputError> read_recording(const std::string& path, const RecordingOptions& options,
                                                   const Progress& progress) try {
  check_recording_options(options);
  if (options.rate && options.time_column) {
    return tl::unexpected(InputError{path == "-" ? "standard input" : path, 0, 0, shortened(*options.time_column),
                                     "a column of times is asked for beside a rate", "must be one of the two"});
  }
  auto input = open_recording(path, options.format);
  if (!input) return tl::unexpected(std::move(input.error()));
  switch (input->format) {
    case RecordingFormat::mat:
      return read_mat_recording(path, options, progress);
    case RecordingFormat::uff:
      return read_uff_recording(path, options, progress);
    default:
      return read_text_recording(std::move(input->lines), options, progress);
  }
} catch (const std::bad_alloc&) {
  return tl::unexpected(too_large(path));
}

tl::expected<RecordingContents, InputError> list_recording(const std::string& path, const RecordingOptions& options,
                                                           const Progress& progress) try {
  auto input = open_recording(path, options.format);
  if (!input) return tl::unexpected(std::move(input.error()));
  switch (input->format) {
    case RecordingFormat::mat:
      return list_mat_recording(path, options, progress);
    case RecordingFormat::uff:
      return list_uff_recording(path, options, progress);
    default:
      return list_text_recording(std::move(input->lines), options, progress);
  }
} catch (const std::bad_alloc&) {
  return tl::unexpected(too_large(path));
}

}  // namespace zwidth

#include "zwidth/io/recording_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <new>
#include <string_view>
#include <utility>

#include "io/column_unit.hpp"
#include "io/input_file.hpp"
#include "io/mat_recording.hpp"
#include "io/prose.hpp"
#include "io/recording_channels.hpp"
#include "io/recording_format.hpp"
#include "io/text_lines.hpp"
#include "io/text_recording.hpp"
#include "io/time_axis.hpp"
#include "io/uff_recording.hpp"
#include "model/option_beyond.hpp"
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
    return tl::unexpected(
        InputError{{.file = lines->file().source()},
                   {.code = ProblemCode::format_needs_a_file, .subjects = {{"format", std::string(name)}}}});
  }
  return OpenRecording{format, std::move(*lines)};
}

InputError too_large(const std::string& path) {
  return {{.file = path == "-" ? "standard input" : path}, {.code = ProblemCode::does_not_fit_in_memory}};
}

/// What the function for the file's format finds in it.
template <typename OfFile, typename OfText>
auto by_format(const std::string& path, const RecordingOptions& options, const Progress& progress, OfFile& of_mat,
               OfFile& of_uff, OfText& of_text) -> decltype(of_mat(path, options, progress)) try {
  auto input = open_recording(path, options.format);
  if (!input) return tl::unexpected(std::move(input.error()));
  switch (input->format) {
    case RecordingFormat::mat:
      return of_mat(path, options, progress);
    case RecordingFormat::uff:
      return of_uff(path, options, progress);
    default:
      return of_text(std::move(input->lines), options, progress);
  }
} catch (const std::bad_alloc&) {
  return tl::unexpected(too_large(path));
}

}  // namespace

std::optional<OptionProblem> find_problem(const RecordingOptions& options) {
  const auto is_positive = [](const std::optional<double>& value) {
    return !value || (std::isfinite(*value) && *value > 0.0);
  };
  if (!is_positive(options.rate)) return not_above_zero("rate", *options.rate, "Hz");
  if (options.rate) {
    if (auto problem = option_beyond("rate", *options.rate, positive_numbers, "Hz")) return problem;
  }
  if (!is_positive(options.time_scale)) return not_above_zero("time_scale", *options.time_scale, "s");
  for (std::size_t i = 0; i < options.columns.size(); ++i) {
    const double scale = options.columns[i].scale.value_or(1.0);
    if (std::isfinite(scale) && scale != 0.0) continue;
    return option_problem(fmt::format("columns.{}.scale", i),
                          {.code = ProblemCode::scale_not_possible, .evidence = {{"value", scale}}});
  }
  if (options.delimiter && options.decimal_mark && *options.delimiter == *options.decimal_mark) {
    return option_problem("decimal_mark", {.code = ProblemCode::decimal_mark_is_delimiter});
  }
  return std::nullopt;
}

tl::expected<Recording, InputError> read_recording(const std::string& path, const RecordingOptions& options,
                                                   const Progress& progress) {
  check_recording_options(options);
  if (options.rate && options.time_column) {
    return tl::unexpected(
        InputError{{.file = path == "-" ? "standard input" : path, .key = shortened(*options.time_column)},
                   {.code = ProblemCode::asked_for_beside, .subjects = {{"of", "times"}}}});
  }
  return by_format(path, options, progress, read_mat_recording, read_uff_recording, read_text_recording);
}

tl::expected<RecordingContents, InputError> list_recording(const std::string& path, const RecordingOptions& options,
                                                           const Progress& progress) {
  auto contents = by_format(path, options, progress, list_mat_recording, list_uff_recording, list_text_recording);
  if (!contents) return contents;
  for (RecordingColumn& each : contents->columns) each.unit = unit_of_column(each.name).text;
  return contents;
}

}  // namespace zwidth

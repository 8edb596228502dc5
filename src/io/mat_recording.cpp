#include "io/mat_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "io/column_names.hpp"
#include "io/input_file.hpp"
#include "io/mat5_file.hpp"
#include "io/mat73_file.hpp"
#include "io/mat_contents.hpp"
#include "io/prose.hpp"
#include "io/recording_channels.hpp"
#include "io/time_axis.hpp"

namespace zwidth::internal {
namespace {

using Kind = SkippedMatArray::Kind;
using Refusal = tl::unexpected<InputError>;

constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1A\n";
constexpr std::size_t most_scalars_shown = 24;

/// A signal: a vector, or a column of a matrix.
struct Signal {
  std::string name;
  std::size_t array = 0;   ///< index among the file's arrays
  std::size_t column = 0;  ///< from 0
  std::size_t size = 0;
};

/// An open file, its signals by name, and its single numbers.
struct MatTable {
  std::string source;
  MatFile file;
  std::vector<Signal> signals;
  std::vector<std::string> names;    ///< of the signals
  std::vector<std::size_t> scalars;  ///< indices among the file's arrays

  [[nodiscard]] const MatArray& array(std::size_t index) const { return file.contents.arrays[index]; }
  [[nodiscard]] std::string size_of(std::size_t index) const {
    return fmt::format("{} {}x{}", array(index).class_name, array(index).rows, array(index).columns);
  }
};

InputError damaged_file(const std::string& source, std::string version) {
  return {{.file = source}, {.code = ProblemCode::damaged_file, .subjects = {{"version", std::move(version)}}}};
}

std::string shown_name(const std::string& name) { return name.empty() ? "unnamed" : shortened(name); }

/// "force (is text)"
std::string with_reason(const std::string& name, const Problem& why) {
  return fmt::format("{} ({})", shown_name(name), input_problem({}, why).what);
}

tl::expected<MatFile, InputError> open_mat_file(const std::string& path, std::size_t most_unpacked,
                                                const Progress& progress) {
  auto file = InputFile::open(path, "MAT file");
  if (!file) return Refusal(std::move(file.error()));
  std::string head(640, '\0');
  const auto size = file->read(head);
  if (!size) return Refusal(size.error());
  head.resize(*size);
  const auto has = [&](std::size_t place, std::string_view bytes) {
    return head.size() >= place && std::string_view(head).substr(place).starts_with(bytes);
  };
  using namespace std::string_view_literals;
  if (has(0, hdf5_signature) || has(512, hdf5_signature)) return open_mat73_file(path);
  if (has(124, "\x00\x01IM"sv) || has(124, "\x01\x00MI"sv)) {
    if (auto sought = file->seek(0); !sought) return Refusal(std::move(sought.error()));
    return open_mat5_file(std::move(*file), most_unpacked, progress);
  }
  if (has(0, "MATLAB 7.3"sv)) return Refusal(damaged_file(path, "7.3"));
  if (has(0, "MATLAB 5.0"sv)) return Refusal(damaged_file(path, "5"));
  return Refusal(InputError({.file = path}, {.code = ProblemCode::unknown_version}));
}

/// "a (is text), b (is complex)"
std::string names_of(const std::vector<SkippedMatArray>& skipped, Kind kind, bool with_reasons) {
  std::vector<std::string> names;
  for (const SkippedMatArray& array : skipped) {
    if (array.kind != kind) continue;
    names.push_back(with_reasons ? with_reason(array.name, array.why) : shown_name(array.name));
  }
  return listed(names);
}

std::vector<Remark> remarks_on_skipped(const std::vector<SkippedMatArray>& skipped) {
  std::vector<Remark> remarks;
  const auto add = [&](FindingCode code, Kind kind, bool with_reasons) {
    std::string names = names_of(skipped, kind, with_reasons);
    if (names.empty()) return;
    Finding found{.code = code, .subjects = {{"arrays", std::move(names)}}};
    remarks.push_back(kind == Kind::damaged ? warning(std::move(found)) : note(std::move(found)));
  };
  add(FindingCode::objects_skipped, Kind::object, false);
  add(FindingCode::not_numeric_skipped, Kind::other_class, true);
  add(FindingCode::complex_skipped, Kind::complex, false);
  add(FindingCode::no_signals_skipped, Kind::no_table, true);
  add(FindingCode::damaged_skipped, Kind::damaged, true);
  return remarks;
}

InputError nothing_to_read(const MatTable& table) {
  const auto& skipped = table.file.contents.skipped;
  const bool only_objects =
      table.scalars.empty() && !skipped.empty() &&
      std::all_of(skipped.begin(), skipped.end(), [](const auto& array) { return array.kind == Kind::object; });
  Problem none{.code = ProblemCode::holds_none, .subjects = {{"wanted", "signals"}}};
  if (only_objects) {
    none.subjects.push_back({"objects", names_of(skipped, Kind::object, false)});
    return {{.file = table.source}, std::move(none)};
  }
  std::vector<std::string> all;
  all.reserve(skipped.size() + table.scalars.size());
  for (const SkippedMatArray& array : skipped) all.push_back(with_reason(array.name, array.why));
  for (const std::size_t index : table.scalars) {
    all.push_back(with_reason(table.array(index).name, wrong_kind("a single number", "signal")));
  }
  if (!all.empty()) none.subjects.push_back({"others", listed(all)});
  return {{.file = table.source}, std::move(none)};
}

tl::expected<MatTable, InputError> open_table(const std::string& path, std::size_t most_unpacked,
                                              const Progress& progress) {
  auto file = open_mat_file(path, most_unpacked, progress);
  if (!file) return Refusal(std::move(file.error()));
  MatTable table{path, std::move(*file), {}, {}, {}};
  for (std::size_t i = 0; i < table.file.contents.arrays.size(); ++i) {
    const auto& [name, class_name, rows, columns] = table.array(i);
    if (rows * columns > most_unpacked / sizeof(double)) {
      return Refusal(
          InputError({.file = path, .key = shortened(name)},
                     {.code = ProblemCode::has_too_many,
                      .evidence = {counted("value", rows * columns), counted("most", most_unpacked / sizeof(double))},
                      .subjects = {{"what", "values"}}}));
    }
    if (rows == 1 && columns == 1) {
      table.scalars.push_back(i);
    } else if (rows == 1 || columns == 1) {
      table.signals.push_back({name, i, 0, rows * columns});
    } else {
      for (std::size_t c = 0; c < columns; ++c) {
        table.signals.push_back({fmt::format("{}.{}", name, c + 1), i, c, rows});
      }
    }
  }
  if (table.signals.empty()) return Refusal(nothing_to_read(table));
  for (const Signal& signal : table.signals) table.names.push_back(signal.name);
  return table;
}

/// Why something that the file has cannot be asked for; nothing where it has no such thing.
std::optional<InputError> why_no_signal(const MatTable& table, const std::string& asked) {
  const auto& contents = table.file.contents;
  const InputPlace place{.file = table.source, .key = shortened(asked)};
  for (const SkippedMatArray& array : contents.skipped) {
    if (array.name == asked) return InputError(place, array.why);
  }
  for (const MatArray& array : contents.arrays) {
    if (array.name != asked) continue;
    if (array.rows == 1 && array.columns == 1) {
      return InputError(place, wrong_kind("a single number", "signal"));
    }
    Problem matrix = wrong_kind("a matrix", "column");
    matrix.evidence = {counted("columns", array.columns)};
    matrix.subjects.push_back({"choices", fmt::format("{0}.1 to {0}.{1}", place.key, array.columns)});
    return InputError(place, std::move(matrix));
  }
  std::vector<std::string> fields;
  for (const std::string& name : table.names) {
    if (name.starts_with(asked + ".") || name.starts_with(asked + "(")) fields.push_back(shortened(name));
  }
  if (asked.empty() || fields.empty()) return std::nullopt;
  Problem structure = wrong_kind("a struct", "field");
  structure.subjects.push_back({"choices", listed(fields)});
  return InputError(place, std::move(structure));
}

tl::expected<std::size_t, InputError> find_signal(const MatTable& table, const std::string& asked) {
  std::vector<std::string> shown;
  for (const Signal& signal : table.signals) {
    shown.push_back(fmt::format("{} ({})", shortened(signal.name), table.size_of(signal.array)));
  }
  auto found = find_column(table.names, asked, table.source, shown);
  if (found) return found;
  if (auto why = why_no_signal(table, asked)) return Refusal(std::move(*why));
  return found;
}

std::string_view last_part(std::string_view name) { return name.substr(name.rfind('.') + 1); }

/// "fs = 2500", of a single number by its index among the file's arrays.
tl::expected<std::string, InputError> scalar_text(const MatTable& table, std::size_t index) {
  const auto values = table.file.values(index);
  if (!values) return Refusal(values.error());
  return fmt::format("{} = {:.9g}", shortened(table.array(index).name), values->front());
}

bool names_a_rate(std::string_view name) {
  constexpr std::array<std::string_view, 14> words{
      "fs", "f_s", "fsample", "rate",        "samplerate", "sample_rate",    "samplingrate", "sampling_rate",
      "ts", "t_s", "dt",      "sample_time", "sampletime", "sampling_period"};
  std::string lower(last_part(name));
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(words.begin(), words.end(), lower) != words.end();
}

/// No time axis; the single numbers that may be the rate are named, but never used unasked.
InputError no_time_axis_in(const MatTable& table, std::size_t size) {
  Problem problem{.code = ProblemCode::no_times, .evidence = {counted("samples", size)}};
  std::vector<std::string> rates;
  for (const std::size_t index : table.scalars) {
    if (!names_a_rate(table.array(index).name)) continue;
    if (const auto text = scalar_text(table, index)) rates.push_back(*text);
  }
  if (!rates.empty()) problem.subjects.push_back({"rates", listed(rates)});
  return {{.file = table.source}, std::move(problem)};
}

/// The column of times: the one asked for, or one of the signals' size whose name says time, best beside the first
/// signal in its struct. Only where a rate is given there may be none.
tl::expected<std::optional<std::size_t>, InputError> find_times(const MatTable& table, const RecordingOptions& options,
                                                                const Signal& first) {
  if (options.time_column) {
    const auto found = find_signal(table, *options.time_column);
    if (!found) return Refusal(found.error());
    return *found;
  }
  const auto parent = [](std::string_view name) { return name.substr(0, name.size() - last_part(name).size()); };
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < table.signals.size(); ++i) {
    const Signal& signal = table.signals[i];
    if (signal.size != first.size || !names_a_time(std::string(last_part(signal.name)))) continue;
    const bool beside = parent(signal.name) == parent(first.name);
    if (!best || (beside && parent(table.names[*best]) != parent(first.name))) best = i;
  }
  if (!best && !options.rate) return Refusal(no_time_axis_in(table, first.size));
  return best;
}

tl::expected<RawColumn, InputError> read_signal(const MatTable& table, const Signal& signal) {
  auto values = table.file.values(signal.array);
  if (!values) return Refusal(std::move(values.error()));
  if (signal.size < values->size()) {
    const auto begin = values->begin() + static_cast<std::ptrdiff_t>(signal.column * signal.size);
    values = std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(signal.size));
  }
  return RawColumn{table.source, signal.name, std::move(*values), {}};
}

}  // namespace

tl::expected<Recording, InputError> read_mat_recording(const std::string& path, const RecordingOptions& options,
                                                       const Progress& progress) {
  check_recording_options(options);
  const auto table = open_table(path, options.most_unpacked, progress);
  if (!table) return Refusal(table.error());
  std::vector<std::size_t> asked;
  for (const ColumnRequest& request : options.columns) {
    const auto found = find_signal(*table, request.name);
    if (!found) return Refusal(found.error());
    asked.push_back(*found);
  }
  const auto time = find_times(*table, options, table->signals[asked.front()]);
  if (!time) return Refusal(time.error());
  if (*time) asked.push_back(**time);

  const Signal& first = table->signals[asked.front()];
  std::vector<RawColumn> columns;
  for (const std::size_t index : asked) {
    const Signal& signal = table->signals[index];
    if (signal.size != first.size) {
      return Refusal(InputError({.file = table->source, .key = shortened(signal.name)},
                                {.code = ProblemCode::samples_of_two_lengths,
                                 .evidence = {counted("samples", signal.size), counted("expected", first.size)},
                                 .subjects = {{"other", shortened(first.name)}}}));
    }
    auto column = read_signal(*table, signal);
    if (!column) return Refusal(std::move(column.error()));
    columns.push_back(std::move(*column));
  }
  std::optional<RawColumn> times;
  if (*time) {
    times = std::move(columns.back());
    columns.pop_back();
  }
  auto recording = make_recording(std::move(columns), std::move(times), options);
  if (recording) {
    auto skipped = remarks_on_skipped(table->file.contents.skipped);
    recording->remarks.insert(recording->remarks.end(), skipped.begin(), skipped.end());
  }
  return recording;
}

tl::expected<RecordingContents, InputError> list_mat_recording(const std::string& path, const RecordingOptions& options,
                                                               const Progress& progress) {
  const auto table = open_table(path, options.most_unpacked, progress);
  if (!table) return Refusal(table.error());
  RecordingContents contents{RecordingFormat::mat, {}, remarks_on_skipped(table->file.contents.skipped)};
  for (const Signal& signal : table->signals) {
    contents.columns.push_back({signal.name, signal.size, table->size_of(signal.array)});
  }
  std::vector<std::string> scalars;
  for (const std::size_t index : table->scalars) {
    if (scalars.size() == most_scalars_shown) break;
    auto text = scalar_text(*table, index);
    if (!text) return Refusal(std::move(text.error()));
    scalars.push_back(std::move(*text));
  }
  if (!scalars.empty()) {
    contents.remarks.push_back(note(
        {.code = FindingCode::single_numbers, .subjects = {{"numbers", fmt::format("{}", fmt::join(scalars, ", "))}}}));
  }
  return contents;
}

}  // namespace zwidth::internal

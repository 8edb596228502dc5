#include "io/uff_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "counted.hpp"
#include "io/input_file.hpp"
#include "io/number_cell.hpp"
#include "io/prose.hpp"
#include "io/uff_number.hpp"
#include "io/whole_text.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

using Refusal = tl::unexpected<InputError>;

constexpr std::size_t largest_file = std::size_t{2} << 30;  // bytes
constexpr std::size_t largest_block = std::size_t{1} << 24;
constexpr std::size_t most_points = 1'000'000'000;
constexpr std::size_t header_lines = 11;  // of a function

bool is_boundary(std::string_view line) { return trimmed(line) == "-1"; }

/// The blank-trimmed field of a line that begins at a column (from 0); empty where the line is too short.
std::string_view field(std::string_view line, std::size_t column, std::size_t width) {
  return column < line.size() ? trimmed(line.substr(column, width)) : std::string_view();
}

template <class Integer>
std::optional<Integer> whole_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  return whole_text_as<Integer>(text);
}

/// A field of text; empty where it says NONE.
std::string text_field(std::string_view text) { return text == "NONE" ? std::string() : as_utf8(text); }

std::string id_line(std::string_view line) { return text_field(trimmed(line)); }

UffAxis axis_of(std::string_view line) {
  return {whole_number<int>(field(line, 0, 10)).value_or(0), text_field(field(line, 26, 20)),
          text_field(field(line, 47, 20))};
}

UffPoint point_of(std::string_view line, std::size_t column) {
  return {text_field(field(line, column, 10)), whole_number<long>(field(line, column + 10, 10)).value_or(0),
          whole_number<int>(field(line, column + 20, 4)).value_or(0)};
}

/// The fields of a function's seventh line, but for the sixth (z), which is not read.
struct DataForm {
  long type = 0;
  long points = 0;
  long spacing = -1;
  double first = 0.0;
  double step = 0.0;
  [[nodiscard]] bool is_sound() const {
    return (type == 2 || (type >= 4 && type <= 6)) && points > 0 && (spacing == 0 || spacing == 1);
  }
};

DataForm form_in_columns(std::string_view line) {
  const auto real = [&](std::size_t column) {
    std::string_view text = field(line, column, 13);
    return text.empty() ? 0.0 : take_fortran_number(text).value_or(std::nan(""));
  };
  return {whole_number<long>(field(line, 0, 10)).value_or(0), whole_number<long>(field(line, 10, 10)).value_or(0),
          whole_number<long>(field(line, 20, 10)).value_or(-1), real(30), real(43)};
}

/// For writers that do not keep to the columns.
DataForm form_in_words(std::string_view line) {
  std::array<double, 5> numbers{};
  std::size_t count = 0;
  while (count < numbers.size()) {
    const auto number = take_fortran_number(line);
    if (!number || !(std::abs(*number) < 1e15)) break;
    numbers[count++] = *number;
  }
  if (count < 3) return {};
  return {static_cast<long>(numbers[0]), static_cast<long>(numbers[1]), static_cast<long>(numbers[2]), numbers[3],
          numbers[4]};
}

class Scanner {
 public:
  Scanner(std::string_view bytes, const std::string& source) : bytes_(bytes), source_(source) {}

  tl::expected<void, InputError> scan(std::vector<UffRecord>& records, std::vector<Remark>& remarks);

 private:
  std::optional<std::string_view> next_line();
  /// The refusal of the line that was read last.
  [[nodiscard]] Refusal refused(Problem problem) const {
    return Refusal(InputError({.file = source_, .line = line_, .column = 1}, std::move(problem)));
  }
  /// The same, where a number of its header is out of its range.
  [[nodiscard]] Refusal wrong_field(std::string field, double value) const {
    return refused(
        {.code = ProblemCode::wrong_field, .evidence = {{"value", value}}, .subjects = {{"field", std::move(field)}}});
  }
  /// The same, where it is not what must stand there.
  [[nodiscard]] Refusal not_readable(std::string_view line, std::string wanted) const {
    return refused({.code = ProblemCode::text_not_readable,
                    .subjects = {{"text", in_quotes(as_utf8(trimmed(line)))}, {"wanted", std::move(wanted)}}});
  }
  bool pass_to_boundary();
  tl::expected<UffRecord, InputError> take_function(std::string_view dataset_line);
  tl::expected<void, InputError> read_form(std::string_view line, UffRecord& record) const;
  tl::expected<void, InputError> find_binary(UffRecord& record, std::size_t declared);
  tl::expected<void, InputError> find_text(UffRecord& record);
  [[nodiscard]] bool boundary_follows(std::size_t place) const;

  std::string_view bytes_;
  const std::string& source_;
  std::size_t place_ = 0;
  std::size_t line_ = 0;
  std::size_t unclosed_ = 0;  ///< line of a record that the file's end closes
};

std::optional<std::string_view> Scanner::next_line() {
  if (place_ >= bytes_.size()) return std::nullopt;
  const std::size_t end = std::min(bytes_.find('\n', place_), bytes_.size());
  std::string_view line = bytes_.substr(place_, end - place_);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  place_ = std::min(end + 1, bytes_.size());
  ++line_;
  return line;
}

bool Scanner::pass_to_boundary() {
  while (const auto line = next_line()) {
    if (is_boundary(*line)) return true;
  }
  return false;
}

bool Scanner::boundary_follows(std::size_t place) const {
  std::string_view rest = bytes_.substr(std::min(place, bytes_.size()));
  if (rest.starts_with("\r\n")) rest.remove_prefix(2);
  if (rest.starts_with("\n")) rest.remove_prefix(1);
  rest = rest.substr(0, rest.find('\n'));
  if (!rest.empty() && rest.back() == '\r') rest.remove_suffix(1);
  return is_boundary(rest);
}

tl::expected<void, InputError> Scanner::find_binary(UffRecord& record, std::size_t declared) {
  const std::size_t ordinates = record.points * (record.is_complex ? 2 : 1);
  const std::size_t abscissae = record.is_even ? 0 : record.points;
  const std::size_t width = record.is_double ? 8 : 4;
  const std::size_t size = (ordinates + abscissae) * width;
  const std::size_t mixed = ordinates * width + abscissae * 4;  // the header's formats taken by the letter
  record.data_begin = place_;
  record.single_abscissa = mixed < size && !boundary_follows(place_ + size) && boundary_follows(place_ + mixed);
  const std::size_t taken = record.single_abscissa ? mixed : size;
  if (!boundary_follows(place_ + taken)) {
    const std::size_t left = bytes_.size() - std::min(place_, bytes_.size());
    return refused({.code = left < taken ? ProblemCode::bytes_missing : ProblemCode::closing_line_missing,
                    .evidence = {counted("points", record.points), counted("bytes", taken), counted("left", left),
                                 counted("declared", declared)}});
  }
  record.data_end = place_ + taken;
  place_ = record.data_end;
  const std::size_t begin = bytes_.find_first_not_of("\r\n", place_);
  place_ = std::min(begin, bytes_.size());
  next_line();
  return {};
}

tl::expected<void, InputError> Scanner::find_text(UffRecord& record) {
  record.data_begin = place_;
  while (true) {
    record.data_end = std::min(place_, bytes_.size());
    const auto line = next_line();
    if (line && is_boundary(*line)) return {};
    if (!line) break;
  }
  unclosed_ = record.line;
  return {};
}

tl::expected<void, InputError> Scanner::read_form(std::string_view line, UffRecord& record) const {
  DataForm form = form_in_columns(line);
  if (!form.is_sound()) form = form_in_words(line);
  if (!form.is_sound() || form.points > static_cast<long>(most_points)) {
    return not_readable(line, "form");
  }
  record.is_complex = form.type >= 5;
  record.is_double = form.type == 4 || form.type == 6;
  record.points = static_cast<std::size_t>(form.points);
  record.is_even = form.spacing == 1;
  record.first = form.first;
  record.step = form.step;
  const bool rises = std::isfinite(form.first) && std::isfinite(form.step) && form.step > 0.0;
  if (record.is_even && !rises) {
    return refused({.code = ProblemCode::wrong_field,
                    .evidence = {{"value", form.step}, {"first", form.first}},
                    .subjects = {{"field", "step"}}});
  }
  return {};
}

tl::expected<UffRecord, InputError> Scanner::take_function(std::string_view dataset_line) {
  UffRecord record;
  record.line = line_;
  std::size_t declared = 0;
  if (dataset_line.size() > 6 && (dataset_line[6] == 'b' || dataset_line[6] == 'B')) {
    std::string_view rest = dataset_line.substr(7);
    std::array<double, 4> numbers{};  // byte order, number format, lines of header, bytes of data
    for (double& number : numbers) number = take_fortran_number(rest).value_or(0.0);
    if (numbers[0] != 1.0 && numbers[0] != 2.0) return wrong_field("byte order", numbers[0]);
    if (numbers[1] != 2.0) return wrong_field("number format", numbers[1]);
    if (numbers[2] != header_lines) return wrong_field("header length", numbers[2]);
    record.binary = numbers[0] == 1.0 ? ByteOrder::little : ByteOrder::big;
    declared = numbers[3] >= 0.0 && numbers[3] < 1e15 ? static_cast<std::size_t>(numbers[3]) : 0;
  }
  std::array<std::string_view, header_lines> header;
  for (std::size_t i = 0; i < header.size(); ++i) {
    const auto line = next_line();
    if (!line) {
      return refused({.code = ProblemCode::data_end_inside,
                      .evidence = {counted("lines", header_lines)},
                      .subjects = {{"part", "a function's header"}}});
    }
    header[i] = *line;
    if (i < 5) record.id_lines[i] = id_line(*line);
    if (i == 5) {
      std::string_view words = *line;
      const auto first_word = take_fortran_number(words);
      const auto type = whole_number<int>(field(*line, 0, 5));
      if (!type && !(first_word && std::abs(*first_word) < 1000.0)) {
        return not_readable(*line, "type");
      }
      record.function_type = type ? *type : static_cast<int>(*first_word);
      record.response = point_of(*line, 31);
      record.reference = point_of(*line, 56);
    }
    if (i == 6) {
      if (auto read = read_form(*line, record); !read) return Refusal(std::move(read.error()));
    }
  }
  record.abscissa = axis_of(header[7]);
  record.ordinate = axis_of(header[8]);
  record.denominator = axis_of(header[9]);
  record.data_line = line_ + 1;
  auto found = record.binary ? find_binary(record, declared) : find_text(record);
  if (!found) return Refusal(std::move(found.error()));
  return record;
}

tl::expected<void, InputError> Scanner::scan(std::vector<UffRecord>& records, std::vector<Remark>& remarks) {
  std::map<int, std::size_t> passed_over;
  while (const auto line = next_line()) {
    if (trimmed(*line).empty()) continue;
    if (!is_boundary(*line)) return not_readable(*line, "boundary");
    const auto dataset_line = next_line();
    if (!dataset_line) break;
    const auto dataset = whole_number<int>(field(*dataset_line, 0, 6));
    if (!dataset) return not_readable(*dataset_line, "dataset");
    if (*dataset == 58) {
      auto record = take_function(*dataset_line);
      if (!record) return Refusal(std::move(record.error()));
      records.push_back(std::move(*record));
    } else {
      ++passed_over[*dataset];
      const std::size_t begins = line_;
      if (!pass_to_boundary()) unclosed_ = begins;
    }
  }
  std::vector<std::string> numbers;
  numbers.reserve(passed_over.size());
  for (const auto& [dataset, count] : passed_over) numbers.push_back(std::to_string(dataset));
  if (records.empty()) {
    Problem none{.code = ProblemCode::holds_none, .subjects = {{"wanted", "function"}}};
    if (!numbers.empty()) none.subjects.push_back({"datasets", listed(numbers)});
    return Refusal(InputError({.file = source_}, std::move(none)));
  }
  if (!numbers.empty()) {
    remarks.push_back(note({.code = FindingCode::datasets_passed_over, .subjects = {{"datasets", listed(numbers)}}}));
  }
  if (unclosed_ > 0) {
    remarks.push_back(warning({.code = FindingCode::dataset_not_closed, .evidence = {counted("line", unclosed_)}}));
  }
  return {};
}

}  // namespace

tl::expected<UffFile, InputError> parse_uff(std::string bytes, const std::string& source) {
  UffFile file{source, std::move(bytes), {}, {}};
  Scanner scanner(file.bytes, file.source);
  if (auto scanned = scanner.scan(file.records, file.remarks); !scanned) return Refusal(std::move(scanned.error()));
  return file;
}

tl::expected<UffFile, InputError> read_uff_file(const std::string& path, const Progress& progress) {
  auto file = InputFile::open(path, "universal file");
  if (!file) return Refusal(std::move(file.error()));
  std::string bytes;
  // Of a file whose size is known one byte more is asked for, to see its end.
  const std::size_t block = file->size() > 0 && file->size() < largest_file ? file->size() + 1 : largest_block;
  for (std::size_t count = block; count == block;) {
    const std::size_t size = bytes.size();
    if (size >= largest_file) {
      return Refusal(InputError({.file = file->source()}, {.code = ProblemCode::has_too_many,
                                                           .evidence = {counted("most", largest_file >> 30)},
                                                           .subjects = {{"what", "GiB"}}}));
    }
    bytes.resize(size + block);
    const auto read = file->read({bytes.data() + size, block});
    if (!read) return Refusal(read.error());
    count = *read;
    bytes.resize(size + count);
    if (progress && file->size() > 0) {
      progress(std::min(1.0, static_cast<double>(bytes.size()) / static_cast<double>(file->size())));
    }
  }
  return parse_uff(std::move(bytes), file->source());
}

}  // namespace zwidth::internal

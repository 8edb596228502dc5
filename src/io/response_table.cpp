#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "band_problem.hpp"
#include "io/input_file.hpp"
#include "io/prose.hpp"
#include "io/recording_format.hpp"
#include "io/response_columns.hpp"
#include "io/response_lines.hpp"
#include "io/text_lines.hpp"
#include "io/text_table.hpp"
#include "io/time_axis.hpp"
#include "io/uff_response.hpp"
#include "zwidth/io/message_words.hpp"
#include "zwidth/io/recording_file.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Refusal = tl::unexpected<InputError>;

/// Reads the rows of a text table.
class RowReader {
 public:
  RowReader(TextTable& table, const ResponseColumns& columns, double step)
      : table_(table), columns_(columns), step_(step) {
    const std::vector<std::string> names = table.names();
    const auto find = [&](const char* name) {
      return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    };
    verdict_ = find("trust");
    reasons_ = find("trust_reasons");
  }

  tl::expected<void, InputError> add(const TextRow& row);

  std::vector<ResponseLine> lines;
  std::optional<Trust> trust;  ///< as the table says

 private:
  void add_trust(const TextRow& row);
  tl::expected<double, InputError> number(const TextRow& row, std::size_t column);
  tl::expected<std::complex<double>, InputError> value(const TextRow& row);

  TextTable& table_;
  const ResponseColumns& columns_;
  double step_;
  std::size_t verdict_ = 0;  ///< columns; as many as there are: absent
  std::size_t reasons_ = 0;
};

/// The worst verdict of all lines, the reasons of each.
void RowReader::add_trust(const TextRow& row) {
  using enum Trust::Verdict;
  if (verdict_ >= row.cells.size()) return;
  Trust said;
  for (const auto& [word, verdict] :
       {std::pair{"sound", sound}, std::pair{"doubtful", doubtful}, std::pair{"refused", refused}}) {
    if (row.cells[verdict_] != word) continue;
    said.verdict = verdict;
    if (!trust) trust.emplace();
  }
  if (!trust) return;
  std::string_view left = reasons_ < row.cells.size() ? std::string_view(row.cells[reasons_]) : std::string_view();
  while (!left.empty()) {
    const std::size_t end = std::min(left.find(between_reasons), left.size());
    said.reasons.emplace_back(left.substr(0, end));
    left.remove_prefix(std::min(left.size(), end + std::string_view(between_reasons).size()));
  }
  trust->inherit(said);
  trust->verdict = std::max(trust->verdict, said.verdict);
}

tl::expected<double, InputError> RowReader::number(const TextRow& row, std::size_t column) {
  const NumberCell cell = table_.number(row.cells[column]);
  if (cell.kind == NumberCell::Kind::text) return Refusal(table_.no_number(row, column));
  return cell.value;
}

tl::expected<std::complex<double>, InputError> RowReader::value(const TextRow& row) {
  using Form = ResponseColumns::Form;
  if (columns_.form == Form::complex) {
    if (const auto complex = table_.complex_number(row.cells[columns_.first])) return *complex;
    if (table_.number(row.cells[columns_.first]).kind == NumberCell::Kind::missing) return std::nan("");
    return Refusal(
        InputError{table_.place(row, columns_.first),
                   {.code = ProblemCode::no_number_in_cell,
                    .subjects = {{"cell", in_quotes(as_utf8(row.cells[columns_.first]))}, {"as", "complex"}}}});
  }
  const auto first = number(row, columns_.first);
  if (!first) return Refusal(first.error());
  const auto second = number(row, columns_.second);
  if (!second) return Refusal(second.error());
  if (columns_.form == Form::real_and_imaginary) return std::complex<double>(*first, *second);
  if (!columns_.magnitude_in_db && *first < 0.0) {
    return Refusal(InputError{table_.place(row, columns_.first),
                              {.code = ProblemCode::magnitude_below_zero, .evidence = {{"value", *first}}}});
  }
  const double magnitude = columns_.magnitude_in_db ? std::pow(10.0, *first / 20.0) : *first;
  const double phase = columns_.phase_in_degrees ? *second * std::numbers::pi / 180.0 : *second;
  return std::complex<double>(magnitude * std::cos(phase), magnitude * std::sin(phase));
}

tl::expected<void, InputError> RowReader::add(const TextRow& row) {
  ResponseLine line;
  line.line = row.line.number;
  line.frequency = static_cast<double>(lines.size()) * step_;
  if (columns_.frequency) {
    const auto frequency = number(row, *columns_.frequency);
    if (!frequency) return Refusal(frequency.error());
    line.frequency = *frequency * columns_.frequency_scale;
  }
  const auto response = value(row);
  if (!response) return Refusal(response.error());
  line.value = *response;
  if (columns_.coherence) {
    const auto coherence = number(row, *columns_.coherence);
    if (!coherence) return Refusal(coherence.error());
    line.coherence = *coherence;
  }
  lines.push_back(line);
  add_trust(row);
  return {};
}

tl::expected<FrequencyResponse, InputError> read_text_response(TextLines text, const ResponseTableOptions& options,
                                                               const Progress& progress) {
  auto table = TextTable::open(std::move(text), options.file);
  if (!table) return Refusal(std::move(table.error()));
  const auto names = table->names();
  const auto columns = find_response_columns(names, options, table->source());
  if (!columns) return Refusal(columns.error());
  RowReader rows(*table, *columns, options.frequency_step);
  auto read = table->each_row([&](const TextRow& row) { return rows.add(row); }, progress);
  if (!read) return Refusal(std::move(read.error()));
  auto response = make_response(std::move(rows.lines), options, table->source());
  if (!response) return response;
  response->trust = std::move(rows.trust);
  auto& remarks = response->remarks;
  remarks.insert(remarks.end(), columns->remarks.begin(), columns->remarks.end());
  remarks.insert(remarks.end(), table->remarks().begin(), table->remarks().end());
  return response;
}

tl::expected<FrequencyResponse, InputError> read_whole_table(const std::string& path,
                                                             const ResponseTableOptions& options,
                                                             const Progress& progress) {
  auto file = InputFile::open(path, "response table");
  if (!file) return Refusal(std::move(file.error()));
  auto text = TextLines::start(std::move(*file));
  if (!text) return Refusal(std::move(text.error()));
  const bool detect = options.file.format == RecordingFormat::detect;
  const RecordingFormat format = detect ? format_of(text->buffered()) : options.file.format;
  const auto refused = [&](Problem problem) {
    return Refusal(InputError{{.file = text->file().source()}, std::move(problem)});
  };
  if (format == RecordingFormat::mat) {
    return refused({.code = ProblemCode::no_text_table, .subjects = {{"kind", "mat"}}});
  }
  if (format == RecordingFormat::text) return read_text_response(std::move(*text), options, progress);
  if (!text->file().is_regular()) {
    return refused({.code = ProblemCode::format_needs_a_file, .subjects = {{"format", "UFF"}}});
  }
  return read_uff_response(path, options, progress);
}

}  // namespace

std::optional<OptionProblem> find_problem(const ResponseTableOptions& options) {
  const auto not_positive = [](const std::optional<double>& value) {
    return value && !(std::isfinite(*value) && *value > 0.0);
  };
  if (auto problem = find_problem(options.file)) return problem;
  if (!std::isfinite(options.scale) || options.scale == 0.0) {
    return option_problem("scale", {.code = ProblemCode::scale_not_possible, .evidence = {{"value", options.scale}}});
  }
  if (not_positive(options.frequency_scale)) {
    return option_problem("frequency_scale", {.code = ProblemCode::not_finite_and_positive,
                                              .evidence = {{"value", *options.frequency_scale}}});
  }
  if (!(std::isfinite(options.frequency_step) && options.frequency_step >= 0.0)) {
    return option_problem("frequency_step", {.code = ProblemCode::frequency_out_of_range,
                                             .evidence = {{"hertz", hertz(options.frequency_step)}, {"step", 1.0}}});
  }
  if (not_positive(options.sampling_period)) {
    return not_above_zero("sampling_period", *options.sampling_period, "s");
  }
  return find_band_problem(options.lowest, options.highest);
}

tl::expected<FrequencyResponse, InputError> read_response_table(const std::string& path,
                                                                const ResponseTableOptions& options,
                                                                const Progress& progress) try {
  require_valid(find_problem(options));
  ResponseTableOptions decided = options;
  if (!decided.sampling_period && options.file.rate) decided.sampling_period = 1.0 / *options.file.rate;
  auto response = read_whole_table(path, decided, progress);
  if (!response) return response;
  std::erase_if(response->points, [&](const ResponsePoint& point) {
    return (options.lowest && point.frequency < *options.lowest) ||
           (options.highest && point.frequency > *options.highest);
  });
  if (response->points.empty()) {
    InputPlace place{.file = path == "-" ? "standard input" : path};
    if (options.lowest || options.highest) place.option = options.lowest ? "lowest" : "highest";
    return Refusal(InputError{std::move(place), {.code = ProblemCode::no_line_in_band}});
  }
  return response;
} catch (const std::bad_alloc&) {
  return Refusal(
      InputError{{.file = path == "-" ? "standard input" : path}, {.code = ProblemCode::does_not_fit_in_memory}});
}

}  // namespace zwidth

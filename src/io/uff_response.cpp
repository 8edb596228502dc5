#include "io/uff_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <complex>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "io/prose.hpp"
#include "io/response_lines.hpp"
#include "io/uff_file.hpp"
#include "io/uff_names.hpp"
#include "io/uff_values.hpp"
#include "uff_function_name.hpp"

namespace zwidth::internal {
namespace {

using Refusal = tl::unexpected<InputError>;

bool is_response(const UffRecord& record) {
  return record.is_complex &&
         (record.function_type == uff_frequency_response ||
          (record.function_type == uff_unknown_function && record.abscissa.quantity == uff_frequency));
}

tl::expected<std::size_t, InputError> find_response(const UffFile& file, const std::string& asked) {
  if (!asked.empty()) {
    const auto found = find_uff_record(file, asked);
    if (found && !is_response(file.records[*found])) {
      return Refusal(wrong_record(file, file.records[*found], asked, "response"));
    }
    return found;
  }
  const auto names = uff_names(file);
  std::vector<std::string> responses;
  std::vector<std::string> others;
  std::size_t found = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_response(file.records[i])) {
      responses.push_back(shortened(names[i]));
      found = i;
    } else {
      others.push_back(fmt::format("{} ({})", shortened(names[i]), uff_function_name(file.records[i].function_type)));
    }
  }
  if (responses.size() == 1) return found;
  if (responses.empty()) {
    return Refusal(InputError(
        {.file = file.source},
        {.code = ProblemCode::holds_none, .subjects = {{"wanted", "frequency response"}, {"others", listed(others)}}}));
  }
  return Refusal(InputError({.file = file.source}, {.code = ProblemCode::not_one_record,
                                                    .evidence = {counted("records", responses.size())},
                                                    .subjects = {{"choices", listed(responses)}}}));
}

/// What turns the ordinate into a position, and how that is said.
struct ToPosition {
  int derivatives = 0;  ///< of the position that the ordinate is
  Remark remark;
};

std::optional<ToPosition> to_position(const UffRecord& record) {
  switch (record.ordinate.quantity) {
    case uff_displacement:
      return std::nullopt;
    case uff_velocity:
      return ToPosition{1, note({.code = FindingCode::response_of_velocity})};
    case uff_acceleration:
      return ToPosition{2, note({.code = FindingCode::response_of_acceleration})};
    default:
      break;
  }
  Finding found{.code = FindingCode::response_of_unknown_quantity,
                .evidence = {{"quantity", static_cast<double>(record.ordinate.quantity)}}};
  if (!record.ordinate.unit.empty()) found.subjects.push_back({"unit", shortened(record.ordinate.unit)});
  return ToPosition{0, warning(std::move(found))};
}

tl::expected<std::vector<double>, InputError> read_coherence(const UffFile& file, const std::string& asked,
                                                             const std::vector<double>& frequencies) {
  const auto index = find_uff_record(file, asked);
  if (!index) return Refusal(index.error());
  const UffRecord& record = file.records[*index];
  if (record.function_type != uff_coherence || record.is_complex) {
    return Refusal(wrong_record(file, record, asked, "coherence"));
  }
  auto values = read_uff_values(file, record);
  if (!values) return Refusal(std::move(values.error()));
  if (values->abscissa != frequencies) {
    return Refusal(InputError(
        {.file = file.source, .line = record.line, .column = 1, .key = shortened(asked)},
        {.code = ProblemCode::axes_differ, .subjects = {{"axis", "frequencies"}, {"other", "the response"}}}));
  }
  return std::move(values->ordinate);
}

}  // namespace

tl::expected<FrequencyResponse, InputError> read_uff_response(const std::string& path,
                                                              const ResponseTableOptions& options,
                                                              const Progress& progress) {
  const auto file = read_uff_file(path, progress);
  if (!file) return Refusal(file.error());
  for (const std::string& column : {options.frequency, options.magnitude, options.phase, options.imaginary}) {
    if (column.empty()) continue;
    return Refusal(
        InputError({.file = file->source, .key = shortened(column)}, {.code = ProblemCode::file_without_columns}));
  }
  const auto index = find_response(*file, options.real);
  if (!index) return Refusal(index.error());
  const UffRecord& record = file->records[*index];
  const auto values = read_uff_values(*file, record);
  if (!values) return Refusal(values.error());

  std::vector<ResponseLine> lines(values->abscissa.size());
  const auto conversion = to_position(record);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    lines[i].frequency = values->abscissa[i] * options.frequency_scale.value_or(2.0 * std::numbers::pi);
    lines[i].value = {values->ordinate[i], values->imaginary[i]};
    const std::complex<double> s(0.0, lines[i].frequency);
    const bool at_rest = lines[i].frequency == 0.0;
    for (int k = 0; conversion && !at_rest && k < conversion->derivatives; ++k) lines[i].value /= s;
  }
  if (options.coherence) {
    const auto coherence = read_coherence(*file, *options.coherence, values->abscissa);
    if (!coherence) return Refusal(coherence.error());
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i].coherence = (*coherence)[i];
  }
  auto response = make_response(std::move(lines), options, file->source);
  if (!response) return response;
  auto& remarks = response->remarks;
  if (conversion) remarks.push_back(conversion->remark);
  remarks.insert(remarks.end(), values->remarks.begin(), values->remarks.end());
  remarks.insert(remarks.end(), file->remarks.begin(), file->remarks.end());
  return response;
}

}  // namespace zwidth::internal

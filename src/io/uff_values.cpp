#include "io/uff_values.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "counted.hpp"
#include "io/number_cell.hpp"
#include "io/prose.hpp"
#include "io/uff_number.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

using Refusal = tl::unexpected<InputError>;

constexpr std::size_t most_padding = 5;  // numbers that fill up the last line

std::size_t numbers_per_point(const UffRecord& record) {
  return (record.is_even ? 0U : 1U) + (record.is_complex ? 2U : 1U);
}

tl::expected<std::vector<double>, InputError> text_numbers(const UffFile& file, const UffRecord& record) {
  std::string_view rest = std::string_view(file.bytes).substr(record.data_begin, record.data_end - record.data_begin);
  std::vector<double> numbers;
  std::size_t line = record.data_line;
  while (!rest.empty()) {
    const std::string_view whole = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(whole.size() + 1, rest.size()));
    std::string_view text = whole;
    while (const auto number = take_fortran_number(text)) numbers.push_back(*number);
    if (!text.empty()) {
      const std::string_view word = text.substr(0, text.find_first_of(" \t\r"));
      return Refusal(InputError({.file = file.source, .line = line, .column = whole.size() - text.size() + 1},
                                {.code = ProblemCode::text_not_readable,
                                 .subjects = {{"text", in_quotes(as_utf8(word))}, {"wanted", "number"}}}));
    }
    ++line;
  }
  return numbers;
}

std::vector<double> binary_numbers(const UffFile& file, const UffRecord& record) {
  const std::span bytes(reinterpret_cast<const unsigned char*>(file.bytes.data()) + record.data_begin,
                        record.data_end - record.data_begin);
  if (!record.is_double) return load_all<float>(bytes, *record.binary);
  if (!record.single_abscissa) return load_all<double>(bytes, *record.binary);
  const std::size_t ordinates = numbers_per_point(record) - 1;
  std::vector<double> numbers;
  numbers.reserve(record.points * (ordinates + 1));
  for (const unsigned char* place = bytes.data(); place != bytes.data() + bytes.size();) {
    numbers.push_back(static_cast<double>(load<float>(place, *record.binary)));
    place += sizeof(float);
    for (std::size_t i = 0; i < ordinates; ++i, place += sizeof(double)) {
      numbers.push_back(load<double>(place, *record.binary));
    }
  }
  return numbers;
}

}  // namespace

tl::expected<UffValues, InputError> read_uff_values(const UffFile& file, const UffRecord& record) {
  auto numbers = record.binary ? binary_numbers(file, record) : text_numbers(file, record);
  if (!numbers) return Refusal(std::move(numbers.error()));
  const std::size_t step = numbers_per_point(record);
  const std::size_t points = std::min(record.points, numbers->size() / step);
  if (points == 0 || numbers->size() > record.points * step + most_padding) {
    return Refusal(InputError({.file = file.source, .line = record.data_line, .column = 1},
                              {.code = ProblemCode::size_disagrees,
                               .evidence = {counted("count", numbers->size()), counted("points", record.points),
                                            counted("expected", record.points * step)},
                               .subjects = {{"unit", "numbers"}}}));
  }
  UffValues values;
  if (points < record.points) {
    values.remarks.push_back(warning(
        {.code = FindingCode::function_cut_off,
         .evidence = {counted("line", record.line), counted("points", points), counted("stated", record.points)}}));
  }
  const auto column = [&](std::size_t offset) {
    std::vector<double> taken(points);
    for (std::size_t i = 0; i < points; ++i) taken[i] = (*numbers)[i * step + offset];
    return taken;
  };
  if (record.is_even) {
    for (std::size_t i = 0; i < points; ++i) {
      values.abscissa.push_back(record.first + static_cast<double>(i) * record.step);
    }
  } else {
    values.abscissa = column(0);
  }
  const std::size_t ordinate = record.is_even ? 0 : 1;
  values.ordinate = column(ordinate);
  if (record.is_complex) values.imaginary = column(ordinate + 1);
  return values;
}

}  // namespace zwidth::internal

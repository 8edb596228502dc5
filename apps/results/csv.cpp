#include "results/csv.hpp"

#include <cmath>

#include "results/json.hpp"

namespace zwidth::results {

std::back_insert_iterator<fmt::memory_buffer> Csv::next() {
  if (std::exchange(begun_, true)) rows_.push_back(',');
  return std::back_inserter(rows_);
}

void Csv::cell(Rounded number) {
  const auto put = next();
  if (std::isfinite(number.value)) fmt::format_to(put, "{:.{}g}", number.value, number.digits);
}

void Csv::cell(Shortest number) { fmt::format_to(next(), "{}", number.value); }

void Csv::cell(std::string_view text) {
  auto put = next();
  if (text.find_first_of(",\"\n\r;") == std::string_view::npos) {
    fmt::format_to(put, "{}", text);
    return;
  }
  rows_.push_back('"');
  for (const char each : text) {
    rows_.push_back(each);
    if (each == '"') rows_.push_back(each);
  }
  rows_.push_back('"');
}

void Csv::cell(const Trust& trust) { cell(name_of(trust.verdict)); }

void Csv::end_row() {
  constexpr std::size_t piece_size = std::size_t{1} << 16;
  rows_.push_back('\n');
  begun_ = false;
  if (sink_ && rows_.size() >= piece_size) flush();
}

void Csv::flush() {
  if (!sink_) return;
  sink_({rows_.data(), rows_.size()});
  rows_.clear();
}

}  // namespace zwidth::results

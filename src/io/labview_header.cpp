#include "io/labview_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <utility>

#include "io/number_cell.hpp"
#include "io/prose.hpp"

namespace zwidth::internal {
namespace {

using namespace std::string_view_literals;

constexpr std::array segment_tags{
    "Channels"sv,     "Samples"sv,      "Date"sv,     "Time"sv,    "Notes"sv,       "X_Dimension"sv,
    "X_Unit_Label"sv, "Y_Unit_Label"sv, "X0"sv,       "Delta_X"sv, "Y_Dimension"sv, "Test_Name"sv,
    "Test_Numbers"sv, "Test_Series"sv,  "UUT_Name"sv, "UUT_M/N"sv, "UUT_S/N"sv,     "***Start_Special***"sv};

/// As LabVIEW writes the units of quantities.
constexpr std::pair<std::string_view, std::string_view> unit_words[] = {
    {"newtons", "N"}, {"volts", "V"},     {"amps", "A"},     {"amperes", "A"},
    {"meters", "m"},  {"radians", "rad"}, {"degrees", "deg"}};

/// The whole number at the start of `text`, which is moved behind it and the separator.
std::optional<int> leading_whole(std::string_view& text, char separator) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (separator == '\0') return text.empty() ? std::optional(number) : std::nullopt;
  if (!text.starts_with(separator)) return std::nullopt;
  text.remove_prefix(1);
  return number;
}

}  // namespace

std::string LabviewTags::cell(const std::string& tag, std::size_t column) const {
  const auto found = cells_.find(tag);
  return found == cells_.end() || column >= found->second.size() ? "" : found->second[column];
}

bool is_labview_tag(std::string_view word) {
  return std::find(segment_tags.begin(), segment_tags.end(), word) != segment_tags.end();
}

char labview_separator(std::string_view text) {
  constexpr std::string_view tag = "Separator";
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    if (line.starts_with("***End_of_Header***")) break;
    if (line.starts_with(tag) && line.size() > tag.size()) return line[tag.size()];
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return '\t';
}

std::optional<double> labview_seconds(const std::string& date, const std::string& time) {
  std::string_view day_text = date;
  std::string_view time_text = time;
  const auto year = leading_whole(day_text, '/');
  const auto month = year ? leading_whole(day_text, '/') : std::nullopt;
  const auto day = month ? leading_whole(day_text, '\0') : std::nullopt;
  const auto hours = leading_whole(time_text, ':');
  const auto minutes = hours ? leading_whole(time_text, ':') : std::nullopt;
  if (!day || !minutes || *month < 1 || *month > 12 || *day < 1 || *day > 31 || *year < 1 || *year > 9999)
    return std::nullopt;
  const char mark = time_text.find(',') == std::string_view::npos ? '.' : ',';
  const NumberCell seconds = read_number(time_text, mark);
  if (seconds.kind != NumberCell::Kind::number) return std::nullopt;
  namespace chrono = std::chrono;
  const chrono::sys_days days =
      chrono::year{*year} / chrono::month{static_cast<unsigned>(*month)} / chrono::day{static_cast<unsigned>(*day)};
  const chrono::sys_days origin = chrono::year{2000} / 1 / 1;
  constexpr double per_day = 86400.0;
  return per_day * static_cast<double>((days - origin).count()) + 3600.0 * *hours + 60.0 * *minutes + seconds.value;
}

std::string labview_unit(const std::string& label) {
  const std::string lower = lower_case(label);
  for (const auto& [word, unit] : unit_words) {
    if (lower == word) return std::string(unit);
  }
  return label;
}

}  // namespace zwidth::internal

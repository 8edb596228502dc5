#include "io/wall_filter_reading.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "io/device_keys.hpp"
#include "io/prose.hpp"
#include "model/key_members.hpp"
#include "zwidth/io/message_words.hpp"
#include "zwidth/io/wall_filter_type.hpp"

namespace zwidth::internal {
namespace {

using enum WallFilter::Kind;

constexpr std::array all_kinds{low_pass, notch, lead_lag, biquad, digital};

const std::vector<std::string>& type_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    all.reserve(all_kinds.size());
    for (const WallFilter::Kind kind : all_kinds) all.emplace_back(wall_filter_type(kind));
    return all;
  }();
  return names;
}

std::vector<std::string> keys_of_type(WallFilter::Kind kind) {
  std::vector<std::string> keys;
  std::ranges::copy_if(keys_of(DeviceTable::filter), std::back_inserter(keys),
                       [kind](const std::string& key) { return is_key_of(kind, key); });
  return keys;
}

std::optional<WallFilter::Kind> read_kind(TableReader& reader) {
  if (!reader.has("type")) reader.refuse_missing("type", {"choice", listed(type_names())});
  const auto name = reader.text("type");
  if (!name) return std::nullopt;
  for (const WallFilter::Kind kind : all_kinds) {
    if (*name == wall_filter_type(kind)) return kind;
  }
  const std::string meant = nearest_word(*name, type_names());
  reader.refuse("type", not_one_of(*name, "one of " + listed(type_names()), meant), suggested(meant));
  return std::nullopt;
}

void refuse_keys_of_other_types(TableReader& reader, WallFilter::Kind kind) {
  for (const std::string& key : keys_of(DeviceTable::filter)) {
    if (!reader.has(key) || is_key_of(kind, key)) continue;
    reader.refuse(key,
                  {.code = ProblemCode::key_of_other_filters,
                   .subjects = {{"type", std::string(wall_filter_type(kind))}, {"keys", listed(keys_of_type(kind))}}});
  }
}

void read_low_pass(TableReader& reader, WallFilter& filter) {
  const double order = reader.number("order").value_or(filter.order);
  if (order != 1.0 && order != 2.0) {
    reader.refuse(
        "order",
        {.code = ProblemCode::not_one_of, .evidence = {{"value", order}}, .subjects = {{"choices", "1 or 2"}}});
    return;
  }
  filter.order = order == 1.0 ? 1 : 2;
  filter.damping_ratio = reader.number("damping_ratio", Measure::ratio).value_or(filter.damping_ratio);
  if (filter.order == 1 && reader.has("damping_ratio")) {
    reader.refuse("damping_ratio", {.code = ProblemCode::damping_of_first_order});
  }
}

}  // namespace

WallFilter read_wall_filter(TableReader& reader) {
  WallFilter filter;
  reader.refuse_keys_not_of(DeviceTable::filter);
  const auto kind = read_kind(reader);
  if (!kind) {
    reader.leave();  // what its other numbers are depends on it
    return filter;
  }
  filter.kind = *kind;
  refuse_keys_of_other_types(reader, *kind);
  switch (*kind) {
    case low_pass:
      filter.frequency_hz = reader.required_positive_number("frequency_hz", Measure::frequency_hz);
      read_low_pass(reader, filter);
      break;
    case notch:
      filter.frequency_hz = reader.required_positive_number("frequency_hz", Measure::frequency_hz);
      filter.damping_ratio = reader.number("damping_ratio", Measure::ratio).value_or(filter.damping_ratio);
      filter.depth = reader.number("depth", Measure::ratio).value_or(filter.depth);
      break;
    case lead_lag:
      filter.frequency_hz = reader.required_positive_number("frequency_hz", Measure::frequency_hz);
      filter.ratio = reader.required_positive_number("ratio", Measure::ratio);
      break;
    case biquad:
    case digital:
      filter.numerator = reader.required_numbers("numerator");
      filter.denominator = reader.required_numbers("denominator");
      filter.frequency_hz = reader.number("frequency_hz", Measure::frequency_hz).value_or(0.0);
      break;
  }
  return filter;
}

}  // namespace zwidth::internal

namespace zwidth {

std::string_view wall_filter_type(WallFilter::Kind kind) {
  using enum WallFilter::Kind;
  switch (kind) {
    case low_pass:
      return "low_pass";
    case notch:
      return "notch";
    case lead_lag:
      return "lead_lag";
    case biquad:
      return "biquad";
    case digital:
      return "digital";
  }
  return "";
}

}  // namespace zwidth

#include "io/study_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "counted.hpp"
#include "io/prose.hpp"
#include "io/text_lines.hpp"
#include "io/whole_text.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/study_file.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr std::size_t most_samples = 10'000'000;
constexpr std::string_view blanks = " \t\r;";
constexpr std::string_view unit_header = "# unit:";

std::optional<double> number_of(std::string_view word) {
  const auto value = whole_text_as<double>(word);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    if (words.size() == 1 && words[0].size() > 1 && words[0].back() == ',') words[0].remove_suffix(1);
    begin = line.find_first_not_of(blanks, end);
  }
  return words;
}

}  // namespace

Distribution internal::discrete_of(const std::vector<double>& values, const std::vector<double>& weights) {
  std::vector<std::pair<double, double>> pairs;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (weights[i] != 0.0) pairs.emplace_back(values[i], weights[i]);
  }
  std::ranges::sort(pairs);
  Distribution result{.kind = Distribution::Kind::discrete};
  for (const auto& [value, weight] : pairs) {
    if (!result.values.empty() && result.values.back() == value) {
      result.weights.back() += weight;
    } else {
      result.values.push_back(value);
      result.weights.push_back(weight);
    }
  }
  return result;
}

tl::expected<Distribution, InputError> internal::read_study_samples(const std::string& path, Measure measure,
                                                                    Motion motion) {
  auto file = InputFile::open(path, "file of samples");
  if (!file) return tl::unexpected(std::move(file.error()));
  auto lines = TextLines::start(*std::move(file));
  if (!lines) return tl::unexpected(std::move(lines.error()));
  std::vector<double> values;
  std::vector<double> weights;
  double scale = 1.0;
  while (true) {
    const auto line = lines->next({});
    if (!line) return tl::unexpected(line.error());
    if (!*line) break;
    const std::string_view text = (*line)->text;
    const InputPlace place{path, (*line)->number, 1};
    if (text.starts_with(unit_header)) {
      const auto unit = number_with_unit(fmt::format("1 {}", text.substr(unit_header.size())), measure, motion);
      if (!unit) return tl::unexpected(InputError(place, *unit.error().problem));
      scale = *unit;
    }
    const auto words = words_of(text);
    if (words.empty() || words.front().starts_with('#')) continue;
    const auto value = number_of(words[0]);
    const auto weight = words.size() > 1 ? number_of(words[1]) : 1.0;
    if (!value || !weight || *weight < 0.0 || words.size() > 2) {
      return tl::unexpected(
          InputError(place, {.code = ProblemCode::no_samples_in_file, .subjects = {{"text", shortened(text)}}}));
    }
    if (values.size() == most_samples) {
      return tl::unexpected(InputError(
          place, {.code = ProblemCode::count_out_of_range,
                  .evidence = {counted("value", most_samples + 1), counted("least", 1), counted("most", most_samples)},
                  .subjects = {{"name", "samples"}}}));
    }
    values.push_back(*value * scale);
    weights.push_back(*weight);
  }
  Distribution result = discrete_of(values, weights);
  if (result.values.empty()) {
    return tl::unexpected(InputError({.file = path}, {.code = ProblemCode::no_samples_in_file}));
  }
  return result;
}

tl::expected<StudyFile, InputError> read_study_file(const std::string& path, const Device& device) {
  auto file = InputFile::open(path, "study file");
  if (!file) return tl::unexpected(std::move(file.error()));
  const auto text = file->read_up_to(device_file_size_limit + 1);
  if (!text) return tl::unexpected(text.error());
  if (text->size() > device_file_size_limit) {
    return tl::unexpected(
        InputError({.file = file->source()}, {.code = ProblemCode::too_many_bytes_read,
                                              .evidence = {counted("most", device_file_size_limit >> 20)},
                                              .subjects = {{"kind", "study file"}}}));
  }
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return parse_study(*text, file->source(), device, folder.empty() ? "." : folder);
}

}  // namespace zwidth

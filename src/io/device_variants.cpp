#include "zwidth/io/device_variants.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

std::vector<std::string> listed_values(std::string_view text) {
  std::vector<std::string> values(1);
  int depth = 0;  // of brackets
  for (const char letter : text) {
    depth += letter == '[' ? 1 : letter == ']' ? -1 : 0;
    if (letter == ',' && depth == 0) {
      values.emplace_back();
    } else {
      values.back() += letter;
    }
  }
  return values;
}

InputError variants_refusal(const std::string& key, Problem problem) {
  return {InputPlace{.file = override_source, .key = key}, std::move(problem)};
}

}  // namespace

tl::expected<DeviceVariants, std::vector<InputError>> device_variants(const Device& device,
                                                                      std::string_view assignment) {
  const auto refused = [](InputError error) { return tl::unexpected(std::vector{std::move(error)}); };
  const std::size_t equals = assignment.find('=');
  DeviceVariants all{std::string(assignment.substr(0, equals)), {}};
  if (equals == std::string_view::npos || all.key.empty()) {
    return refused(
        variants_refusal("", {.code = ProblemCode::not_an_assignment,
                              .subjects = {{"form", "KEY=VALUE,VALUE"}, {"example", "sensed=motor,handle"}}}));
  }
  constexpr std::array<std::string_view, 3> of_the_loop{"actuated", "sensed", "held"};
  if (std::ranges::find(of_the_loop, all.key) != of_the_loop.end()) all.key = "loop." + all.key;
  const std::vector<std::string> values = listed_values(assignment.substr(equals + 1));
  if (values.size() < 2) return refused(variants_refusal(all.key, {.code = ProblemCode::one_variant}));
  for (const std::string& value : values) {
    if (std::ranges::count(values, value) > 1) {
      return refused(variants_refusal(all.key, {.code = ProblemCode::given_twice, .subjects = {{"name", value}}}));
    }
  }
  const std::string text = write_device(device.parameters());
  std::vector<InputError> errors;
  for (const std::string& value : values) {
    const std::vector<std::string> override = {all.key + "=" + value};
    if (auto variant = parse_device(text, device.name(), override)) {
      all.variants.push_back({value, *std::move(variant)});
    } else {
      errors.push_back(variant.error());
    }
  }
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  return all;
}

}  // namespace zwidth

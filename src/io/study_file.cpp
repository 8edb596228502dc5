#include "zwidth/io/study_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "counted.hpp"
#include "io/device_reading.hpp"
#include "io/prose.hpp"
#include "io/study_samples.hpp"
#include "io/toml_text.hpp"
#include "zwidth/io/message_words.hpp"
#include "zwidth/model/mechanism_key.hpp"
#include "zwidth/model/parameter.hpp"

namespace zwidth {
using namespace internal;
namespace {

using Kind = Distribution::Kind;

const std::vector<std::string> root_keys = {"sampling", "samples", "seed", "specification", "parameter", "correlation"};
const std::vector<std::string> specification_keys = {"critical_stiffness", "any_user"};
const std::vector<std::string> correlation_keys = {"parameters", "matrix"};

/// The keys of a parameter, by its distribution, besides key and distribution.
const std::map<std::string, std::vector<std::string>> distribution_keys = {
    {"normal", {"mean", "standard_deviation", "relative_deviation", "lower", "upper"}},
    {"lognormal", {"median", "log_deviation", "lower", "upper"}},
    {"uniform", {"lower", "upper", "relative_tolerance"}},
    {"triangular", {"lower", "mode", "upper"}},
    {"discrete", {"values", "weights"}},
    {"file", {"file"}},
    {"device", {"lower", "upper"}},
};

class StudyReader {
 public:
  StudyReader(DeviceReading& reading, const toml::table& document, const Device& device,
              const std::optional<std::string>& folder)
      : reading_(reading), root_(reading, document, ""), device_(device), folder_(folder) {}

  [[nodiscard]] StudyFile read() && {
    root_.refuse_keys_not_in(root_keys);
    read_sampling();
    study_.samples = read_count(root_, "samples");
    study_.seed = read_count(root_, "seed");
    if (const toml::table* table = root_.table("specification", "[specification]")) {
      TableReader reader(reading_, *table, "specification");
      reader.refuse_keys_not_in(specification_keys);
      study_.specification.critical_stiffness = read_stiffness(reader, "critical_stiffness");
      study_.specification.any_user = read_stiffness(reader, "any_user");
      if (study_.specification.any_user && !device_.is_mechanical()) {
        reader.refuse("any_user", {.code = ProblemCode::asked_of_transfer_function});
      }
    }
    for (const toml::table* table : root_.tables("parameter", "[[parameter]]")) read_parameter(*table);
    read_correlation();
    return std::move(study_);
  }

 private:
  void read_sampling() {
    const auto name = root_.text("sampling");
    if (!name) return;
    if (*name == "random") study_.sampling = SamplingScheme::random;
    if (*name == "latin-hypercube") study_.sampling = SamplingScheme::latin_hypercube;
    if (*name == "sobol") study_.sampling = SamplingScheme::sobol;
    if (!study_.sampling) {
      root_.refuse("sampling", not_one_of(*name, R"("random", "latin-hypercube" or "sobol")"));
    }
  }

  static std::optional<std::uint64_t> read_count(TableReader& reader, std::string_view key) {
    const auto number = reader.number(key);
    if (!number) return std::nullopt;
    constexpr double most = 0x1p53;
    if (!(*number >= 0.0 && *number <= most && std::floor(*number) == *number)) {
      reader.refuse(key, {.code = ProblemCode::no_whole_number,
                          .evidence = {{"value", *number}, {"least", 0.0}, {"most", most}}});
      return std::nullopt;
    }
    return static_cast<std::uint64_t>(*number);
  }

  static std::optional<double> read_stiffness(TableReader& reader, std::string_view key) {
    const auto number = reader.number(key, Measure::stiffness);
    if (number && !(*number > 0.0 && std::isfinite(*number))) {
      reader.refuse(key, {.code = ProblemCode::not_finite_and_positive, .evidence = {{"value", *number}}});
    }
    return number;
  }

  void read_parameter(const toml::table& table) {
    TableReader reader(reading_, table, fmt::format("parameter.{}", study_.distributions.parameters.size()));
    StudyParameter& one = study_.distributions.parameters.emplace_back();
    one.distribution = {.kind = Kind::normal, .centre = 1.0, .deviation = 1.0};
    one.key = reader.text("key").value_or("");
    if (one.key.empty()) return reader.refuse_missing("key", {"key", "link.0.stiffness"});
    const std::vector<std::string> known = parameter_keys(device_.parameters());
    if (std::ranges::find(known, full_parameter_key(device_.parameters(), one.key)) == known.end()) {
      const std::string meant = nearest_word(one.key, known);
      return reader.refuse("key",
                           {.code = ProblemCode::no_number_of_device,
                            .evidence = {{"quoted", 1.0}},
                            .subjects = {{"name", shortened(one.key)},
                                         meant.empty() ? Subject{"numbers", listed(known)} : Subject{"meant", meant}}});
    }
    const std::string name = reader.text("distribution").value_or("");
    const auto keys = distribution_keys.find(name);
    if (keys == distribution_keys.end()) {
      std::vector<std::string> names;
      for (const auto& each : distribution_keys) names.push_back(each.first);
      if (!reader.has("distribution")) return reader.refuse_missing("distribution", {"choice", listed(names)});
      return reader.refuse("distribution", not_one_of(name, "one of " + listed(names)));
    }
    std::vector<std::string> allowed = {"key", "distribution"};
    allowed.insert(allowed.end(), keys->second.begin(), keys->second.end());
    reader.refuse_keys_not_in(allowed);
    const std::size_t refused = reading_.count();
    reading_.set_motion(motion_of_key(device_.parameters(), one.key));
    one.distribution = read_distribution(reader, name, one.key);
    reading_.set_motion(device_.parameters().motion);
    if (reading_.count() > refused) return;  // its numbers are not those of the file
    if (const auto problem = find_problem(one.distribution)) {
      reader.refuse(key_of(problem->member, name), input_problem_of(*problem));
    }
  }

  /// As the file calls a member of Distribution.
  static std::string key_of(const std::string& member, const std::string& distribution) {
    if (member == "centre") {
      return distribution == "normal" ? "mean" : distribution == "lognormal" ? "median" : "mode";
    }
    if (member == "deviation") return distribution == "lognormal" ? "log_deviation" : "standard_deviation";
    return distribution == "file" ? "file" : member;
  }

  Distribution read_distribution(TableReader& reader, const std::string& name, const std::string& key) {
    const Measure measure = measure_of(key).value_or(Measure::ratio);
    const std::optional<double> own = parameter(device_.parameters(), key);
    const auto number = [&](std::string_view of) { return reader.number(of, measure); };
    const auto required = [&](std::string_view of, std::optional<double> otherwise) {
      const auto value = number(of);
      if (!value && !otherwise && !reader.has(of)) reader.refuse_missing(of, {"number"});
      return value.value_or(otherwise.value_or(1.0));
    };
    Distribution result;
    if (name == "file") return read_samples(reader, measure);
    if (name == "discrete") return read_discrete(reader, measure);
    if (name == "device") {
      const auto uncertain = uncertainty_of(device_, key);
      if (!uncertain || !(uncertain->deviation > 0.0)) {
        reader.refuse("distribution", {.code = ProblemCode::not_told_by_uncertainty, .subjects = {{"name", key}}});
        return {.kind = Kind::normal, .centre = 1.0, .deviation = 1.0};
      }
      result = *uncertain;
      is_of_device_[full_parameter_key(device_.parameters(), key)] = true;
    }
    if (name == "normal") {
      result = {.kind = Kind::normal, .centre = required("mean", own), .deviation = 1.0};
      const auto relative = reader.number("relative_deviation");
      if (relative && reader.has("standard_deviation")) {
        reader.refuse("relative_deviation",
                      {.code = ProblemCode::given_beside, .subjects = {{"other", "standard_deviation"}}});
      }
      result.deviation = relative ? std::abs(result.centre) * *relative : required("standard_deviation", std::nullopt);
      if (relative && !(result.deviation > 0.0 && std::isfinite(*relative))) {
        reader.refuse("relative_deviation", {.code = ProblemCode::no_relative_width,
                                             .evidence = {{"value", *relative}, {"of", result.centre}}});
      }
    }
    if (name == "lognormal") {
      result = {.kind = Kind::lognormal, .centre = required("median", own), .deviation = 1.0};
      const auto deviation = reader.number("log_deviation");
      if (!deviation) reader.refuse_missing("log_deviation", {"positive"});
      result.deviation = deviation.value_or(1.0);
    }
    if (name == "triangular") {
      result = {.kind = Kind::triangular, .centre = required("mode", own), .deviation = 1.0};
      result.lower = required("lower", std::nullopt), result.upper = required("upper", std::nullopt);
      return result;
    }
    if (name == "uniform") {
      result.kind = Kind::uniform;
      if (const auto tolerance = reader.number("relative_tolerance")) {
        if (reader.has("lower") || reader.has("upper")) {
          reader.refuse("relative_tolerance", {.code = ProblemCode::given_beside,
                                               .evidence = {{"both", 1.0}},
                                               .subjects = {{"other", reader.has("lower") ? "lower" : "upper"}}});
        }
        const double half = std::abs(own.value_or(1.0)) * *tolerance;
        if (!(half > 0.0)) {
          reader.refuse("relative_tolerance", {.code = ProblemCode::no_relative_width,
                                               .evidence = {{"value", *tolerance}, {"of", own.value_or(1.0)}}});
        }
        result.lower = own.value_or(1.0) - half, result.upper = own.value_or(1.0) + half;
      } else {
        result.lower = required("lower", std::nullopt), result.upper = required("upper", std::nullopt);
      }
      return result;
    }
    if (const auto lower = number("lower")) result.lower = *lower;
    if (const auto upper = number("upper")) result.upper = *upper;
    return result;
  }

  static Distribution read_discrete(TableReader& reader, Measure measure) {
    const std::vector<double> values = reader.required_numbers("values", measure);
    std::vector<double> weights(values.size(), 1.0);
    if (reader.has("weights")) weights = reader.required_numbers("weights");
    if (weights.size() != values.size()) {
      reader.refuse("weights", {.code = ProblemCode::weights_not_one_a_value,
                                .evidence = {counted("weights", weights.size()), counted("values", values.size())}});
      return {.kind = Kind::discrete};
    }
    if (!values.empty() && std::ranges::count(weights, 0.0) == std::ssize(weights)) {
      reader.refuse("weights", {.code = ProblemCode::weights_all_zero});
    }
    return discrete_of(values, weights);
  }

  Distribution read_samples(TableReader& reader, Measure measure) {
    const std::string name = reader.text("file").value_or("");
    Distribution empty{.kind = Kind::discrete, .values = {0.0}, .weights = {1.0}};
    if (name.empty()) {
      reader.refuse_missing("file", {"file"});
      return empty;
    }
    if (!folder_) {
      reader.refuse("file", {.code = ProblemCode::no_file_beside_study});
      return empty;
    }
    auto samples = read_study_samples((std::filesystem::path(*folder_) / name).string(), measure, reading_.motion());
    if (samples) return *std::move(samples);
    InputProblem told = samples.error();
    const std::string line = told.place.line > 0 ? fmt::format(":{}", told.place.line) : "";
    told.begin_with(fmt::format("{}{}: ", told.place.file, line));
    reader.refuse("file", std::move(told));
    return empty;
  }

  void read_correlation() {
    const auto& parameters = study_.distributions.parameters;
    std::vector<std::vector<double>> whole(parameters.size(), std::vector<double>(parameters.size(), 0.0));
    bool is_correlated = false;
    const auto full = [&](const std::string& key) { return full_parameter_key(device_.parameters(), key); };
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      for (std::size_t j = 0; j < parameters.size(); ++j) {
        const bool both = is_of_device_[full(parameters[i].key)] && is_of_device_[full(parameters[j].key)];
        whole[i][j] = i == j ? 1.0 : both ? uncertain_correlation(device_, parameters[i].key, parameters[j].key) : 0.0;
        is_correlated = is_correlated || (i != j && whole[i][j] != 0.0);
      }
    }
    if (const toml::table* table = root_.table("correlation", "[correlation]")) {
      TableReader reader(reading_, *table, "correlation");
      reader.refuse_keys_not_in(correlation_keys);
      const auto keys = reader.required_texts("parameters", {"keys", "link.0.stiffness"});
      const auto rows = reader.required_rows("matrix");
      std::vector<std::size_t> places;
      for (const std::string& key : keys) {
        const auto found =
            std::ranges::find(parameters, full(key), [&](const StudyParameter& each) { return full(each.key); });
        if (found == parameters.end()) {
          return reader.refuse("parameters",
                               {.code = ProblemCode::not_a_parameter_of_study, .subjects = {{"name", shortened(key)}}});
        }
        places.push_back(static_cast<std::size_t>(found - parameters.begin()));
        if (std::ranges::count(places, places.back()) > 1) {
          return reader.refuse("parameters",
                               {.code = ProblemCode::given_twice, .subjects = {{"name", shortened(key)}}});
        }
      }
      const Evidence wanted = counted("parameters", keys.size());
      if (rows.size() != keys.size()) {
        return reader.refuse("matrix", {.code = ProblemCode::rows_not_one_a_parameter,
                                        .evidence = {counted("rows", rows.size()), wanted}});
      }
      for (const auto& row : rows) {
        if (row.size() == keys.size()) continue;
        return reader.refuse(
            "matrix", {.code = ProblemCode::row_of_other_length, .evidence = {counted("length", row.size()), wanted}});
      }
      for (std::size_t i = 0; i < keys.size(); ++i) {
        for (std::size_t j = 0; j < keys.size(); ++j) whole[places[i]][places[j]] = rows[i][j];
      }
      is_correlated = true;
    }
    if (is_correlated) study_.distributions.correlation = std::move(whole);
  }

  DeviceReading& reading_;
  TableReader root_;
  const Device& device_;
  const std::optional<std::string>& folder_;
  StudyFile study_;
  std::map<std::string, bool> is_of_device_;  // by full key: the distribution is that of [uncertainty]
};

}  // namespace

tl::expected<StudyFile, InputError> parse_study(std::string_view text, std::string_view source, const Device& device,
                                                const std::optional<std::string>& folder) {
  auto document = parse_toml(text, source, "a study");
  if (!document) return tl::unexpected(std::move(document.error()));
  DeviceReading reading(source);
  reading.set_motion(device.parameters().motion);
  StudyFile study = StudyReader(reading, *document, device, folder).read();
  if (reading.passed()) {
    if (const auto problem = find_problem(device, study.distributions)) reading.refuse(*problem);
  }
  if (!reading.passed()) return tl::unexpected(reading.error());
  return study;
}

}  // namespace zwidth

#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "zwidth/remark.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::results {

// The one way from a result to JSON. A type gets `void to_json(Json&, const Type&)` in this namespace (found through
// Json, so that types of std and Eigen can have one too), an enum NLOHMANN_JSON_SERIALIZE_ENUM; members, vectors,
// optionals and maps of such types then convert by themselves: `document["crossovers"] = critical.crossovers;`.

template <typename T, typename = void>
struct Serializer : nlohmann::adl_serializer<T> {};

/// A JSON document with its keys in the order of their writing, 64-bit numbers, and the serializers below.
using Json = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool, std::int64_t, std::uint64_t,
                                  double, std::allocator, Serializer>;

/// JSON has no infinity and no NaN: a number that does not exist is null.
template <>
struct Serializer<double> : nlohmann::adl_serializer<double> {
  static void to_json(Json& json, double value) {
    if (std::isfinite(value)) {
      nlohmann::adl_serializer<double>::to_json(json, value);
    } else {
      json = nullptr;
    }
  }
};

/// What is absent is null.
template <typename T>
struct Serializer<std::optional<T>> {
  static void to_json(Json& json, const std::optional<T>& value) {
    if (value) {
      json = *value;
    } else {
      json = nullptr;
    }
  }
};

/// Whether a document holds the points that a figure draws, too: they make it long.
enum class PointsInJson { left_out, included };

/// A document that begins with its schema: document("zwidth.analysis/1").
[[nodiscard]] inline Json document(std::string_view schema) {
  Json begun = Json::object();
  begun["schema"] = schema;
  return begun;
}

/// The document on one line, with its end (JSON Lines). Bytes that are no UTF-8 come out as U+FFFD.
[[nodiscard]] std::string line(const Json& document);

/// The name that JSON gives to the value of an enum, for texts.
template <typename Enum>
[[nodiscard]] std::string name_of(Enum value) {
  return Json(value).template get<std::string>();
}

NLOHMANN_JSON_SERIALIZE_ENUM(Remark::Severity,
                             {{Remark::Severity::note, "note"}, {Remark::Severity::warning, "warning"}})
NLOHMANN_JSON_SERIALIZE_ENUM(Trust::Verdict, {{Trust::Verdict::sound, "sound"},
                                              {Trust::Verdict::doubtful, "doubtful"},
                                              {Trust::Verdict::refused, "refused"}})

/// "severity", "what", "meaning" (consequence and remedy in one line), "consequence", "remedy".
void to_json(Json& json, const Remark& remark);

/// {"verdict": "sound" | "doubtful" | "refused", "reasons": [...]}
void to_json(Json& json, const Trust& trust);

/// [{"code", "severity": "note" | "doubt" | "refusal", "key", "evidence": {name: number}, "effect": {name: number} | null,
/// "remedy", "text"}], each once, what speaks against the numbers first. What no code was given for is "stated".
[[nodiscard]] Json findings_json(const Trust& trust, const std::vector<Remark>& remarks = {});

/// The keys "trust", "remarks" and "findings" of a result.
template <typename Result>
void add_findings(Json& json, const Result& result) {
  json["trust"] = result.trust;
  json["remarks"] = result.remarks;
  json["findings"] = findings_json(result.trust, result.remarks);
}

}  // namespace zwidth::results

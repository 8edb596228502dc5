#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "answer.hpp"
#include "interruptible.hpp"
#include "parts.hpp"
#include "python_error.hpp"
#include "results/stability_json.hpp"
#include "zwidth/batch/batch_stiffness.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth::python {
namespace py = pybind11;
namespace {

using results::Json;

/// Calls the library without the interpreter's lock; what it throws is raised.
template <typename Work>
auto computed(const Work& work) {
  try {
    return without_lock(work);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::did_not_converge) raise_work_failed(error.what());
    raise_input_error("device", error.what(), "");
  }
}

CriticalStiffness checked_stiffness(const Device& device) {
  CriticalStiffness critical = computed([&] { return critical_stiffness(device); });
  warn_of(critical.trust);
  return critical;
}

/// As analyze() states it: the wall's damper closed, trusted no more than the device.
AbsoluteStabilityLimit checked_absolute_stability_limit(const Device& device) {
  const Analysis analysis = computed([&] { return analyze(device, {.draws = 0}); });
  warn_of(analysis.trust);
  if (!analysis.any_user && !analysis.trust.refused()) {
    raise_input_error("device", "has no limit over all passive users that is known",
                      "a device of bodies, not too many");
  }
  AbsoluteStabilityLimit limit =
      analysis.any_user.value_or(AbsoluteStabilityLimit{std::numeric_limits<double>::quiet_NaN()});
  limit.trust = analysis.trust;
  return limit;
}

Json json_of(const CriticalStiffness& critical) {
  Json json = Json::object();
  results::add_critical(json, critical);
  json["stable_intervals"] = critical.stable_intervals;
  json["crossovers"] = critical.crossovers;
  json["trust"] = critical.trust;
  return json;
}

Json json_of(const DampingCrossover& crossover) {
  return {{"frequency_rad_s", crossover.frequency},
          {"damping", crossover.damping},
          {"limited_by", crossover.limited_by},
          {"poles_leaving", crossover.poles_leaving}};
}

Json json_of(const CriticalDamping& critical) {
  Json json = Json::object();
  json["status"] = critical.status;
  json["critical_damping"] = critical.damping;
  json["critical_damping_frequency_rad_s"] = critical.limit ? Json(critical.limit->frequency) : Json(nullptr);
  json["critical_damping_limited_by"] = critical.limit ? Json(critical.limit->limited_by) : Json(nullptr);
  json["stable_intervals"] = critical.stable_intervals;
  json["crossovers"] = Json::array();
  for (const DampingCrossover& each : critical.crossovers) json["crossovers"].push_back(json_of(each));
  json["trust"] = critical.trust;
  return json;
}

Json json_of(const AbsoluteStabilityDamping& limit) {
  const bool has_frequency = limit.damping > 0.0 && std::isfinite(limit.damping);
  Json json = Json::object();
  json["critical_damping"] = limit.damping;
  json["critical_damping_frequency_rad_s"] = has_frequency ? Json(limit.frequency) : Json(nullptr);
  json["truncation"] = limit.truncation;
  json["trust"] = limit.trust;
  return json;
}

Json json_of(const AbsoluteStabilityLimit& limit) {
  const bool has_frequency = limit.stiffness > 0.0 && std::isfinite(limit.stiffness);
  Json json = Json::object();
  json["critical_stiffness"] = limit.stiffness;
  json["frequency_rad_s"] = has_frequency ? Json(limit.frequency) : Json(nullptr);
  json["truncation"] = limit.trust.refused() ? Json(nullptr) : Json(limit.truncation);
  json["trust"] = limit.trust;
  return json;
}

/// A property for each key that json_of() has.
template <typename Result, typename... Documented>
void add_properties(py::class_<Result>& bound, const std::pair<const char*, const char*>& first, Documented... others) {
  const auto add = [&](const std::pair<const char*, const char*>& each) {
    const std::string key = each.first;
    bound.def_property_readonly(
        each.first, [key](const Result& result) { return to_python(json_of(result)[key]); }, each.second);
  };
  refuse_pickling(bound);
  add(first);
  (add(others), ...);
  bound.def(
      "to_dict", [](const Result& result) { return to_python(json_of(result)); },
      "All of it as a new dict, with the keys of analyze's document.");
  bound.def("_repr_html_", [](const Result& result) {
    return py::module_::import("zwidth._record").attr("html_of")(to_python(json_of(result)));
  });
}

using Documented = std::pair<const char*, const char*>;

void bind_critical_stiffness(py::module_& module) {
  py::class_<CriticalStiffness> bound(module, "CriticalStiffness",
                                      "The stiffest stable virtual wall, with everything that decides it.");
  add_properties(
      bound, Documented{"status", "\"finite\", \"none_stable\", \"unbounded\" or \"refused\"."},
      Documented{
          "critical_stiffness",
          "K_CR, N/m or N m/rad: stable for 0 < K < K_CR; 0 where none is stable; None where unbounded or refused."},
      Documented{"critical_stiffness_db", "20 log10 of it; None unless finite."},
      Documented{"critical_frequency_rad_s", "Of the oscillation just above it, rad/s; None unless finite."},
      Documented{"critical_frequency_hz", "The same in Hz."},
      Documented{"limited_by",
                 "{\"kind\": \"rigid_body\"} or {\"kind\": \"vibration_mode\", \"mode\": N}; None unless finite."},
      Documented{"stable_intervals", "[lower, upper] of every stable interval of K > 0; an unbounded end is None."},
      Documented{"crossovers", "Every K that puts a closed-loop pole on the unit circle, by rising frequency."},
      Documented{"trust", "{\"verdict\": \"sound\", \"doubtful\" or \"refused\", \"reasons\": [...]}"});
  bound.def("__repr__", [](const CriticalStiffness& critical) {
    return "<zwidth.CriticalStiffness " + json_of(critical)["critical_stiffness"].dump() + ", " +
           results::name_of(critical.status) + ">";
  });
  module.def("critical_stiffness", &checked_stiffness, py::arg("device"),
             "The stiffest stable virtual wall of a device, its own damper and filters closed (eqs. 21-23 of Díaz & "
             "Gil): N/m or N m/rad. Warns with DoubtfulResult where it is not sound.");
}

void bind_absolute_stability_limit(py::module_& module) {
  py::class_<AbsoluteStabilityLimit> bound(module, "AnyUserLimit",
                                           "The stiffest wall that is stable whoever holds the device.");
  add_properties(bound,
                 Documented{"critical_stiffness",
                            "N/m or N m/rad; 0: some user destabilises every wall; None: none does, or refused."},
                 Documented{"frequency_rad_s",
                            "Where the worst user destabilises it, rad/s; 0: towards zero frequency; None: nowhere."},
                 Documented{"truncation", "Relative: what the bounds leave open; it is taken off the limit."},
                 Documented{"trust", "{\"verdict\": ..., \"reasons\": [...]}"});
  module.def("any_user_limit", &checked_absolute_stability_limit, py::arg("device"),
             "The stiffest wall that is stable with every passive user (docs/absolute_stability.md): N/m or N m/rad, "
             "as analyze() "
             "states it. Warns with DoubtfulResult where it is not sound.");
}

void bind_critical_damping(py::module_& module) {
  py::class_<CriticalDamping> bound(
      module, "CriticalDamping",
      "The largest stable virtual damper without a spring, with everything that decides it.");
  add_properties(
      bound, Documented{"status", "\"finite\", \"none_stable\", \"unbounded\" or \"refused\"."},
      Documented{
          "critical_damping",
          "N s/m or N m s/rad: stable for 0 <= B below it; 0 where none is stable; None where unbounded or refused."},
      Documented{"critical_damping_frequency_rad_s", "Of the oscillation just above it, rad/s; None unless finite."},
      Documented{"critical_damping_limited_by",
                 "{\"kind\": \"rigid_body\"} or {\"kind\": \"vibration_mode\", \"mode\": N}; None unless finite."},
      Documented{"stable_intervals", "[lower, upper] of every stable interval of B; an unbounded end is None."},
      Documented{"crossovers", "Every B that puts a closed-loop pole on the unit circle, by rising frequency."},
      Documented{"trust", "{\"verdict\": \"sound\", \"doubtful\" or \"refused\", \"reasons\": [...]}"});
  module.def(
      "critical_damping",
      [](const Device& device) {
        CriticalDamping critical = computed([&] { return critical_damping(device); });
        warn_of(critical.trust);
        return critical;
      },
      py::arg("device"),
      "The largest stable virtual damper without a spring (K = 0), the file's user holding where there is one: N s/m "
      "or "
      "N m s/rad. Warns with DoubtfulResult where it is not sound.");
}

void bind_absolute_stability_damping(py::module_& module) {
  py::class_<AbsoluteStabilityDamping> bound(
      module, "AnyUserDamping", "The largest damper without a spring that is stable whoever holds the device.");
  add_properties(
      bound,
      Documented{"critical_damping",
                 "N s/m or N m s/rad; 0: some user destabilises every damper; None: none does, or refused."},
      Documented{"critical_damping_frequency_rad_s", "Where the worst user destabilises it, rad/s; None: nowhere."},
      Documented{"truncation", "Relative: what the bounds leave open; it is taken off the limit."},
      Documented{"trust", "{\"verdict\": ..., \"reasons\": [...]}"});
  module.def(
      "any_user_damping",
      [](const Device& device) {
        AbsoluteStabilityDamping limit = computed([&] { return absolute_stability_damping(device); });
        warn_of(limit.trust);
        return limit;
      },
      py::arg("device"),
      "The largest damper without a spring (K = 0) that no passive user destabilises (docs/absolute_stability.md): N "
      "s/m or "
      "N m s/rad. Warns with DoubtfulResult where it is not sound.");
}

/// The median of the library's own call, for who measures what a call from Python costs beside it.
double seconds_of_critical_stiffness(const Device& device, std::size_t repeats) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  for (std::size_t i = 0; i < repeats; ++i) {
    const auto begun = Clock::now();
    const CriticalStiffness critical = critical_stiffness(device);
    times.push_back(std::chrono::duration<double>(Clock::now() - begun).count());
  }
  std::ranges::nth_element(times, times.begin() + static_cast<std::ptrdiff_t>(repeats / 2));
  return times[repeats / 2];
}

std::vector<ParameterValues> values_of(const py::dict& changes) {
  std::vector<ParameterValues> all;
  for (const auto& [key, values] : changes) {
    const auto numbers = py::cast<py::array_t<double, py::array::c_style>>(values);
    if (numbers.ndim() != 1) throw py::value_error("values must be of one dimension");
    all.push_back({py::cast<std::string>(key), {numbers.data(), numbers.data() + numbers.size()}});
  }
  return all;
}

/// A column of few different values as it is, small numbers; what each of them means goes to `meanings`.
template <typename Number, typename Value, typename MeaningOf>
py::array coded(const std::vector<Value>& column, py::dict& meanings, const MeaningOf& meaning_of) {
  py::array_t<Number> codes(static_cast<py::ssize_t>(column.size()));
  Number* code = codes.mutable_data();
  std::set<Number> seen;
  for (std::size_t i = 0; i < column.size(); ++i) {
    code[i] = static_cast<Number>(column[i]);
    if (seen.insert(code[i]).second) meanings[py::int_(code[i])] = meaning_of(i);
  }
  return codes;
}

/// What is said of every element that has more to say than its numbers, by index; warns of all of it.
py::dict reasons_of(const BatchStiffness& columns) {
  py::dict reasons;
  Trust trust;
  const auto add = [&](std::size_t i) {
    const std::string failure = columns.failure_of(i);
    if (failure.empty()) trust.inherit(columns.trust_of(i));
    std::vector<std::string> why = failure.empty() ? columns.trust_of(i).reasons : std::vector{failure};
    if (!why.empty()) reasons[py::int_(i)] = std::move(why);
  };
  if (columns.trust.sound()) {
    for (const BatchException& each : columns.exceptions) add(each.index);
  } else {
    for (std::size_t i = 0; i < columns.size(); ++i) add(i);
  }
  warn_of(trust);
  return reasons;
}

/// The columns of CriticalStiffnessMany. No Python object is made per device: while one thread makes those, others wait.
py::dict many(const Device& device, const py::dict& changes, const py::object& progress) {
  const std::vector<ParameterValues> values = values_of(changes);
  if (const auto problem = find_problem(device, values)) raise_input_error(*problem);
  BatchStiffness columns =
      interruptible(progress, [&](const Progress& told) { return batch_stiffness(device, values, {}, told); });
  py::dict statuses;
  py::dict mechanisms;
  py::dict made;
  made["status"] = coded<std::int8_t>(columns.status, statuses,
                                      [&](std::size_t i) { return py::str(results::name_of(columns.status[i])); });
  made["limited_by"] = coded<std::int16_t>(columns.mode, mechanisms, [&](std::size_t i) -> py::object {
    const auto mechanism = columns.limited_by(i);
    return mechanism ? to_python(Json(*mechanism)) : py::none();
  });
  made["statuses"] = statuses;
  made["mechanisms"] = mechanisms;
  made["reasons"] = reasons_of(columns);
  made["scalar_count"] = columns.scalar_count;
  made["critical_stiffness"] = array_over(std::move(columns.stiffness));
  made["critical_frequency_rad_s"] = array_over(std::move(columns.frequency));
  return made;
}

}  // namespace

void bind_limits(py::module_& module) {
  bind_critical_stiffness(module);
  bind_absolute_stability_limit(module);
  bind_critical_damping(module);
  bind_absolute_stability_damping(module);
  module.def("critical_stiffness_many", &many);
  module.def("seconds_of_critical_stiffness", &seconds_of_critical_stiffness);
}

}  // namespace zwidth::python

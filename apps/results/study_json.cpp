#include "results/study_json.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "results/csv.hpp"
#include "results/units.hpp"

namespace zwidth::results {
namespace {

Json interval_json(const std::optional<double>& lower, const std::optional<double>& upper) {
  return Json::array({Json(lower), Json(upper)});
}

Json yield_json(const std::optional<Proportion>& share) {
  if (!share) return nullptr;
  return {{"value", share->value}, {"interval", {share->lower, share->upper}}, {"count", share->count}};
}

Json quantiles_json(const std::vector<QuantileEstimate>& quantiles) {
  Json list = Json::array();
  for (const QuantileEstimate& each : quantiles) {
    const char* status = !each.value               ? "too_few_samples"
                         : std::isnan(*each.value) ? "refused"
                         : std::isinf(*each.value) ? "unbounded"
                                                   : "finite";
    list.push_back({{"probability", each.probability},
                    {"status", status},
                    {"stiffness", each.value},
                    {"interval", interval_json(each.lower, each.upper)}});
  }
  return list;
}

Json values_json(const Study& study, const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t j = 0; j < study.keys.size(); ++j) json[study.keys[j]] = values[j];
  return json;
}

Json worst_json(const Study& study, const std::optional<WorstDevice>& found) {
  if (!found) return nullptr;
  const WorstDevice& worst = *found;
  Json json = {{"parameters", values_json(study, worst.values)}};
  add_critical(json, worst.critical);
  json["any_user"] = worst.any_user;
  json["worst_sampled"] = worst.sampled;
  json["share_outside"] = worst.outside;
  json["evaluations"] = worst.evaluations;
  json["descents"] = worst.descents;
  json["agreeing"] = worst.agreeing;
  json["trust"] = worst.trust;
  json["findings"] = findings_json(worst.trust);
  return json;
}

Json clusters_json(const Study& study) {
  Json list = Json::array();
  for (const FailureCluster& each : study.clusters) {
    list.push_back({{"status", each.status},
                    {"limited_by", each.limited_by},
                    {"count", each.count},
                    {"share", each.share},
                    {"lowest_frequency_rad_s", each.lowest_frequency},
                    {"highest_frequency_rad_s", each.highest_frequency},
                    {"mean_scores", values_json(study, each.mean_scores)}});
  }
  return list;
}

Json indices_json(const Study& study) {
  if (!study.sobol_indices) return nullptr;
  Json list = Json::array();
  for (std::size_t j = 0; j < study.keys.size(); ++j) {
    const SobolIndex& index = (*study.sobol_indices)[j];
    list.push_back({{"parameter", study.keys[j]},
                    {"first", index.first},
                    {"first_error", index.first_error},
                    {"total", index.total},
                    {"total_error", index.total_error}});
  }
  return list;
}

Json tightening_json(const Study& study) {
  if (!study.tightening) return nullptr;
  Json list = Json::array();
  for (std::size_t j = 0; j < study.keys.size(); ++j) {
    const TighteningGain& gain = (*study.tightening)[j];
    list.push_back({{"parameter", study.keys[j]}, {"yield_gain", gain.yield_gain}, {"error", gain.error}});
  }
  return list;
}

Json rare_json(const Study& study) {
  if (!study.rare_failures) return nullptr;
  const RareFailures& rare = *study.rare_failures;
  Json points = Json::array();
  for (const DesignPoint& each : rare.points) points.push_back({{"distance", each.distance}, {"scores", each.scores}});
  return {{"share", rare.share},
          {"error", rare.error},
          {"interval", {rare.lower, rare.upper}},
          {"evaluations", rare.evaluations},
          {"design_points", points},
          {"trust", rare.trust},
          {"findings", findings_json(rare.trust)}};
}

Json regions_json(const Study& study) {
  if (!study.regions) return nullptr;
  const RegionContours& regions = *study.regions;
  Json contours = Json::array();
  for (const RegionContour& each : regions.contours) {
    contours.push_back(
        {{"share", each.share}, {"stiffness", each.stiffness}, {"lower", each.lower}, {"upper", each.upper}});
  }
  return {{"units", regions.units},       {"damping_step", regions.damping_step},
          {"dampings", regions.dampings}, {"contours", contours},
          {"trust", regions.trust},       {"findings", findings_json(regions.trust)}};
}

}  // namespace

Json study_json(const StudyRun& run, const Study& study) {
  const StudyOptions& options = run.options();
  Json json = document("zwidth.study/1");
  json["device"] = run.device().name();
  json["units"] = wall_units(run.device().parameters().motion);
  json["limits"] = study.limits;
  json["samples"] = study.samples;
  json["seed"] = options.seed;
  json["sampling"] = options.sampling;
  json["parameters"] = study.keys;
  json["specification"] = {{"critical_stiffness", options.specification.critical_stiffness},
                           {"any_user", options.specification.any_user}};
  json["yield"] = study.yield ? std::optional(study.yield->value) : std::nullopt;
  json["yield_interval"] = study.yield ? Json{study.yield->lower, study.yield->upper} : Json(nullptr);
  json["yields"] = {{"critical_stiffness", yield_json(study.critical_stiffness_yield)},
                    {"any_user", yield_json(study.absolute_stability_yield)}};
  json["quantiles"] = quantiles_json(study.quantiles);
  json["any_user_quantiles"] = options.any_user ? quantiles_json(study.absolute_stability_quantiles) : Json(nullptr);
  json["reached_by_95_percent"] = study.reached_by_95_percent;
  json["histogram"] = {
      {"edges", study.histogram.edges}, {"counts", study.histogram.counts}, {"yields", study.histogram.yields}};
  json["none_stable"] = study.none_stable;
  json["unbounded"] = study.unbounded;
  json["doubtful"] = study.doubtful;
  json["failed_count"] = study.failed_count;
  json["failed"] = Json::array();
  for (const FailedSample& each : study.failed) {
    json["failed"].push_back({{"sample", each.sample}, {"reason", each.reason}});
  }
  json["clusters"] = clusters_json(study);
  json["sobol_indices"] = indices_json(study);
  json["tightening"] = tightening_json(study);
  json["tighten_first"] = study.tighten_first ? Json(study.keys[*study.tighten_first]) : Json(nullptr);
  json["rare_failures"] = rare_json(study);
  json["regions"] = regions_json(study);
  json["worst"] = worst_json(study, study.worst);
  json["worst_any_user"] = worst_json(study, study.worst_any_user);
  add_findings(json, study);
  return json;
}

std::string study_csv(const Study& study) {
  Csv csv;
  csv.cell("sample");
  for (const std::string& key : study.keys) csv.cell(key);
  for (const char* name : {"critical_stiffness", "status", "mode", "trust"}) csv.cell(name);
  csv.end_row();
  for (const StudyPoint& each : study.points) {
    csv.cell(each.sample);
    for (const double value : each.values) csv.cell(value);
    csv.row(each.stiffness, name_of(each.status), each.mode >= 0 ? std::optional(each.mode) : std::nullopt,
            study.trust);
  }
  return csv.text();
}

}  // namespace zwidth::results

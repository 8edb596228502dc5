#include "results/wall_recommendation_json.hpp"

#include "results/drive_damper_json.hpp"
#include "results/force_per_count_json.hpp"
#include "results/stability_json.hpp"
#include "results/units.hpp"
#include "results/wall_filter_json.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth::results {
namespace {

Json margins_json(const RecommendedWall& each) {
  Json json = each.margins;
  json.erase("stiffness");  // they stand in `wall`
  json.erase("damping");
  json["any_user_critical_stiffness"] = each.absolute_stability_limit;
  json["any_user_stiffness_margin_db"] =
      each.absolute_stability_margin ? Json(decibels(*each.absolute_stability_margin)) : Json(nullptr);
  json["any_user_critical_damping"] = each.absolute_stability_damping_limit;
  json["contact_damping_ratio"] = each.contact_damping_ratio;
  return json;
}

/// The members that the recommended wall and its alternatives have.
void add_wall(Json& json, const RecommendedWall& each, double period) {
  json["wall"] = {{"stiffness", *each.wall.stiffness},
                  {"damping", each.wall.damping},
                  {"velocity_filter_hz", each.wall.velocity_filter_hz},
                  {"filters", wall_filters_json(each.wall, period)},
                  {"has_new_notch", each.notch.has_value()}};
  json["bounded_by"] = {{"stiffness", each.bounded_by.stiffness},
                        {"damping", each.bounded_by.damping},
                        {"velocity_filter", each.bounded_by.velocity_filter}};
  json["margins"] = margins_json(each);
  json["force_per_count"] = each.force_per_count;
}

}  // namespace

Json wall_recommendation_json(const Device& device, const RecommendationOptions& options,
                              const WallRecommendation& recommendation) {
  const double period = device.loop().sampling_period;
  Json json = document("zwidth.wall_recommendation/1");
  json["device"] = device.name();
  json["units"] = wall_units(device.parameters().motion);
  json["limits"] = recommendation.limits;
  json["goal"] = options.goal;
  json["asked"] = {{"gain_margin_db", decibels(options.gain_margin)},
                   {"phase_margin_rad", options.phase_margin},
                   {"ripple", options.quantisation_force},
                   {"drift", options.modal_frequency_uncertainty}};
  json["drifts_checked"] = recommendation.modal_shifts_checked;
  json["status"] = recommendation.status;
  json["reason"] = recommendation.reason ? Json(text(*recommendation.reason)) : Json(nullptr);
  if (recommendation.wall) {
    add_wall(json, *recommendation.wall, period);
  } else {
    for (const char* key : {"wall", "bounded_by", "margins", "force_per_count"}) json[key] = nullptr;
  }
  json["alternatives"] = Json::array();
  for (const RecommendedWall& each : recommendation.alternatives) {
    Json alternative = Json::object();
    alternative["what"] = words_of(each.kind);
    add_wall(alternative, each, period);
    json["alternatives"].push_back(std::move(alternative));
  }
  json["drive_damper"] = recommendation.drive_damper;
  add_findings(json, recommendation);
  return json;
}

}  // namespace zwidth::results

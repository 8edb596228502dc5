#include "results/recording_json.hpp"

namespace zwidth::results {

Json recording_json(const RecordingContents& contents) {
  Json json = document("zwidth.recording/1");
  json["format"] = contents.format == RecordingFormat::mat   ? "mat"
                   : contents.format == RecordingFormat::uff ? "uff"
                                                             : "text";
  json["columns"] = Json::array();
  for (const RecordingColumn& each : contents.columns) {
    json["columns"].push_back({{"name", each.name}, {"samples", each.size}, {"detail", each.detail}});
  }
  json["remarks"] = contents.remarks;
  json["findings"] = findings_json({}, contents.remarks);
  return json;
}

}  // namespace zwidth::results

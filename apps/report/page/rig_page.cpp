#include "report/page/rig_page.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <functional>
#include <string_view>

#include "report/document.hpp"
#include "report/figure/rig_figures.hpp"
#include "report/page/answer_box.hpp"
#include "report/page/html_page.hpp"
#include "report/page/identification_page.hpp"
#include "report/text/device_table.hpp"
#include "report/text/frf_text.hpp"
#include "report/text/quantity.hpp"
#include "report/text/relay_text.hpp"
#include "report/text/rig_rows.hpp"
#include "report/text/trust_text.hpp"
#include "results/frf_json.hpp"
#include "zwidth/ranked_findings.hpp"

namespace zwidth::report {
namespace {

std::string date_text(double seconds) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(static_cast<std::time_t>(seconds)));
}

/// Without what stands ahead: what speaks against the answer.
std::vector<std::string> remarks_of(const Trust& trust, const std::vector<Remark>& remarks) {
  std::vector<std::string> items;
  for (const RankedFinding& each : most_important(trust, remarks)) {
    if (each.finding.severity < Finding::Severity::doubt) items.push_back(text(each.words));
  }
  return items;
}

void add_session(Document& document, const RigSession& session) {
  std::vector<LabelledText> rows;
  if (session.began > 0.0) rows.push_back({"date", date_text(session.began)});
  rows.push_back({"program", fmt::format("zwidth {}", ZWIDTH_VERSION)});
  for (const auto& more : {session_rows(session), safety_rows(session)})
    rows.insert(rows.end(), more.begin(), more.end());
  document.part("Session");
  document.rows(rows);
  document.table(latency_table(session.timing));
}

/// What every page of a rig has around what the action found.
struct Found {
  std::string_view action;
  const Device& device;
  const RigSession& session;
  const Trust& trust;
  std::vector<Remark> remarks = {};     ///< beside the session's
  bool is_trust_within_answer = false;  ///< instead of ahead of it
};

std::string page(const Found& found, const std::function<void(Document&)>& add_answer) {
  const std::string title = fmt::format("Rig {}: {}", found.action, found.device.name());
  Document document(Medium::page);
  document.rows(stopped_rows(found.session));
  if (!found.is_trust_within_answer) document.paragraph(trust_note(found.trust));
  add_answer(document);
  std::vector<Remark> remarks = found.remarks;
  remarks.insert(remarks.end(), found.session.remarks.begin(), found.session.remarks.end());
  document.part("Remarks");
  document.list(remarks_of(found.trust, remarks));
  add_session(document, found.session);
  document.part("What the device's file says");
  document.verbatim(answer_box(analysed_device(found.device)));
  document.part("The device as given");
  document.table(device_table(found.device));
  return html_page(title, element("h1", title) + std::move(document).str());
}

void add_response_figure(Document& document, const Device& device, const RigMeasurement& measurement) {
  document.figure("response", "Measured from the commanded force to the position, with 95 % bands.",
                  [&] { return draw_rig(device, measurement, FigureFormat::svg); });
}

}  // namespace

std::string rig_page(const Device& device, const RigCheck& check) {
  return page({"check", device, check.session, check.trust},
              [&](Document& document) { document.rows(rig_rows(device, check)); });
}

std::string rig_page(const Device& device, const RigMeasurement& measurement) {
  Found found{"measure", device, measurement.session, measurement.trust};
  if (measurement.response) found.remarks = measurement.response->remarks;
  return page(found, [&](Document& document) {
    if (!measurement.response) return;
    add_response(document, *measurement.response, results::frf_units(device));
    document.part();
    add_response_figure(document, device, measurement);
  });
}

std::string rig_page(const Device& device, const RigIdentification& identified) {
  Found found{"identify", device, identified.measurement.session, identified.trust};
  if (identified.identification) found.remarks = identified.identification->remarks;
  found.is_trust_within_answer = identified.identification.has_value();
  return page(found, [&](Document& document) {
    if (identified.identification) {
      Identification fit = *identified.identification;
      fit.trust = identified.trust;  // the fit's, and the device's
      add_identification(document, fit);
    }
    document.part("The response");
    if (identified.measurement.response) add_response_figure(document, device, identified.measurement);
  });
}

std::string rig_page(const Device& device, const RigRelay& found) {
  return page({"relay", device, found.session, found.trust}, [&](Document& document) {
    if (!found.relay) return;
    add_relay(document, *found.relay);
    document.part();
    document.figure("relay", "The end of the first trial that oscillates: force of the relay, and position.",
                    [&] { return draw_rig(device, found, FigureFormat::svg); });
  });
}

std::string rig_page(const Device& device, const RigWall& wall) {
  return page({"wall", device, wall.session, wall.trust}, [&](Document& document) {
    document.rows(rig_rows(device, wall));
    if (!has_figure(wall)) return;
    document.figure("wall", "Force that was sent, and position as sensed, from the first cycle.",
                    [&] { return draw_rig(device, wall, FigureFormat::svg); });
  });
}

std::string rig_page(const Device& device, const RigLimit& limit) {
  return page({"limit", device, limit.session, limit.trust, limit.remarks}, [&](Document& document) {
    document.rows(rig_rows(device, limit));
    if (has_figure(limit)) {
      document.figure("limit",
                      "Below the grey line the oscillation after a knock decays: the wall is stable. Where the growth "
                      "passes through zero is the critical stiffness of the device on the rig.",
                      [&] { return draw_rig(device, limit, FigureFormat::svg); });
    }
    const Units units = units_of(device.parameters().motion);
    document.part(fmt::format("Trials, each after a knock of {}", quantity(limit.impulse, units.force)));
    document.table(trial_table(limit.measured, units));
  });
}

}  // namespace zwidth::report

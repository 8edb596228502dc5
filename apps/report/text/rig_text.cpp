#include "report/text/rig_text.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "report/text/findings_text.hpp"
#include "report/text/frf_text.hpp"
#include "report/text/identification_text.hpp"
#include "report/text/quantity.hpp"
#include "report/text/relay_text.hpp"
#include "report/text/rig_rows.hpp"
#include "report/text/text_table.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::report {
namespace {

std::string rig_heading(const Device& device, std::string_view what, const RigSession& session) {
  return shortened(fmt::format("{}: {}", what, device.name()), line_width) + "\n" + lines_of(stopped_rows(session));
}

std::string session_text(const RigSession& session) {
  std::string text = "\nSession\n" + lines_of(session_rows(session)) + layout(latency_table(session.timing));
  if (!session.remarks.empty()) text += remarks_text(session.remarks);
  return text;
}

}  // namespace

std::string rig_text(const Device& device, const RigCheck& check) {
  return rig_heading(device, "Rig check", check.session) + trust_lines(check.trust) +
         lines_of(rig_rows(device, check)) + session_text(check.session);
}

std::string rig_text(const Device& device, const RigMeasurement& measurement) {
  std::string text = rig_heading(device, "Rig measurement", measurement.session);
  if (!measurement.response) return text + trust_lines(measurement.trust) + session_text(measurement.session);
  MeasuredResponse response = *measurement.response;
  response.trust = measurement.trust;  // the response's, and the device's
  return text + frf_text(response, results::frf_units(device)) + session_text(measurement.session);
}

std::string rig_text(const Device& device, const RigIdentification& identification) {
  std::string text = rig_heading(device, "Identified on the rig", identification.measurement.session);
  const RigSession& session = identification.measurement.session;
  if (!identification.identification) return text + trust_lines(identification.trust) + session_text(session);
  Identification identified = *identification.identification;
  identified.trust = identification.trust;  // the fit's, and the device's
  return text + identification_text(identified) + session_text(session);
}

std::string rig_text(const Device& device, const RigRelay& relay) {
  std::string text = rig_heading(device, "Relay experiment on the rig", relay.session);
  if (relay.relay) text += relay_text(*relay.relay);
  return text + session_text(relay.session);
}

std::string rig_text(const Device& device, const RigWall& wall) {
  return rig_heading(device, "Wall on the rig", wall.session) + lines_of(rig_rows(device, wall)) +
         trust_lines(wall.trust, "wall") + session_text(wall.session);
}

std::string rig_text(const Device& device, const RigLimit& limit) {
  const Units units = units_of(device.parameters().motion);
  std::string text = rig_heading(device, "Limit on the rig", limit.session) + lines_of(rig_rows(device, limit));
  for (const Remark& remark : limit.remarks) text += labelled("", remark_line(remark));
  return text + trust_lines(limit.trust) + "\nTrials, each after a knock of " + quantity(limit.impulse, units.force) +
         "\n" + layout(trial_table(limit.measured, units)) + session_text(limit.session);
}

}  // namespace zwidth::report

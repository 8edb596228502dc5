#include "report/measured_frf.hpp"

#include <utility>

namespace zwidth::report {
namespace {

/// "N m" and "m/s" in brackets below a fraction's line.
std::string in_brackets(const std::string& unit) {
  return unit.find_first_of(" /*") == std::string::npos ? unit : "(" + unit + ")";
}

}  // namespace

std::string FrfUnits::stiffness() const { return force + "/" + in_brackets(position); }
std::string FrfUnits::compliance() const { return position + "/" + in_brackets(force); }

MeasuredFrf measured_frf(MeasuredResponse measured, FrfUnits units) {
  return {std::move(measured.source),   std::move(units),
          std::move(measured.response), std::move(measured.stiffness),
          std::move(measured.remarks),  std::move(measured.trust)};
}

}  // namespace zwidth::report

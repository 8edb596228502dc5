#include "zwidth/remark.hpp"

namespace zwidth {

std::string remark_line(const Remark& remark) {
  std::string line = remark.what;
  for (const std::string& part : {remark.consequence, remark.remedy}) {
    if (!part.empty()) line += "; " + part;
  }
  return line;
}

}  // namespace zwidth

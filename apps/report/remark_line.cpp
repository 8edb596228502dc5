#include "report/remark_line.hpp"

namespace zwidth::report {

std::string remark_line(const Remark& remark) {
  return remark.what + (remark.meaning.empty() ? "" : "; " + remark.meaning);
}

}  // namespace zwidth::report

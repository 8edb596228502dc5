# Script: writes OUTPUT with a hash of the library's and the studies' sources in SOURCE and of the COMPILER: what functions of a
# module and who calls them must have in common.
file(GLOB_RECURSE sources ${SOURCE}/include/*.hpp ${SOURCE}/src/*.[ch]pp ${SOURCE}/apps/study/*.[ch]pp
  ${SOURCE}/apps/on_demand/*.[ch]pp)
set(all "${COMPILER}")
foreach(each ${sources})
  file(SHA256 ${each} hash)
  string(APPEND all "${hash}")
endforeach()
string(SHA256 build "${all}")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [==[
namespace zwidth::on_demand {
[[gnu::visibility("hidden")]] extern const char* const build;  // on_demand.hpp
const char* const build = "@build@";
}  // namespace zwidth::on_demand
]==] @ONLY)

#include "mechanism/mechanism_text.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth::internal {
namespace {

using namespace std::string_view_literals;
using tinyxml2::XMLAttribute;
using tinyxml2::XMLElement;
using tinyxml2::XMLNode;
using Names = std::span<const std::string_view>;

constexpr std::size_t most_elements = 10000;
constexpr std::ptrdiff_t most_attributes = 20000;  // the parser holds each of an element's against all before it
constexpr std::array<std::string_view, 17> not_needed{
    "asset", "camera", "contact",   "custom", "deformable", "gazebo",   "keyframe", "light",       "sensor",
    "size",  "skin",   "statistic", "visual", "collision",  "material", "texture",  "transmission"};
constexpr std::array<std::string_view, 7> not_read{"attach", "composite", "extension", "flexcomp",
                                                   "plugin", "replicate", "mimic"};
constexpr std::array<std::string_view, 9> attributes_not_needed{
    "file", "filename", "meshdir", "texturedir", "assetdir", "material", "texture", "strippath", "discardvisual"};
constexpr std::array<std::string_view, 5> paths{"file", "filename", "meshdir", "texturedir", "assetdir"};
constexpr std::array<std::string_view, 20> attributes_of_names{
    "name",  "class", "childclass", "file",    "filename", "joint", "joint1", "joint2", "body",     "body1",
    "body2", "site",  "tendon",     "tendon1", "tendon2",  "geom",  "mesh",   "link",   "material", "model"};
constexpr std::array<std::string_view, 3> numbers_of_parts{"damping", "stiffness",
                                                           "frictionloss"};  // refused with their part
constexpr std::array<std::string_view, 3> joints{"joint", "freejoint", "ball"};

bool is_of(Names names, std::string_view name) { return std::ranges::find(names, name) != names.end(); }

// Reads files beside the mechanism's; a device or a pipe is none.
std::optional<std::string> contents(const std::filesystem::path& path) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed) || failed) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  std::string text(most_mechanism_bytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad() || !(file || file.eof())) return std::nullopt;
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

// In the folder or below it, by its name.
bool is_beside(const std::filesystem::path& name) {
  return name.is_relative() && *name.lexically_normal().begin() != "..";
}

std::string_view value(const XMLElement& of, const char* attribute) {
  const char* found = of.Attribute(attribute);
  return found != nullptr ? found : "";
}

// MuJoCo makes one body of links that joints fix, and the tip may be such a link.
void keep_links_apart(XMLElement& robot) {
  XMLElement* settings = robot.FirstChildElement("mujoco");
  if (settings == nullptr) settings = robot.InsertNewChildElement("mujoco");
  XMLElement* compiler = settings->FirstChildElement("compiler");
  if (compiler == nullptr) compiler = settings->InsertNewChildElement("compiler");
  compiler->SetAttribute("fusestatic", false);
}

// A body with a joint, or within one that has. Where an included file begins, it may stand within one.
bool moves(const XMLElement& body) {
  for (const XMLElement* at = &body; at != nullptr; at = at->Parent()->ToElement()) {
    const std::string_view name = at->Name();
    if (name == "worldbody") return false;
    const auto has_child = [at](std::string_view each) { return at->FirstChildElement(each.data()) != nullptr; };
    if (name != "body" || std::ranges::any_of(joints, has_child)) return true;
  }
  return true;
}

bool is_no_number(std::string_view word) {
  std::string low(word);
  std::ranges::transform(low, low.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  while (low.starts_with('-') || low.starts_with('+')) low.erase(0, 1);
  return low.starts_with("nan") || low == "inf" || low == "infinity";
}

// NaN or infinity among numbers, which MuJoCo takes for others; or a quaternion of zeros, which turns nowhere.
bool has_no_number(const XMLAttribute& attribute) {
  if (is_of(attributes_of_names, attribute.Name()) || is_of(numbers_of_parts, attribute.Name())) return false;
  std::istringstream words{attribute.Value()};
  const std::vector<std::string> each{std::istream_iterator<std::string>(words), {}};
  if (std::ranges::any_of(each, is_no_number)) return true;
  const auto is_zero = [](const std::string& word) { return word.find_first_not_of("+-0.eE") == std::string::npos; };
  return attribute.Name() == "quat"sv && !each.empty() && std::ranges::all_of(each, is_zero);
}

class MechanismReader {
 public:
  explicit MechanismReader(const MechanismFile& file) : may_name_files_(file.text.empty()) {
    const std::filesystem::path path(file.path);
    folder_ = path.parent_path();
    std::optional<std::string> text = file.text;
    if (may_name_files_) text = contents(path);
    if (!text) {
      refuse_key("mechanism.file",
                 {.code = ProblemCode::mechanism_file_refused, .subjects = {{"name", path.string()}}});
    }
    add("mechanism.xml", path.filename().string(), *text);
  }

  [[nodiscard]] std::vector<MechanismText> texts() && { return std::move(texts_); }

 private:
  // What stands in a file, and what is read of it.
  struct Document {
    std::string file;  // for people; empty where it is a text
    tinyxml2::XMLDocument xml;
    std::size_t elements = 0;
    bool takes_inertia_of_geoms = false;
    tinyxml2::XMLPrinter read{nullptr, true};
    int line = 1;  // that it has reached
  };

  [[noreturn]] void refuse(ProblemCode code, const Document& of, int line, std::string_view name,
                           std::vector<Subject> subjects = {}) const {
    if (!of.file.empty()) subjects.push_back({"file", of.file});
    if (!name.empty()) subjects.push_back({"name", std::string(name.substr(0, 100))});
    refuse_key(
        may_name_files_ ? "mechanism.file" : "mechanism.text",
        {.code = code, .evidence = {counted("line", static_cast<std::size_t>(line))}, .subjects = std::move(subjects)});
  }

  [[noreturn]] void refuse_xml(const Document& of, int line, const char* why) const {
    refuse(ProblemCode::no_xml, of, std::max(line, 1), "", {{"why", why}});
  }

  [[noreturn]] void refuse_size(std::size_t most, const char* what) const {
    refuse_key(
        may_name_files_ ? "mechanism.file" : "mechanism.text",
        {.code = ProblemCode::mechanism_too_large, .evidence = {counted("most", most)}, .subjects = {{"what", what}}});
  }

  void add(const std::string& called, const std::string& file, const std::string& text) {
    const std::size_t at = texts_.size();
    texts_.push_back({called, ""});
    bytes_ += text.size();
    if (bytes_ > most_mechanism_bytes) refuse_size(most_mechanism_bytes, "bytes");
    if (std::ranges::count(text, '=') > most_attributes) refuse_size(most_attributes, "attributes");
    Document document;
    document.file = file;
    if (text.find('\0') != std::string::npos) refuse_xml(document, 1, "zero");
    document.xml.Parse(text.data(), text.size());
    if (document.xml.Error()) refuse_xml(document, document.xml.ErrorLineNum(), document.xml.ErrorName());
    XMLElement* root = document.xml.RootElement();
    if (root == nullptr) refuse_xml(document, 1, "none");
    if (const XMLElement* second = root->NextSiblingElement()) refuse_xml(document, second->GetLineNum(), "roots");
    check(document, document.xml);
    if (root->Name() == "robot"sv) keep_links_apart(*root);
    write(document, *root, false);
    texts_[at].text = document.read.CStr();
  }

  // Elements, and their attributes; comments and the text of elements say nothing.
  void check(Document& document, const XMLNode& node) {
    const tinyxml2::XMLText* text = node.ToText();
    const bool is_outside = text != nullptr && (text->CData() || text->Parent() == &document.xml);
    if (is_outside || node.ToUnknown() != nullptr) refuse_xml(document, node.GetLineNum(), "declared");
    if (const XMLElement* element = node.ToElement()) check_element(document, *element);
    for (const XMLNode* each = node.FirstChild(); each != nullptr; each = each->NextSibling()) check(document, *each);
  }

  void check_element(Document& document, const XMLElement& element) {
    const std::string_view name = element.Name();
    if (++document.elements > most_elements) refuse_xml(document, element.GetLineNum(), "many");
    if (is_of(joints, name) && ++joints_ > most_mechanism_joints) refuse_size(most_mechanism_joints, "joints");
    if (is_of(not_read, name)) refuse(ProblemCode::element_not_read, document, element.GetLineNum(), name);
    bool names_file = name == "include";
    for (const XMLAttribute* each = element.FirstAttribute(); each != nullptr; each = each->Next()) {
      if (std::string_view(each->Value()).find('<') != std::string_view::npos) {
        refuse_xml(document, each->GetLineNum(), "value");
      }
      if (has_no_number(*each)) {
        refuse(ProblemCode::mechanism_file_refused, document, each->GetLineNum(), "", {{"part", "numbers"}});
      }
      names_file = names_file || is_of(paths, each->Name());
    }
    if (names_file && !may_name_files_) refuse(ProblemCode::path_in_text, document, element.GetLineNum(), name);
    if (name == "compiler" && value(element, "inertiafromgeom") == "true") document.takes_inertia_of_geoms = true;
  }

  // What is needed of an element, in the line in which it stands.
  void write(Document& document, const XMLElement& element, bool is_default) {
    const std::string_view name = element.Name();
    const bool is_of_mesh = name == "geom" && !(value(element, "mesh").empty() && value(element, "hfield").empty());
    if (is_of_mesh && !is_default) check_mass(document, element);
    if (is_of(not_needed, name) || (is_of_mesh && !is_default)) return;
    for (; document.line < element.GetLineNum(); ++document.line) document.read.PushText("\n");
    document.read.OpenElement(element.Name(), true);
    if (name == "include") {
      document.read.PushAttribute("file", included(document, element).c_str());
    } else {
      write_content(document, element, is_default || name == "default");
    }
    document.read.CloseElement(true);
  }

  void write_content(Document& document, const XMLElement& element, bool is_default) {
    const bool is_geom = element.Name() == "geom"sv;
    for (const XMLAttribute* each = element.FirstAttribute(); each != nullptr; each = each->Next()) {
      const bool is_mesh = is_geom && (each->Name() == "mesh"sv || each->Name() == "hfield"sv);
      if (is_mesh || is_of(attributes_not_needed, each->Name())) continue;
      std::string on_one_line = each->Value();
      std::ranges::replace(on_one_line, '\n', ' ');
      document.read.PushAttribute(each->Name(), on_one_line.c_str());
    }
    for (const XMLElement* each = element.FirstChildElement(); each != nullptr; each = each->NextSiblingElement()) {
      write(document, *each, is_default);
    }
  }

  // Reads the file; by which name MuJoCo finds it.
  std::string included(const Document& document, const XMLElement& element) {
    const std::string name(value(element, "file"));
    const bool is_new = included_.insert(name).second;
    std::optional<std::string> text;
    if (is_new && !name.empty() && is_beside(name)) text = contents(folder_ / name);
    if (!text) {
      refuse(ProblemCode::include_not_read, document, element.GetLineNum(), name,
             is_new ? std::vector<Subject>{} : std::vector<Subject>{{"twice", "twice"}});
    }
    std::string called = fmt::format("included_{}.xml", included_.size());
    add(called, name, *text);
    return called;
  }

  // A mesh may give a body its mass, and meshes are not read.
  void check_mass(const Document& document, const XMLElement& geom) const {
    const XMLElement* body = geom.Parent()->ToElement();
    if (body == nullptr || body->Name() != "body"sv) return;
    const std::string_view mass = value(geom, "mass");
    if (!mass.empty() && mass.find_first_not_of("0. ") == std::string_view::npos) return;
    const bool states_inertia = body->FirstChildElement("inertial") != nullptr && !document.takes_inertia_of_geoms;
    if (states_inertia || !moves(*body)) return;
    refuse(ProblemCode::mass_of_mesh, document, geom.GetLineNum(), value(*body, "name"));
  }

  bool may_name_files_;
  std::filesystem::path folder_;
  std::vector<MechanismText> texts_;
  std::set<std::string> included_;
  std::size_t bytes_ = 0;
  std::size_t joints_ = 0;
};

}  // namespace

std::string one_text(std::vector<MechanismText> texts) {
  // A text stands behind the one that includes it.
  for (; texts.size() > 1; texts.pop_back()) {
    const MechanismText& last = texts.back();
    const std::size_t begin = last.text.find('>') + 1;
    const std::size_t end = last.text.rfind("</");
    const bool is_empty = end == std::string::npos || end < begin;
    const std::string within = is_empty ? "" : last.text.substr(begin, end - begin);
    const std::string element = fmt::format("<include file=\"{}\"/>", last.name);
    for (MechanismText& each : texts) {
      const std::size_t at = each.text.find(element);
      if (at != std::string::npos) each.text.replace(at, element.size(), within);
    }
  }
  return std::move(texts.front().text);
}

std::vector<MechanismText> mechanism_texts(const MechanismFile& file) { return MechanismReader(file).texts(); }

}  // namespace zwidth::internal

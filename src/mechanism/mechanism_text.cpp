#include "mechanism/mechanism_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "counted.hpp"
#include "mechanism/refusal.hpp"
#include "mechanism/xml_elements.hpp"

namespace zwidth::internal {
namespace {

using Names = std::span<const std::string_view>;

constexpr std::array<std::string_view, 17> not_needed{
    "asset", "camera", "contact",   "custom", "deformable", "gazebo",   "keyframe", "light",       "sensor",
    "size",  "skin",   "statistic", "visual", "collision",  "material", "texture",  "transmission"};
constexpr std::array<std::string_view, 7> not_read{"attach", "composite", "extension", "flexcomp",
                                                   "plugin", "replicate", "mimic"};
constexpr std::array<std::string_view, 9> attributes_not_needed{
    "file", "filename", "meshdir", "texturedir", "assetdir", "material", "texture", "strippath", "discardvisual"};
constexpr std::array<std::string_view, 5> paths{"file", "filename", "meshdir", "texturedir", "assetdir"};
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

class MechanismReader {
 public:
  explicit MechanismReader(const MechanismFile& file) : may_name_files_(file.text.empty()) {
    const std::filesystem::path path(file.path);
    folder_ = path.parent_path();
    std::optional<std::string> text = file.text;
    if (may_name_files_) text = contents(path);
    if (!text) {
      refuse_mechanism("mechanism.file",
                       {.code = ProblemCode::mechanism_file_refused, .subjects = {{"name", path.string()}}});
    }
    add("mechanism.xml", path.filename().string(), *std::move(text));
  }

  [[nodiscard]] std::vector<MechanismText> texts() && { return std::move(texts_); }

 private:
  // A text, what of it is read, and its changes.
  struct Document {
    std::string file;  // for people; empty where it is a text
    std::string text;
    std::vector<XmlElement> elements;
    std::vector<TextRange> blanks;
    std::vector<std::pair<std::size_t, std::string>> inserts;
  };

  [[noreturn]] void refuse(ProblemCode code, const Document& of, std::size_t line, std::string_view name,
                           std::vector<Subject> subjects = {}) const {
    if (!of.file.empty()) subjects.push_back({"file", of.file});
    if (!name.empty()) subjects.push_back({"name", std::string(name.substr(0, 100))});
    refuse_mechanism(may_name_files_ ? "mechanism.file" : "mechanism.text",
                     {.code = code, .evidence = {counted("line", line)}, .subjects = std::move(subjects)});
  }

  void add(const std::string& called, const std::string& file, std::string text) {
    const std::size_t at = texts_.size();
    texts_.push_back({called, ""});
    bytes_ += text.size();
    if (bytes_ > most_mechanism_bytes) refuse_size(most_mechanism_bytes, "bytes");
    Document document{file, std::move(text), {}, {}, {}};
    auto elements = xml_elements(document.text);
    if (!elements) refuse(ProblemCode::no_xml, document, elements.error().line, "", {{"why", elements.error().why}});
    document.elements = *std::move(elements);
    joints_ += static_cast<std::size_t>(
        std::ranges::count_if(document.elements, [](const XmlElement& each) { return is_of(joints, each.name); }));
    if (joints_ > most_mechanism_joints) refuse_size(most_mechanism_joints, "joints");
    for (std::size_t i = 0; i < document.elements.size(); ++i) read(document, i);
    if (document.elements.front().name == "robot") keep_links_apart(document);
    texts_[at].text = changed(std::move(document));
  }

  [[noreturn]] void refuse_size(std::size_t most, const char* what) const {
    refuse_mechanism(
        may_name_files_ ? "mechanism.file" : "mechanism.text",
        {.code = ProblemCode::mechanism_too_large, .evidence = {counted("most", most)}, .subjects = {{"what", what}}});
  }

  void read(Document& document, std::size_t index) {
    const XmlElement& element = document.elements[index];
    if (is_of(not_read, element.name)) {
      refuse(ProblemCode::element_not_read, document, element.line, element.name);
    }
    const bool names_file =
        std::ranges::any_of(element.attributes, [](const XmlAttribute& each) { return is_of(paths, each.name); });
    if (!may_name_files_ && (names_file || element.name == "include")) {
      refuse(ProblemCode::path_in_text, document, element.line, element.name);
    }
    if (!document.blanks.empty() && element.range.begin < document.blanks.back().end) return;
    if (element.name == "include") return include(document, element);
    const bool is_of_mesh =
        element.name == "geom" && !(element.value("mesh").empty() && element.value("hfield").empty());
    const bool is_default = is_within(document, index, "default");
    if (is_of_mesh && !is_default) check_mass(document, element);
    if (is_of(not_needed, element.name) || (is_of_mesh && !is_default)) {
      document.blanks.push_back(element.range);
      return;
    }
    for (const XmlAttribute& each : element.attributes) {
      const bool is_mesh = element.name == "geom" && (each.name == "mesh" || each.name == "hfield");
      if (is_mesh || is_of(attributes_not_needed, each.name)) document.blanks.push_back(each.range);
    }
  }

  void include(Document& document, const XmlElement& element) {
    const std::string name(element.value("file"));
    const bool is_new = included_.insert(name).second;
    std::optional<std::string> text;
    if (is_new && !name.empty() && name.find('&') == std::string::npos) text = contents(folder_ / name);
    if (!text) {
      refuse(ProblemCode::include_not_read, document, element.line, name,
             is_new ? std::vector<Subject>{} : std::vector<Subject>{{"twice", "twice"}});
    }
    const std::string called = fmt::format("included_{}.xml", included_.size());
    for (const XmlAttribute& each : element.attributes) document.blanks.push_back(each.range);
    document.inserts.emplace_back(element.opened, fmt::format(" file=\"{}\"", called));
    add(called, name, *std::move(text));
  }

  // A mesh may give a body its mass, and meshes are not read.
  void check_mass(const Document& document, const XmlElement& geom) const {
    if (geom.parent == XmlElement::none || document.elements[geom.parent].name != "body") return;
    const std::string_view mass = geom.value("mass");
    if (!mass.empty() && mass.find_first_not_of("0. ") == std::string_view::npos) return;
    const bool states_inertia = has_child(document, geom.parent, "inertial") && !takes_inertia_of_geoms(document);
    if (states_inertia || !moves(document, geom.parent)) return;
    refuse(ProblemCode::mass_of_mesh, document, geom.line, document.elements[geom.parent].value("name"));
  }

  static bool takes_inertia_of_geoms(const Document& document) {
    return std::ranges::any_of(document.elements, [](const XmlElement& each) {
      return each.name == "compiler" && each.value("inertiafromgeom") == "true";
    });
  }

  static bool has_child(const Document& document, std::size_t parent, std::string_view name) {
    return std::ranges::any_of(document.elements,
                               [&](const XmlElement& each) { return each.parent == parent && each.name == name; });
  }

  // A body with a joint, or within one that has. Where an included file begins, it may stand within one.
  static bool moves(const Document& document, std::size_t body) {
    for (std::size_t at = body; at != XmlElement::none; at = document.elements[at].parent) {
      const std::string_view name = document.elements[at].name;
      if (name == "worldbody") return false;
      if (name == "mujocoinclude" || name != "body") return true;
      if (std::ranges::any_of(joints, [&](std::string_view each) { return has_child(document, at, each); }))
        return true;
    }
    return true;
  }

  static bool is_within(const Document& document, std::size_t index, std::string_view name) {
    for (std::size_t at = document.elements[index].parent; at != XmlElement::none; at = document.elements[at].parent) {
      if (document.elements[at].name == name) return true;
    }
    return false;
  }

  // MuJoCo makes one body of links that joints fix, and the tip may be such a link.
  static void keep_links_apart(Document& document) {
    const auto child = [&](std::size_t parent, std::string_view name) {
      for (std::size_t i = 0; i < document.elements.size(); ++i) {
        if (document.elements[i].parent == parent && document.elements[i].name == name) return i;
      }
      return XmlElement::none;
    };
    const std::size_t settings = child(0, "mujoco");
    const std::size_t compiler = settings == XmlElement::none ? XmlElement::none : child(settings, "compiler");
    const std::string apart = " fusestatic=\"false\"";
    if (compiler != XmlElement::none) {
      for (const XmlAttribute& each : document.elements[compiler].attributes) {
        if (each.name == "fusestatic") document.blanks.push_back(each.range);
      }
      document.inserts.emplace_back(document.elements[compiler].opened, apart);
    } else if (settings != XmlElement::none &&
               document.elements[settings].entered < document.elements[settings].range.end) {
      document.inserts.emplace_back(document.elements[settings].entered, fmt::format("<compiler{}/>", apart));
    } else if (document.elements[0].entered < document.elements[0].range.end) {
      if (settings != XmlElement::none) document.blanks.push_back(document.elements[settings].range);
      document.inserts.emplace_back(document.elements[0].entered, fmt::format("<mujoco><compiler{}/></mujoco>", apart));
    }
  }

  // Blanks keep the lines; inserts are at places that rise from the last.
  static std::string changed(Document document) {
    std::string text = std::move(document.text);
    for (const TextRange& each : document.blanks) {
      for (std::size_t at = each.begin; at < each.end; ++at) {
        if (text[at] != '\n') text[at] = ' ';
      }
    }
    std::ranges::sort(document.inserts, std::ranges::greater{}, &std::pair<std::size_t, std::string>::first);
    for (const auto& [at, insert] : document.inserts) text.insert(at, insert);
    return text;
  }

  bool may_name_files_;
  std::filesystem::path folder_;
  std::vector<MechanismText> texts_;
  std::set<std::string> included_;
  std::size_t bytes_ = 0;
  std::size_t joints_ = 0;
};

}  // namespace

std::vector<MechanismText> mechanism_texts(const MechanismFile& file) { return MechanismReader(file).texts(); }

}  // namespace zwidth::internal

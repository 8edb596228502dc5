// What reaches MuJoCo of a mechanism's text, and what is refused before.
#include "mechanism/mechanism_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using enum ProblemCode;
namespace fs = std::filesystem;

std::vector<internal::MechanismText> texts_of(const std::string& text) {
  MechanismFile file;
  file.text = text;
  return internal::mechanism_texts(file);
}

struct Refusal {
  ProblemCode code = of_the_device;
  double line = 0.0;
};

template <typename Read>
std::optional<Refusal> refusal_of(const Read& read) {
  try {
    (void)read();
  } catch (const Error& error) {
    const Problem problem = error.problems().at(0).problem.value();
    const auto line = std::ranges::find(problem.evidence, "line", &Evidence::name);
    return Refusal{problem.code, line == problem.evidence.end() ? 0.0 : line->value};
  }
  return std::nullopt;
}

std::optional<Refusal> refusal_of_text(const std::string& text) {
  return refusal_of([&] { return texts_of(text); });
}

std::ptrdiff_t line_of(const std::string& what, const std::string& text) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? 0
                                 : 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
}

TEST(MechanismText, ElementsKeepTheirLines) {
  const std::string text =
      "<?xml version='1.0'?>\n<!-- <x>\n -->\n<mujoco\n model=\"a > b\n&#10;\">\n <asset>\n</asset><body\n name='c'/>\n"
      "said\n<site name='d'/></mujoco >\n";
  const std::string read = texts_of(text).at(0).text;
  for (const char* each : {"<mujoco", "<body", "<site"}) EXPECT_EQ(line_of(each, read), line_of(each, text)) << read;
  EXPECT_EQ(read.find("<x>"), std::string::npos);
}

// MuJoCo takes them for other numbers, without a word.
TEST(MechanismText, NumbersThatAreNoneAreRefusedWithTheirLine) {
  for (const std::string attribute : {"pos='nan 0 0'", "pos='0 -NaN 0'", "euler='inf 0 0'", "mass='+Infinity'",
                                      "quat='0 0 0 0'", "quat='0. -0 0e0 0'"}) {
    const auto refused = refusal_of_text("<mujoco>\n<body " + attribute + "/></mujoco>");
    ASSERT_TRUE(refused) << attribute;
    EXPECT_EQ(refused->code, mechanism_file_refused) << attribute;
    EXPECT_EQ(refused->line, 2.0) << attribute;
  }
  EXPECT_FALSE(refusal_of_text("<mujoco><body name='nan' quat='0 0 0 1'><joint class='inf'/></body></mujoco>"));
}

// Whatever quotes and entities an attribute's value has, it stays one value.
TEST(MechanismText, ValuesStayWhatTheyAre) {
  const std::string read =
      texts_of("<mujoco><site name='a\" file=\"b' user='&quot;&apos;&amp;lt;'/></mujoco>").at(0).text;
  EXPECT_NE(read.find("name=\"a&quot; file=&quot;b\""), std::string::npos) << read;
  EXPECT_NE(read.find("&amp;lt;"), std::string::npos) << read;
}

TEST(MechanismText, WhatIsNoXmlIsRefusedWithItsLine) {
  for (const std::string text :
       {"<a>\n<b></a>", "<a>\n<b x=1/></a>", "<a>\n<b x='1' x='2'/></a>", "<a>\n<![CDATA[x]]></a>", "<a/>\n<b/>",
        "<a>\n<b x='<'/></a>", "<a>\n<b>\n</c></a>", "<a>\n<b x='1", "<a>\n<!-- "}) {
    const auto refused = refusal_of_text(text);
    ASSERT_TRUE(refused) << text;
    EXPECT_EQ(refused->code, no_xml) << text;
    EXPECT_EQ(refused->line, 2.0) << text;
  }
  EXPECT_EQ(refusal_of_text("<!DOCTYPE a [<!ENTITY b \"c\">]>\n<a>&b;</a>")->code, no_xml);
  for (const std::string text : {"just text", "text<a/>", "<a/>text", " ", "<!-- -->", "</a>", "<a>\n</b>"}) {
    const auto refused = refusal_of_text(text);
    ASSERT_TRUE(refused) << text;
    EXPECT_EQ(refused->code, no_xml) << text;
    EXPECT_EQ(refused->line, 1.0) << text;
  }
  EXPECT_EQ(refusal_of_text(std::string("<a>\0</a>", 8))->code, no_xml);
}

TEST(MechanismText, WhatIsTooLargeIsRefused) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_EQ(refusal_of_text(deep)->code, no_xml);
  std::string many = "<a>";
  for (int i = 0; i < 20'000; ++i) many += "<b/>";
  EXPECT_EQ(refusal_of_text(many + "</a>")->code, no_xml);
  std::string attributes = "<a";
  for (int i = 0; i < 50'000; ++i) attributes += " a" + std::to_string(i) + "=''";
  EXPECT_EQ(refusal_of_text(attributes + "/>")->code, mechanism_too_large);
  std::string joints = "<a>";
  for (int i = 0; i < 400; ++i) joints += "<joint/>";
  EXPECT_EQ(refusal_of_text(joints + "</a>")->code, mechanism_too_large);
  EXPECT_EQ(refusal_of_text("<a>" + std::string(2U << 20U, ' ') + "</a>")->code, mechanism_too_large);
}

TEST(MechanismText, NamesNoFile) {
  EXPECT_EQ(refusal_of_text("<mujoco>\n<include file='/etc/passwd'/></mujoco>")->code, path_in_text);
  EXPECT_EQ(refusal_of_text("<mujoco>\n<asset>\n<mesh file='arm.stl'/></asset></mujoco>")->line, 3.0);
  EXPECT_EQ(refusal_of_text("<mujoco><compiler meshdir='/'/></mujoco>")->code, path_in_text);
  EXPECT_EQ(refusal_of_text("<robot><link><visual><mesh filename='package://a.dae'/></visual></link></robot>")->code,
            path_in_text);
  EXPECT_EQ(refusal_of_text("<mujoco><extension><plugin plugin='x'/></extension></mujoco>")->code, element_not_read);
  EXPECT_EQ(refusal_of_text("<mujoco><sensor><plugin/></sensor></mujoco>")->code, element_not_read);
  EXPECT_EQ(refusal_of_text("<mujoco><worldbody><composite count='100000 1 1'/></worldbody></mujoco>")->code,
            element_not_read);
  EXPECT_EQ(refusal_of_text("<robot><joint name='a'><mimic joint='b'/></joint></robot>")->code, element_not_read);
}

TEST(MechanismText, WhatIsNotNeededIsLeftOutAndLinesStay) {
  const std::string text =
      "<mujoco>\n<size nstack='9000000000'/>\n<worldbody>\n<light/>\n<site material='m' name='t'/>\n"
      "</worldbody>\n</mujoco>";
  const std::string read = texts_of(text).at(0).text;
  for (const char* gone : {"nstack", "light", "material"}) EXPECT_EQ(read.find(gone), std::string::npos) << gone;
  EXPECT_NE(read.find("name=\"t\""), std::string::npos);
  EXPECT_EQ(line_of("<site", read), 5);
}

TEST(MechanismText, MeshesAreLeftOutWhereInertiaIsStated) {
  const std::string mesh = "<geom type='mesh' mesh='m'/>";
  const std::string inertial = "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>";
  const auto body = [](const std::string& inside) {
    return "<mujoco><worldbody>\n<body name='a'>\n" + inside + "</body></worldbody></mujoco>";
  };
  EXPECT_EQ(texts_of(body("<joint/>" + inertial + mesh)).at(0).text.find("mesh"), std::string::npos);
  const auto refused = refusal_of_text(body("<joint/>" + mesh));
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->code, mass_of_mesh);
  EXPECT_EQ(refused->line, 3.0);
  EXPECT_FALSE(refusal_of_text(body(mesh)));  // nothing moves it
  EXPECT_FALSE(refusal_of_text(body("<joint/><geom size='1' mass='1'/><geom mesh='m' mass='0'/>")));
  EXPECT_TRUE(refusal_of_text(body("<joint/><body>" + mesh + "</body>" + inertial)));
}

TEST(MechanismText, LinksOfUrdfStayApart) {
  const std::string apart = "fusestatic=\"false\"";
  EXPECT_NE(texts_of("<robot name='r'><link name='a'/></robot>").at(0).text.find(apart), std::string::npos);
  const std::string read =
      texts_of("<robot><mujoco><compiler balanceinertia='true' fusestatic='true'/></mujoco></robot>").at(0).text;
  EXPECT_NE(read.find(apart), std::string::npos);
  EXPECT_EQ(read.find("fusestatic='true'"), std::string::npos);
  EXPECT_NE(read.find("balanceinertia"), std::string::npos);
  EXPECT_NE(texts_of("<robot><mujoco><option/></mujoco></robot>").at(0).text.find(apart), std::string::npos);
}

TEST(MechanismText, FilesAreIncludedOnceAndFromBesideAlone) {
  const fs::path folder = fs::path(testing::TempDir()) / "mechanism_text";
  fs::create_directories(folder);
  const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
  write("arm.xml", "<mujocoinclude>\n<asset><mesh file='x.stl'/></asset></mujocoinclude>");
  write("whole.xml", "<mujoco>\n<include file='arm.xml'/></mujoco>");
  write("twice.xml", "<mujoco>\n<include file='arm.xml'/>\n<include file='arm.xml'/></mujoco>");
  write("missing.xml", "<mujoco>\n<include file='none.xml'/></mujoco>");
  const auto of_file = [&](const char* name) {
    MechanismFile file;
    file.path = (folder / name).string();
    return internal::mechanism_texts(file);
  };
  const auto read = of_file("whole.xml");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_NE(read[0].text.find("file=\"" + read[1].name + "\""), std::string::npos);
  EXPECT_EQ(read[1].text.find("mesh "), std::string::npos);
  EXPECT_EQ(refusal_of([&] { return of_file("twice.xml"); })->code, include_not_read);
  EXPECT_EQ(refusal_of([&] { return of_file("twice.xml"); })->line, 3.0);
  EXPECT_EQ(refusal_of([&] { return of_file("missing.xml"); })->code, include_not_read);
  EXPECT_EQ(refusal_of([&] { return of_file("nowhere.xml"); })->code, mechanism_file_refused);
  MechanismFile pipe;
  pipe.path = "/dev/zero";
  EXPECT_EQ(refusal_of([&] { return internal::mechanism_texts(pipe); })->code, mechanism_file_refused);
}

TEST(MechanismText, IsOneWithWhatItIncludes) {
  const auto one = [](std::vector<std::string> given) {
    std::vector<internal::MechanismText> texts;
    for (const std::string& each : given) texts.push_back({"included_" + std::to_string(texts.size()) + ".xml", each});
    return internal::one_text(std::move(texts));
  };
  EXPECT_EQ(one({"<mujoco/>"}), "<mujoco/>");
  EXPECT_EQ(one({"<a><include file=\"included_1.xml\"/><d/></a>", "<b n=\"1\">\n<c/></b>"}), "<a>\n<c/><d/></a>");
  EXPECT_EQ(one({"<a><include file=\"included_1.xml\"/></a>", "<b/>"}), "<a></a>");
  // One that is included may include others.
  EXPECT_EQ(one({"<a><include file=\"included_1.xml\"/><include file=\"included_3.xml\"/></a>",
                 "<b><include file=\"included_2.xml\"/><c/></b>", "<b><d/></b>", "<b><e/></b>"}),
            "<a><d/><c/><e/></a>");
  // What it says stands there once more as a text.
  const std::string again = one({texts_of("<mujoco model='a > b'>\n<body name='c'/></mujoco>").at(0).text});
  EXPECT_EQ(texts_of(again).at(0).text, again);
}

}  // namespace
}  // namespace zwidth

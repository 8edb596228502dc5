// Whatever is in place of a device file: one clear line on standard error, status 2, in no time.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class BadInput : public Workspace {
 protected:
  /// Expects status 2, nothing on standard output, and one line that names `place`; returns the line.
  std::string expect_refused(const std::string& command_line, const std::string& place) const {
    const Outcome outcome = run(command_line);
    EXPECT_EQ(outcome.status, 2) << command_line << "\n" << outcome.errors;
    EXPECT_THAT(outcome.output, IsEmpty()) << command_line;
    EXPECT_THAT(outcome.errors, StartsWith("zwidth: " + place)) << command_line;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    return outcome.errors;
  }
};

const std::string valid = "[[body]]\nname = \"a\"\nmass = 1.0\ndamping = 1.0\n[loop]\nsampling_period = 1e-3\n";

TEST_F(BadInput, FilesThatAreNoDevices) {
  write("empty.toml", "");
  write("blank.toml", " \n\t\n");
  write("binary.toml", std::string("\x7f"
                                   "ELF\0\1\2\xff\xfe",
                                   9));
  write("nul.toml", valid + std::string("\0", 1));
  write("latin1.toml", "name = \"caf\xe9\"\n" + valid);
  write("nested.toml", "a = " + std::string(100000, '[') + "\n");
  write("nested_tables.toml", "a = " + std::string(50000, '{') + "\n");
  write("dotted.toml", [] {
    std::string key = "a";
    for (int i = 0; i < 20000; ++i) key += ".a";
    return "[" + key + "]\n";
  }());
  write("unclosed.toml", "[[body]\nname = ");
  for (const std::string name :
       {"empty", "blank", "binary", "nul", "latin1", "nested", "nested_tables", "dotted", "unclosed"}) {
    expect_refused("zwidth analyze " + name + ".toml", name + ".toml:");
    expect_refused("zwidth analyze --json - < " + name + ".toml", "standard input:");
  }
}

TEST_F(BadInput, ThingsThatAreNoFiles) {
  EXPECT_THAT(expect_refused("zwidth analyze missing.toml", "missing.toml: "), HasSubstr("No such file"));
  expect_refused("zwidth analyze devices", "devices: ");
  expect_refused("zwidth analyze - < devices", "standard input: ");
  expect_refused("zwidth analyze /dev/zero", "/dev/zero: ");
  expect_refused("zwidth analyze - < /dev/zero", "standard input: ");
  expect_refused("zwidth analyze /dev/null", "/dev/null:");
  expect_refused("zwidth analyze /proc/self/mem", "/proc/self/mem: ");
  expect_refused("truncate -s 100M huge.toml && zwidth analyze huge.toml", "huge.toml: ");
  expect_refused("cat huge.toml | zwidth analyze -", "standard input: ");
  expect_refused("ln -s loop.toml loop.toml && zwidth analyze loop.toml", "loop.toml: ");
  expect_refused("zwidth analyze $(printf 'x%.0s' {1..5000})", "xxx");
}

TEST_F(BadInput, AnUnreadableFile) {
  write("secret.toml", valid);
  std::string as_anyone = "chmod 000 secret.toml && ";
  // The superuser reads everything: become nobody, with a copy of the program that nobody can reach.
  if (::geteuid() == 0) {
    as_anyone += "cp $(command -v zwidth) . && setpriv --reuid 65534 --regid 65534 --clear-groups ./";
  }
  EXPECT_THAT(expect_refused(as_anyone + "zwidth analyze secret.toml", "secret.toml: "), HasSubstr("ermission denied"));
}

TEST_F(BadInput, ValuesThatCannotBe) {
  const std::string head = "[[body]]\nname = \"a\"\n";
  const std::string loop = "[loop]\nsampling_period = 1e-3\n";
  const std::vector<std::string> texts = {
      head + "mass = -0.3\n" + loop,
      head + "mass = 0\n" + loop,
      head + "mass = nan\n" + loop,
      head + "mass = inf\n" + loop,
      head + "mass = 1e308\n" + loop,
      head + "mass = 1e999\n" + loop,
      head + "mass = \"1\"\n" + loop,
      head + "mass = [1]\n" + loop,
      head + "mass = 1979-05-27\n" + loop,
      head + "mas = 1.0\n" + loop,
      head + loop,
      head + "mass = 1.0\ndamping = -1.0\n" + loop,
      head + "mass = 1.0\n" + head + "mass = 1.0\n" + loop,
      head + "mass = 1.0\n[[body]]\nname = \"b\"\nmass = 1.0\n" + loop,
      head + "mass = 1.0\n[[link]]\nbetween = [\"a\", \"a\"]\nstiffness = 1.0\n" + loop,
      head + "mass = 1.0\n[[link]]\nbetween = [\"a\", \"c\"]\nstiffness = 1.0\n" + loop,
      head + "mass = 1.0\n[loop]\nsampling_period = 0\n",
      head + "mass = 1.0\n[loop]\nsampling_period = 1e-3\ndelay = -1\n",
      head + "mass = 1.0\n[loop]\nsampling_period = 1e-3\nsensed = \"b\"\n",
      head + "mass = 1.0\n" + loop + "[wall]\nstiffness = -1\n",
      head + "mass = 1.0\n" + loop + "[surprise]\nx = 1\n",
      valid + "[transfer_function]\nnumerator = [1]\ndenominator = [1, 1]\n",
  };
  for (const std::string& text : texts) {
    write("device.toml", text);
    const std::string line = expect_refused("zwidth analyze device.toml", "device.toml:");
    EXPECT_THAT(line, ::testing::MatchesRegex("zwidth: device\\.toml:[0-9]+:[0-9]+: [^\n]+; [^\n]+\n")) << text;
  }
}

TEST_F(BadInput, OverridesThatCannotBe) {
  for (const std::string override :
       {"loop.delya=1", "loop.delay", "=1", "loop.delay=", "loop.delay=x y", "loop.delay=-1", "body.motro.mass=1",
        "body.motor.mass=nan", "link.7.stiffness=1", "loop.sensed=nobody", "wall.stiffness=[1]", "name=\\xff",
        "loop.delay=1 wall.stiffness=2"}) {
    expect_refused("zwidth analyze devices/lhifam.toml --set $'" + override + "'", "--set");
  }
}

TEST_F(BadInput, EveryBadFileIsNamedAndNothingIsComputed) {
  write("one.toml", "");
  const Outcome outcome = run("zwidth analyze --json one.toml devices/lhifam.toml two.toml");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.output, IsEmpty());
  EXPECT_THAT(outcome.errors, StartsWith("zwidth: one.toml"));
  EXPECT_THAT(outcome.errors, HasSubstr("\nzwidth: two.toml: "));
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 2);
}

TEST_F(BadInput, EveryProblemOfAFileHasALineOfItsOwn) {
  write("device.toml", "[[body]]\nname = \"a\"\nmass = -1\ndamping = \"5 kg\"\n[loop]\nsampling_period = \"2 kHz\"\n");
  const Outcome outcome = run("zwidth analyze --json device.toml");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.output, IsEmpty());
  for (const char* place : {"3:8: body.a.mass: ", "4:11: body.a.damping: ", "6:19: loop.sampling_period: "}) {
    EXPECT_THAT("\n" + outcome.errors, HasSubstr(std::string("\nzwidth: device.toml:") + place));
  }
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 3) << outcome.errors;
}

TEST_F(BadInput, FilesToWriteThatCannotBe) {
  const std::string analyze = "zwidth analyze devices/lhifam.toml ";
  const std::string study = "zwidth study devices/lhifam.toml --study devices/studies/lhifam.toml --samples 1 ";
  expect_refused(analyze + "--report ''", "analyze: --report: is empty;");
  expect_refused(analyze + "--report a.pdf", "--report: a.pdf: ");
  expect_refused(study + "--report a.csv", "--report: a.csv: ");
  expect_refused("zwidth rig check devices/lhifam.toml --report a.svg", "--report: a.svg: ");
  expect_refused("zwidth bode devices/lhifam.toml --output ''", "bode: --output: is empty;");
  expect_refused("zwidth simulate devices/lhifam.toml --start 1e-3 --csv -", "--csv: -: ");
  expect_refused(analyze + "--report -", "--report: -: ");
  expect_refused(study + "--output-device -", "--output-device: -: ");
  expect_refused("zwidth rig measure devices/lhifam.toml --recording -", "--recording: -: ");
  // A result is put in the place of what has its name: a device, or a pipe that somebody reads, is none.
  EXPECT_EQ(run("mkfifo pipe").status, 0);
  expect_refused(study + "--output pipe", "--output: pipe: is a device or a pipe;");
  EXPECT_EQ(run("test -p pipe").status, 0);
  EXPECT_EQ(run("ls").output, "devices\npipe\nrecordings\n");
}

TEST_F(BadInput, ValuesOfOptionsThatCannotBe) {
  const std::string lhifam = " devices/lhifam.toml ";
  expect_refused("zwidth analyze" + lhifam + "--report a.html --report b.html",
                 "analyze: --report: has 2 values; at most 1;");
  expect_refused("zwidth simulate" + lhifam + "--overrun 0.5", "simulate: --overrun: has 1 of 2 values; all of them;");
  expect_refused("zwidth analyze" + lhifam + "--set", "analyze: --set: has no value; KEY=VALUE;");
  expect_refused("zwidth export" + lhifam + "--units odriv", "export: --units: is odriv; did you mean odrive?;");
  expect_refused("zwidth export" + lhifam + "--units 0",
                 "export: --units: is 0; odrive, moteus, simplefoc, openffboard, vesc;");
  expect_refused("zwidth simulate" + lhifam + "--contact soft", "simulate: --contact: is soft; bilateral, unilateral;");
  expect_refused("zwidth study" + lhifam + "--study x.toml --threads -1",
                 "study: --threads: is -1; a whole number, 0 or more;");
  expect_refused("zwidth study" + lhifam + "--study x.toml --seed '1000 ms'",
                 "study: --seed: is 1000 ms; a whole number, 0 or more;");
  expect_refused("zwidth simulate" + lhifam + "--seed 18446744073709551616",
                 "simulate: --seed: is 18446744073709551616; a whole number from 0 to 18446744073709551615;");
  const std::string long_text(100'000, 'x');
  expect_refused("zwidth simulate" + lhifam + "--seed " + long_text, "simulate: --seed: is " + long_text + "; a whole");
}

}  // namespace
}  // namespace zwidth::cli

#!/usr/bin/python3
"""Holds packaging/debian to what is installed, without building a package.

usage: check_packages.py ROOT PREFIX      PREFIX: an installed copy of the release preset
Every file has one package, every line of a package's list a file; names follow the version; lintian finds nothing in the
source. Prints what is wrong, and exits with 1 where there is something.
"""

import re
import shutil
import subprocess
import sys
import tempfile
from fnmatch import fnmatchcase
from pathlib import Path


def installed(prefix, soname):
    """The files as the packages' build installs them: shared, below usr, in the architecture's folder."""
    for path in sorted(path for path in prefix.rglob("*") if path.is_file() or path.is_symlink()):
        name = str(path.relative_to(prefix))
        if name == "share/doc/zwidth/LICENSE":
            continue  # removed in rules
        if name.startswith("lib/") and not name.startswith("lib/python3/"):
            name = f"lib/ARCHITECTURE/{name.removeprefix('lib/')}"
        if name.endswith("/libzwidth_core.a"):
            continue  # of a static library alone: the shared one has another name of itself for it
        if name.endswith("/libzwidth.a"):
            library = name.removesuffix(".a")
            yield from (f"usr/{library}.so", f"usr/{library}.so.{soname}", "usr/lib/ARCHITECTURE/pkgconfig/zwidth.pc")
        else:
            yield f"usr/{name}"


def lists(root, debian, prefix):
    changelog = (debian / "changelog").read_text()
    version = re.match(r"zwidth \(([0-9.]+)\)", changelog)[1]
    soname = ".".join(version.split(".")[:2])
    packages = re.findall(r"^Package: (\S+)$", (debian / "control").read_text(), re.M)
    if f"libzwidth{soname}" not in packages:
        yield f"control: version {version} has soname {soname}: the library's package must be libzwidth{soname}"
    released = re.findall(r"^## \[(\d[^]]*)\]", (root / "CHANGELOG.md").read_text(), re.M)
    if released and released[0] != version:
        yield f"changelog: version {version}, and CHANGELOG.md's newest is {released[0]}"
    files = list(installed(prefix, soname))
    owners = {name: [] for name in files}
    for package in packages:
        for line in (debian / f"{package}.install").read_text().splitlines():
            pattern = line.split()[0]
            found = [name for name in files if fnmatchcase(name, pattern) or fnmatchcase(name, f"{pattern}/*")]
            if not found:
                yield f"{package}.install: {pattern}: no such file is installed"
            for name in found:
                owners[name].append(package)
    for name, owning in owners.items():
        if len(owning) != 1:
            yield f"{name}: is in {', '.join(owning) or 'no package'}"
    for names in re.findall(r"^Tests: (.*)$", (debian / "tests/control").read_text(), re.M):
        for name in names.split():
            if not (debian / "tests" / name).stat().st_mode & 0o100:
                yield f"tests/{name}: cannot be run"


def source(debian):
    with tempfile.TemporaryDirectory() as scratch:
        tree = Path(scratch, "zwidth")
        shutil.copytree(debian, tree / "debian")
        (tree / "web/dist").mkdir(parents=True)
        (tree / "web/dist/index.html").write_text("<!doctype html>")  # the workbench, which is built later
        subprocess.run(["dpkg-source", "--build", "zwidth"], cwd=scratch, check=True, stdout=subprocess.DEVNULL)
        done = subprocess.run(
            ["lintian", "--allow-root", "--fail-on", "error,warning", "--suppress-tags", "mismatched-override", *Path(scratch).glob("*.dsc")],
            capture_output=True, text=True,
        )  # fmt: skip
        if done.returncode != 0:
            yield done.stdout + done.stderr


def main():
    root, prefix = Path(sys.argv[1]), Path(sys.argv[2])
    debian = root / "packaging/debian"
    wrong = [*lists(root, debian, prefix), *source(debian)]
    print("\n".join(wrong))
    print(f"{len(wrong)} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

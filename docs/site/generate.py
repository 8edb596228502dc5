#!/usr/bin/env python3
"""Puts the pages of the site together: generate.py PROJECT OUT, with the built program and module in PROJECT/build/release.

The documents are copied. After each command of a tutorial and of the gallery stands what the program answers and draws,
run here; `zwidth COMMAND --help`, the public headers, devices and examples become pages.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

FIGURE = re.compile(r"--(?:output|figure) (\S+\.svg)")
MOST_LINES = 45
# What the documents name beside themselves, and the page that has it.
ELSEWHERE = [
    (r"\.\./README\.md(?:#[a-z-]*)?", "tutorials/start.md"),
    (r"\.\./CONTRIBUTING\.md", "CONTRIBUTING.md"),
    (r"\.\./CHANGELOG\.md", "CHANGELOG.md"),
    (r"\.\./devices(?:/\w+\.toml)?", "devices.md"),
    (r"\.\./include/zwidth", "cpp/index.md"),
    (r"\.\./examples(?:/[\w./]*)?", "examples.md"),
    (r"docs/(\w+\.md)", r"\1"),
]


def fail(text):
    sys.exit(f"generate.py: {text}")


class Site:
    def __init__(self, project, out):
        self.project, self.pages = project, out / "source"
        self.scratch = out / "scratch"
        for folder in (self.pages, self.scratch):
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
        for folder in ("devices", "recordings"):
            shutil.copytree(project / folder, self.scratch / folder)
        self.environment = {**os.environ, "PATH": f"{project}/build/release/bin:{os.environ['PATH']}", "COLUMNS": "100", "LC_ALL": "C.UTF-8"}

    def write(self, name, text):
        path = self.pages / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def run(self, command):
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", command], cwd=self.scratch, env=self.environment,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            fail(f"{command}\n{done.stderr}")
        return done.stdout

    def copied(self, source, name):
        text = source.read_text(encoding="utf-8")
        for pattern, page in ELSEWHERE:
            text = re.sub(rf"\]\({pattern}\)", rf"]({page})", text)
        self.write(name, text)

    def answered(self, source, name):
        """Every ```sh block, a command a line, with the answers beneath."""
        figures = name.replace("/", "_").removesuffix(".md")

        def answer(block):
            parts = []
            for command in block.group(1).replace("\\\n", " ").strip().splitlines():
                command = re.sub(r"\s+", " ", command)
                output = self.run(command).rstrip("\n").splitlines()
                if len(output) > MOST_LINES:
                    output = output[:MOST_LINES] + ["..."]
                parts.append(f"```sh\n{command}\n```\n")
                if output:
                    parts.append("```text\n" + "\n".join(output) + "\n```\n")
                for figure in FIGURE.findall(command):
                    kept = f"figures/{figures}_{Path(figure).name}"
                    (self.pages / "figures").mkdir(exist_ok=True)
                    shutil.copy(self.scratch / figure, self.pages / kept)
                    up = "../" * name.count("/")
                    parts.append(f"![What the command draws]({up}{kept})\n")
            return "\n".join(parts)

        self.write(name, re.sub(r"```sh\n(.*?)```\n", answer, source.read_text(encoding="utf-8"), flags=re.S))

    def commands(self):
        listed = re.findall(r"^  ([a-z]+) {2,}", self.run("zwidth --help"), flags=re.M)
        if not listed:
            fail("zwidth --help lists no command")
        for name in listed:
            self.write(f"commands/{name}.md", f"# zwidth {name}\n\n```text\n{self.run(f'zwidth {name} --help')}```\n")
        rows = "\n".join(listed)
        self.write("commands/index.md", f"# Commands\n\n```text\n{self.run('zwidth --help')}```\n\n```{{toctree}}\n:maxdepth: 1\n\n{rows}\n```\n")

    def headers(self):
        include = self.project / "include"
        rooms = {}
        for header in sorted(include.rglob("*.hpp")):
            place = header.relative_to(include)
            if place.name == "zwidth.hpp":
                continue
            rooms.setdefault(place.parts[1] if len(place.parts) > 2 else "all rooms", []).append(place)
        for room, places in rooms.items():
            parts = [f"# {room.capitalize()}\n"]
            for place in places:
                parts.append(f"## {place.stem}\n\n`#include <{place}>`\n\n```{{eval-rst}}\n.. doxygenfile:: {place}\n   :sections: briefdescription detaileddescription enum func innerclass public-attrib public-func public-type typedef var\n```\n")
            self.write(f"cpp/{room.replace(' ', '_')}.md", "\n".join(parts))
        names = "\n".join(room.replace(" ", "_") for room in sorted(rooms))
        self.write("cpp/index.md", f"# C++\n\nEvery public header: equation, units, what is required, what fails, source. `#include <zwidth/zwidth.hpp>` has them all.\n\n```{{toctree}}\n:maxdepth: 1\n\n{names}\n```\n")

    def files(self, page, title, said, folder, language):
        parts = [f"# {title}\n\n{said}\n"]
        for path in sorted(p for p in (self.project / folder).rglob("*") if p.suffix in language):
            parts.append(f"## {path.relative_to(self.project / folder)}\n\n```{language[path.suffix]}\n{path.read_text(encoding='utf-8').rstrip()}\n```\n")
        self.write(page, "\n".join(parts))


def main():
    project, out = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    site = Site(project, out)
    docs = project / "docs"
    for path in sorted(docs.glob("*.md")):
        if path.name != "README.md":
            site.copied(path, path.name)
    for picture in [*docs.glob("*.svg"), *docs.glob("*.png")]:
        shutil.copy(picture, site.pages)
    for name in ("CONTRIBUTING.md", "CHANGELOG.md"):
        site.copied(project / name, name)
    for path in sorted((docs / "tutorials").glob("*.md")):
        site.answered(path, f"tutorials/{path.name}")
    site.answered(docs / "site/gallery.md", "gallery.md")
    shutil.copy(docs / "site/index.md", site.pages)
    site.commands()
    site.headers()
    site.files("devices.md", "Devices", "The devices that come with zwidth; each says where its numbers are from.", "devices", {".toml": "toml"})
    site.files("examples.md", "Examples", "Run by the tests.", "examples", {".py": "python", ".cpp": "cpp", ".c": "c"})
    site.write("python_reference.md", "# Python, function by function\n\n```{eval-rst}\n.. automodule:: zwidth\n   :members:\n   :imported-members:\n```\n")


if __name__ == "__main__":
    main()
